"""A bench as it is written: a document, its normal form, and values written over by dotted path."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable
from typing import Any

from core import registry
from core.errors import InputError, short
from core.nesting import DEEPEST, TOO_DEEP, depth

Document = dict[str, Any]
IDENTIFIER = re.compile(r"^[a-z][a-z0-9_]{0,31}$")
POSITION = re.compile(r"[0-9]{1,9}")

PARKED = {"controller": ("controllers", "control", "open_loop"), "sensor": ("sensors", "sense", "ideal")}
"""Of these all run, one is in use: table of the one, table of all, family, and the usual one."""

EXCHANGED = {"reference.kind": ("reference", "kind", ()), "plant.model": ("plant", "model", ("drive", "every"))}
"""Paths that name a block which is alone in its table: the table, the key, and what else may stand there."""

ONE_AMPLITUDE = {"reference.amplitude_v": "amplitude_um", "reference.amplitude_um": "amplitude_v"}
"""An amplitude is given in volts or in micrometres; setting one drops the other."""

ONE_DRIVE = {"plant.drive": ("drive", "kind"), "drive.kind": ("plant", "drive")}
"""How the drive works is said at the plant or at the drive; setting one drops the other."""

LONGEST_PATH = 60
"""Characters of a path that is told back because of its length."""

DEFAULTS: Document = {
    "device": {"id": "ch3"},
    "plant": {},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 1000.0},
    "controller": {"kind": "open_loop"},
    "sensor": {"kind": "ideal"},
}

SECTIONS = (
    "device",
    "environment",
    "plant",
    "reference",
    "model",
    "controller",
    "controllers",
    "sensor",
    "sensors",
    "drive",
    "guard",
    "identifiers",
    "diagnosers",
    "twins",
)


def normal_form(document: Document) -> Document:
    """Return a copy with defaults in place and the parameters of controller and sensor parked."""
    return completed(copy.deepcopy(document))


def completed(document: Document) -> Document:
    """Return the normal form of a document; it shares the tables that stay as they are."""
    doc = {**document, **{key: copy.deepcopy(value) for key, value in DEFAULTS.items() if key not in document}}
    for key in SECTIONS:
        if key in doc and not isinstance(doc[key], dict):
            raise InputError(f"must be a table, got {short(doc[key])}", key)
    for key in ("controllers", "sensors", "identifiers", "diagnosers"):
        for name, table in doc.get(key, {}).items():
            if not isinstance(table, dict):
                raise InputError(f"must be a table, got {short(table)}", f"{key}.{name}")
    for one, (_, family, usual) in PARKED.items():
        registry.block(family, doc[one].get("kind", usual), f"{one}.kind")
    _park(doc)
    return doc


def _park(doc: Document) -> None:
    """Move the parameters of the controller and the sensor in use to where those of all are."""
    for one, (all_of_them, _, usual) in PARKED.items():
        table = doc.get(one)
        if isinstance(table, dict):
            kind = table.get("kind", usual)
            rest = {name: value for name, value in table.items() if name != "kind"}
            if rest and isinstance(kind, str):
                group = doc.get(all_of_them, {})
                doc[all_of_them] = {**group, kind: {**group.get(kind, {}), **rest}}
            doc[one] = {"kind": kind}


def with_values(document: Document, values: dict[str, Any]) -> Document:
    """Return a copy of the document with dotted paths written over; tables on the way are made."""
    return written_over(copy.deepcopy(document), values)


def written_over(document: Document, values: dict[str, Any]) -> Document:
    """Return the document with dotted paths written over; it shares the tables that stay as they are."""
    doc = dict(document)
    _park(doc)
    for path, value in values.items():
        _write(doc, path, value)
    return doc


def _write(doc: Document, path: str, value: Any) -> None:
    """Write one value, into copies of the tables on its way."""
    parts = path.split(".")
    if not all(parts):
        raise InputError("is not a dotted path", path)
    if len(parts) + depth(value) > DEEPEST:
        shown = path if len(path) <= LONGEST_PATH else f"{path[:LONGEST_PATH]}…"
        raise InputError(TOO_DEEP, shown, code="too_deep")
    table: Any = doc
    for part in parts[:-1]:
        place: Any = _position(part, table, path) if isinstance(table, list) else part
        inner = table[place] if isinstance(table, list) else table.get(part, {})
        if not isinstance(inner, dict | list):
            raise InputError(f"{part} is not a table", path)
        table[place] = copy.copy(inner)
        table = table[place]
    if isinstance(table, list):
        table[_position(parts[-1], table, path)] = copy.deepcopy(value)
        return
    table[parts[-1]] = copy.deepcopy(value)
    if path in ONE_AMPLITUDE:
        table.pop(ONE_AMPLITUDE[path], None)
    if path in ONE_DRIVE:
        section, key = ONE_DRIVE[path]
        if isinstance(doc.get(section), dict):
            doc[section] = {name: entry for name, entry in doc[section].items() if name != key}
    if path in EXCHANGED:
        # a new kind keeps what it shares with the old one
        section, key, shared = EXCHANGED[path]
        fields = {key, *shared, *registry.block(section, value, path).Params.model_fields}
        doc[section] = {name: entry for name, entry in table.items() if name in fields}


def _position(part: str, items: list[Any], path: str) -> int:
    if not POSITION.fullmatch(part) or int(part) >= len(items):
        raise InputError(f"{short(part)} is not a position in a list of {len(items)}", path)
    return int(part)


def written(document: Document) -> list[str]:
    """Return the paths of a document in tables from which the normal form takes something elsewhere."""
    return [f"{one}.{name}" for one in ("plant", *PARKED) for name in document.get(one, {})]


def as_written(error: InputError, document: Document, paths: Iterable[str]) -> InputError:
    """Name a field by the path it was written at, not by where the normal form keeps it."""
    for path in paths:
        kept = _kept(path, document)
        if f"{error.field}.".startswith(f"{kept}."):
            return InputError(error.message, path + error.field.removeprefix(kept), error.hint, error.code)
    return error


def _kept(path: str, document: Document) -> str:
    """Return where the normal form keeps what is written at a path."""
    if path == "plant.drive":
        return "drive.kind"
    one, _, rest = path.partition(".")
    if one not in PARKED or rest in ("", "kind"):
        return path
    all_of_them, _, usual = PARKED[one]
    return f"{all_of_them}.{document.get(one, {}).get('kind', usual)}.{rest}"
