"""Finds blocks: the file is the unit, its name is the key, its folder the family."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from importlib.metadata import EntryPoint, EntryPoints, entry_points
from typing import Any

from core.block import LOOP, Block
from core.cards import BlockCard, card, check_structure, is_live
from core.errors import InputError, unknown

FAMILIES = (
    "reference",
    "rate",
    "plant",
    "sense",
    "control",
    "identify",
    "diagnose",
    "supervise",
    "readout",
    "faults",
    LOOP,
)


@cache
def blocks(family: str) -> dict[str, type[Block]]:
    """Return the blocks of a family by name, with blocks of installed packages, without blocks marked ``apart``."""
    return {name: entry for name, entry in _all(family).items() if not entry.apart}


@cache
def apart(family: str) -> dict[str, type[Block]]:
    """Return the blocks of a family that no bench has unless something puts them there."""
    return {name: entry for name, entry in _all(family).items() if entry.apart}


@cache
def _all(family: str) -> dict[str, type[Block]]:
    """Return the blocks of a family by name.

    Other packages add blocks by an entry point of the group ``combbench.<family>`` that names the class.
    """
    if family not in FAMILIES:
        raise unknown("family", family, FAMILIES)
    folder = "core.loop" if family == LOOP else f"core.{family}"
    package = importlib.import_module(folder)
    found: dict[str, type[Block]] = {}
    for module_info in pkgutil.iter_modules(package.__path__):
        module = importlib.import_module(f"{folder}.{module_info.name}")
        for value in vars(module).values():
            if (
                isinstance(value, type)
                and issubclass(value, Block)
                and value.__module__ == module.__name__
                and hasattr(value, "title")  # the bases of families have none
            ):
                found[value.name] = value
    for entry in installed(family):
        loaded = _loaded(entry)
        loaded.name, loaded.family = entry.name, family
        found[entry.name] = loaded
    for loaded in found.values():
        _check_lengths(loaded)
        check_structure(loaded)
    return dict(sorted(found.items()))


def installed(family: str) -> EntryPoints:
    """Return the blocks of a family in installed packages, as entry points."""
    found: EntryPoints = _entry_points().select(group=f"combbench.{family}")
    return found


@cache
def _entry_points() -> Any:
    """Return all entry points, of a kind that depends on Python; each look reads a file of every installed package."""
    return entry_points()


def _loaded(entry: EntryPoint) -> type[Block]:
    """Return the block that an installed package names.

    Raises
    ------
    InputError
        When it cannot be loaded, or is no block.
    """
    package = entry.dist.name if entry.dist is not None else "an installed package"
    try:
        found = entry.load()
    except Exception as error:
        text = f"{package} names {entry.value}, which cannot be loaded: {error}"
        raise InputError(text, f"{entry.group}.{entry.name}") from None
    if not (isinstance(found, type) and issubclass(found, Block)):
        raise InputError(f"{package} names {entry.value}, which is no Block", f"{entry.group}.{entry.name}")
    return found


def _check_lengths(entry: type[Block]) -> None:
    """Refuse a block whose state could change its length while the board runs.

    Raises
    ------
    TypeError
        When the parameters that set the length are not named, not there, or tunable while running.
    """
    if entry.State.layout.tails and not entry.lengths:
        raise TypeError(f"{entry.__module__}: the state has a tail; name the parameters of its length in lengths")
    for name in entry.lengths:
        info = entry.Params.model_fields.get(name)
        if info is None or is_live(info):
            raise TypeError(f"{entry.__module__}: {name} sets the length of the state, so it must be there, live=False")


def block(family: str, name: object, field: str = "") -> type[Block]:
    """Return one block.

    Raises
    ------
    InputError
        When the family has no block of that name.
    """
    known = blocks(family)
    if isinstance(name, str) and name in apart(family):
        return apart(family)[name]
    if not isinstance(name, str) or name not in known:
        words = {
            "reference": "reference",
            "rate": "angular rate",
            "plant": "plant model",
            "sense": "sensor",
            "control": "controller",
            "identify": "identifier",
            "diagnose": "diagnoser",
            "supervise": "supervisor",
            "readout": "read-out",
            "faults": "fault",
        }
        raise unknown(words.get(family, family), name, known, field)
    return known[name]


def catalog(family: str | None = None) -> list[BlockCard]:
    """Return the cards of one family, or of all, in the order in which people are shown them."""
    chosen = FAMILIES if family is None else (family,)
    return [card(entry) for name in chosen for entry in sorted(blocks(name).values(), key=lambda b: b.place)]
