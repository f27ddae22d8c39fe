"""The blocks a bench may have: the blocks of the library, and the units that its document carries."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

from core import registry
from core.block import Block
from core.errors import InputError, short, unknown
from core.own.unit import Unit, unit

MOST_UNITS = 16
IDENTIFIER = re.compile(r"^[a-z][a-z0-9_]{0,31}$")


class Library:
    """Blocks by family and name.

    Parameters
    ----------
    units : sequence of Unit
        The units that are not in the library.
    """

    def __init__(self, units: Sequence[Unit] = ()) -> None:
        self.units = tuple(units)
        self._own: dict[str, dict[str, type[Block]]] = {}
        for one in units:
            self._own.setdefault(one.family, {})[one.name] = one.block

    def blocks(self, family: str) -> dict[str, type[Block]]:
        """Return the blocks of a family by name."""
        known = registry.blocks(family)
        return {**known, **self._own[family]} if family in self._own else known

    def block(self, family: str, name: object, field: str = "") -> type[Block]:
        """Return one block.

        Raises
        ------
        InputError
            When the family has no block of that name.
        """
        if family in self._own and isinstance(name, str) and name in self._own[family]:
            return self._own[family][name]
        return registry.block(family, name, field)


PLAIN = Library()


def library_of(document: dict[str, Any]) -> Library:
    """Return the blocks that a bench may have.

    Raises
    ------
    InputError
        When a unit of its own is not valid.
    """
    units = document.get("units")
    if not units:
        return PLAIN
    if not isinstance(units, dict) or len(units) > MOST_UNITS:
        raise InputError(f"must be a table of at most {MOST_UNITS} units", "units")
    texts = []
    for name, table in units.items():
        if not IDENTIFIER.fullmatch(name):
            raise InputError("must be a short name of small letters, digits and _", f"units.{short(name)}")
        if not isinstance(table, dict) or not isinstance(table.get("source"), str):
            raise InputError(f"must be a table with its source, got {short(table)}", f"units.{name}")
        if extra := [key for key in table if key != "source"]:
            raise unknown("field", extra[0], ("source",), f"units.{name}.{extra[0]}")
        texts.append((name, table["source"]))
    return _library(tuple(texts))


@lru_cache(maxsize=64)
def _library(texts: tuple[tuple[str, str], ...]) -> Library:
    """Return a library with some units, always the same object for the same texts.

    A unit with the name of a library block replaces that block on the bench.
    """
    found = []
    for name, source in texts:
        try:
            one = unit(name, source)
        except InputError as error:
            raise error.under(f"units.{name}.source") from None
        found.append(one)
    return Library(found)
