"""User units that this server keeps: a folder of files, which every new bench has in addition to the library."""

from __future__ import annotations

import logging
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from core import registry
from core.board.document import Document
from core.board.library import IDENTIFIER, MOST_UNITS, library_of
from core.errors import InputError
from core.own.unit import Unit, unit
from scenarios.own import beside, with_units
from server.errors import ApiError, not_found
from server.security.privacy import write_private

log = logging.getLogger(__name__)

FOLDER = "units"
MOST_KEPT = MOST_UNITS // 2
"""Units of a server: half of the units that a bench may have, so that a scenario has room for its own."""


class Units:
    """The units that every new bench of this server has.

    Parameters
    ----------
    folder : Path
        Where units are kept, a file each. A file that is no unit is left out with a warning.
    files : iterable of Path
        Further units from files, for as long as the server runs.

    Raises
    ------
    InputError
        When one of the further files is no unit.
    """

    def __init__(self, folder: Path, files: Iterable[Path] = ()) -> None:
        self._folder = folder
        given = library_of(with_units({}, files, "unit_files")).units
        self._given = {one.name: one for one in given}
        self._kept: dict[str, Unit] = {}
        for file in sorted(folder.glob("*.py")):
            try:
                self._kept[file.stem] = self.check(file.stem, read_unit(file))
            except (InputError, ApiError) as error:
                log.warning("%s is left out: %s", file, error.detail if isinstance(error, ApiError) else error)

    def all(self) -> list[Unit]:
        """List the units."""
        return [*self._kept.values(), *self._given.values()]

    def is_kept(self, name: str) -> bool:
        """Whether a unit is in the folder."""
        return name in self._kept

    def beside(self, document: Document) -> Document:
        """Return the units that a scenario does not carry itself, as it would."""
        return beside({one.name: {"source": one.source} for one in self.all()}, document)

    def named_in(self, document: Document) -> Document:
        """Return the units that a document names."""
        words = set(_words({key: part for key, part in document.items() if key not in ("units", "expect")}))
        return {name: table for name, table in self.beside(document).items() if name in words}

    def check(self, name: str, source: str) -> Unit:
        """Return a unit that may be kept under a name.

        Raises
        ------
        InputError
            When it is no unit.
        ApiError
            When the name is taken, or there is no room.
        """
        if not IDENTIFIER.fullmatch(name):
            raise InputError("must be a short name of small letters, digits and _", "name")
        if any(name in registry.blocks(family) for family in registry.FAMILIES):
            text = f"{name} is a block of the library, whose place it would take on every new bench"
            raise ApiError(409, "conflict", text, "name", "give it another name")
        if name in self._given:
            raise ApiError(409, "conflict", f"{name} was given by serve --unit", "name", "change that file")
        if name not in self._kept and len(self._kept) + len(self._given) >= MOST_KEPT:
            raise ApiError(409, "limit", f"a server has at most {MOST_KEPT} units", "name", "delete one first")
        return unit(name, source)

    def keep(self, one: Unit) -> None:
        """Keep a unit that was checked, or another text of it."""
        write_private(self._folder / f"{one.name}.py", one.source.encode())
        self._kept[one.name] = one

    def remove(self, name: str) -> None:
        """Delete a unit from the folder; benches that have it keep it."""
        if name not in self._kept:
            raise not_found("unit of this server", name, "the units of the library and of serve --unit stay")
        (self._folder / f"{name}.py").unlink(missing_ok=True)
        del self._kept[name]


def read_unit(file: Path) -> str:
    """Return the text of a unit.

    Raises
    ------
    InputError
        When it cannot be read.
    """
    table: Document = with_units({}, [file], str(file))["units"]
    return str(table[file.stem]["source"])


def _words(part: Any) -> Iterable[str]:
    """Go through the keys and texts of a document."""
    if isinstance(part, dict):
        for key, value in part.items():
            yield from str(key).split(".")
            yield from _words(value)
    elif isinstance(part, list):
        for value in part:
            yield from _words(value)
    elif isinstance(part, str):
        yield part
