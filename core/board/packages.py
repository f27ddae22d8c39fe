"""Installed packages whose blocks a bench names: a document carries which, in which version, from which source."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.machinery import ModuleSpec
from importlib.metadata import EntryPoint
from importlib.resources import files
from importlib.resources.abc import Traversable
from importlib.util import find_spec

from pydantic import Field, ValidationError

from core.board.document import Document, defaults, plant_of
from core.board.library import library_of
from core.errors import InputError, from_validation, short
from core.registry import FAMILIES, blocks, installed
from core.table import Table

TABLE = "packages"
NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,99}")
SILENT = ("id", "title", "summary", "claim", "source", "verdict", "expect", "printed", "units", TABLE)
"""Parts of a scenario in which a word names no block."""


class PackageEntry(Table):
    """The entry of a package in a scenario."""

    version: str = Field(pattern=r"^[0-9A-Za-z.!+_-]{1,64}$", description="its version")
    source: str = Field(pattern=r"^[0-9a-f]{64}$", description="SHA-256 over its Python files")


@dataclass(frozen=True)
class Package:
    """An installed package with blocks.

    Parameters
    ----------
    version : str
        Its version.
    entries : tuple of EntryPoint
        Its blocks; the group of each ends with the family.
    """

    version: str
    entries: tuple[EntryPoint, ...]

    @cached_property
    def source(self) -> str:
        """SHA-256 over its Python files, with line ends as on Unix; a package that cannot be loaded is refused."""
        for entry in self.entries:
            blocks(entry.group.removeprefix("combbench."))
        digest = hashlib.sha256()
        roots = {spec.name: spec for spec in (_root(entry.module) for entry in self.entries)}
        for _, spec in sorted(roots.items()):
            for path, text in _texts(spec):
                digest.update(f"{path}\n".encode())
                digest.update(text.replace("\r\n", "\n").encode())
        return digest.hexdigest()

    @property
    def mark(self) -> Document:
        """The entry of this package in a scenario."""
        return PackageEntry(version=self.version, source=self.source).model_dump()


@cache
def packages() -> dict[str, Package]:
    """Return the installed packages with blocks, by name."""
    found: dict[str, list[EntryPoint]] = {}
    for family in FAMILIES:
        for entry in installed(family):
            if entry.dist is not None:
                found.setdefault(_plain(entry.dist.name), []).append(entry)
    return {
        name: Package(entries[0].dist.version if entries[0].dist is not None else "", tuple(entries))
        for name, entries in sorted(found.items())
    }


def carried(document: Document) -> Document:
    """Return a document with the packages whose blocks it names, and no others; those it carries must be the installed.

    Raises
    ------
    InputError
        When a package that it carries is missing here, or is another one.
    """
    _check(document.get(TABLE, {}))
    named = {name: package.mark for name, package in packages().items() if _names(document, package)}
    if named == document.get(TABLE, {}):
        return document
    rest = {key: value for key, value in document.items() if key != TABLE}
    return {**rest, TABLE: named} if named else rest


def _check(table: Document) -> None:
    """Refuse packages that are not those installed."""
    if not isinstance(table, dict):
        raise InputError(f"must be a table, got {short(table)}", TABLE)
    for name, mark in table.items():
        if not NAME.fullmatch(name):
            raise InputError("must be the name of a package, of small letters, digits and -", f"{TABLE}.{short(name)}")
        field = f"{TABLE}.{name}"
        try:
            told = PackageEntry.model_validate(mark)
        except ValidationError as error:
            raise from_validation(error, {"": [*PackageEntry.model_fields]}).under(field) from None
        package, version = packages().get(name), told.version
        if package is None:
            raise InputError("is not installed here", field, f"this scenario was made with its version {version}")
        if package.version != version:
            text = f"is version {package.version} here; this scenario was made with version {version}"
            raise InputError(text, field, f"install version {version}, or leave the table out")
        if package.source != told.source:
            text = f"has another source here, by its hash, than the version {version} this scenario was made with"
            raise InputError(text, field, "install what it was made with, or leave the table out")


def _names(document: Document, package: Package) -> bool:
    """Say whether a document names a block of a package, and has no unit of its own with that name."""
    content = {key: value for key, value in document.items() if key not in SILENT}
    plant = plant_of(document)
    words = {*re.findall(r"\w+", json.dumps([content, defaults(plant)], default=str)), plant.name}
    own = {(f"combbench.{unit.family}", unit.name) for unit in library_of(document).units}
    return any(entry.name in words and (entry.group, entry.name) not in own for entry in package.entries)


def _plain(name: str) -> str:
    """Return the name of a package as all its spellings are written."""
    return re.sub(r"[-_.]+", "-", name).lower()


def _root(module: str) -> ModuleSpec:
    """Return the outermost part of a dotted name that has a file: several packages may share a mere folder."""
    parts = module.split(".")
    found = (find_spec(".".join(parts[:count])) for count in range(1, len(parts) + 1))
    return next(spec for spec in found if spec is not None and spec.origin is not None)


def _texts(spec: ModuleSpec) -> Iterator[tuple[str, str]]:
    """Yield the Python files of a module or a package, each with its path, in an order that is always the same."""
    if spec.submodule_search_locations is not None:
        yield from _below(files(spec.name), spec.name)
    else:
        yield spec.name, spec.loader.get_source(spec.name) or ""  # type: ignore[union-attr]


def _below(folder: Traversable, path: str) -> Iterator[tuple[str, str]]:
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        if entry.is_dir():
            yield from _below(entry, f"{path}/{entry.name}")
        elif entry.name.endswith(".py"):
            yield f"{path}/{entry.name}", entry.read_text("utf-8")
