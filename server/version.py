"""The version of the package."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

try:
    VERSION = version("combbench")
except PackageNotFoundError:  # run from a checkout that was never installed
    VERSION = "0+checkout"
