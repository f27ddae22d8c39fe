"""Packages that are installed by an extra, and needed where a setting or an option asks for them."""

from __future__ import annotations

from importlib.util import find_spec

from core.errors import InputError


def require(package: str, extra: str, field: str) -> None:
    """Refuse a setting whose package is not installed.

    Raises
    ------
    InputError
        Naming the setting, the package and the extra that brings it.
    """
    if find_spec(package) is None:
        text = f"needs the package {package}, which is not installed"
        raise InputError(text, field, f"pip install '.[{extra}]' in a checkout")
