"""Units to begin with: a blank one, and the controller of the documents."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from core.own.unit import Unit, unit

NAMES = ("blank", "pi")


@cache
def starters() -> tuple[Unit, ...]:
    """Return the units to begin with, in the order of the list."""
    return tuple(unit(name, (files(__name__) / f"{name}.py").read_text("utf-8")) for name in NAMES)
