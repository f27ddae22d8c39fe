"""Keeps compiled kernels in a folder."""

from __future__ import annotations

import contextlib
import logging
import os
import tempfile
from functools import cache
from pathlib import Path

from core.kernel_cache import keep_on


class Folder:
    """A folder of compiled kernels, a file for each; several processes may use it."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def get(self, name: str) -> bytes | None:
        """Return a kernel, if it is there."""
        try:
            return (self._path / name).read_bytes()
        except OSError:
            return None

    def put(self, name: str, code: bytes) -> None:
        """Keep a kernel, whole or not at all."""
        with contextlib.suppress(OSError):
            with tempfile.NamedTemporaryFile(dir=self._path, delete=False) as part:
                part.write(code)
            os.replace(part.name, self._path / name)


@cache
def folder() -> Path | None:
    """Return a folder for compiled kernels that can be written, or none."""
    given = os.environ.get("COMBBENCH_KERNEL_CACHE")
    home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    candidates = (
        [Path(given)] if given else [Path(home) / "combbench", Path(tempfile.gettempdir()) / f"combbench-{os.getuid()}"]
    )
    for candidate in candidates:
        path = candidate / "kernels"
        try:
            path.mkdir(parents=True, exist_ok=True, mode=0o700)
        except OSError:
            continue
        if os.access(path, os.W_OK):
            return path
    return None


def prepare() -> None:
    """Keep compiled kernels; without a writable folder they are compiled anew at every start."""
    path = folder()
    if path is None:
        logging.getLogger(__name__).warning("no writable folder for compiled kernels; set COMBBENCH_KERNEL_CACHE")
    else:
        keep_on(Folder(path))
