"""A bench as it is written: a document, its normal form, and values written over by dotted path."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable
from functools import cache
from typing import Any

from core import registry
from core.block import Block
from core.board.library import library_of
from core.device.catalogue import device
from core.errors import InputError, short
from core.nesting import DEEPEST, TOO_DEEP, depth

Document = dict[str, Any]
POSITION = re.compile(r"[0-9]{1,9}")

PARKED = {"controller": ("controllers", "control"), "sensor": ("sensors", "sense")}
"""All of these run and one is in use: table of the one in use, table of all, and family."""

EXCHANGED = {
    "reference.kind": ("reference", "reference", "kind", ()),
    "plant.model": ("plant", "plant", "model", ("drive", "every")),
    "supervisor.kind": ("supervisor", "supervise", "kind", ()),
}
"""Paths that name a block which is alone in its table: table, family, key, and the other keys it may have."""

ONE_AMPLITUDE = {"reference.amplitude_v": "amplitude_um", "reference.amplitude_um": "amplitude_v"}
"""An amplitude is given in volts or in micrometres; setting one drops the other."""

ONE_DRIVE = {"plant.drive": ("drive", "kind"), "drive.kind": ("plant", "drive")}
"""The plant or the drive gives the kind of drive; setting one drops the other."""

ONE_STEP = ("bits", "quantum_v", "quantum_un", "quantum_um")
"""Spellings of the step of a converter; setting one drops the others."""

LONGEST_PATH = 60
"""Characters that an error message shows of a long path."""

DEVICE = {"id": "ch3"}
REFERENCE = {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 1000.0}
GENERATOR = {"kind": "constant"}
SILENT: Document = {**GENERATOR, "amplitude_v": 0.0}
"""A reference that does nothing."""

ONE_DISPLACEMENT = ("reference", "model")
"""Sections that a bench whose plant has axes cannot have."""

CHOSEN = {"identifiers": "identify", "diagnosers": "diagnose", "readouts": "readout"}
"""Tables of blocks that a bench has by names of its own, each with its family."""

SUPERVISOR = "supervisor"
"""The table of the block that acts on the verdict of a diagnoser, and the name of that block."""

SECTIONS = (
    "device",
    "environment",
    "plant",
    "reference",
    "model",
    "slots",
    "controller",
    "controllers",
    "sensor",
    "sensors",
    "drive",
    "board",
    "guard",
    "identifiers",
    "diagnosers",
    SUPERVISOR,
    "readouts",
    "twins",
    "units",
    "packages",
)


@cache
def generators() -> dict[str, str]:
    """Return the generators of all plants, each with its family."""
    return {key: family for plant in registry.blocks("plant").values() for key, family in plant.generators.items()}


@cache
def sections() -> tuple[str, ...]:
    """Return the keys of all tables a bench may have."""
    return (*SECTIONS, *generators())


def plant_of(document: Document) -> type[Block]:
    """Return the plant of a bench: the one it names, or the usual one of its device."""
    for key in ("plant", "device"):
        if not isinstance(document.get(key, {}), dict):
            raise InputError(f"must be a table, got {short(document[key])}", key)
    model = document.get("plant", {}).get("model")
    if model is None:
        model = device(document.get("device", DEVICE)).usual_plant
    return registry.block("plant", model, "plant.model")


def defaults(plant: type[Block]) -> Document:
    """Return the sections that a bench with this plant has by default."""
    *others, last = plant.slots.items()
    usual: Document = {
        "device": DEVICE,
        "plant": {},
        "controller": {"kind": last[1]},
        "sensor": {"kind": plant.usual_sensor},
        **{key: SILENT if family == "reference" else GENERATOR for key, family in plant.generators.items()},
    }
    if others:
        usual["slots"] = dict(others)
    if not plant.axes:
        usual["reference"] = REFERENCE
    return usual


def normal_form(document: Document) -> Document:
    """Return a copy with defaults in place and the parameters of controller and sensor parked."""
    return completed(copy.deepcopy(document))


def completed(document: Document) -> Document:
    """Return the normal form of a document; it shares the tables that stay as they are."""
    for key in sections():
        if key in document and not isinstance(document[key], dict):
            raise InputError(f"must be a table, got {short(document[key])}", key)
    plant = plant_of(document)
    usual = defaults(plant)
    doc = {**document, **{key: copy.deepcopy(value) for key, value in usual.items() if key not in document}}
    for key in ("controllers", "sensors", *CHOSEN):
        for name, table in doc.get(key, {}).items():
            if not isinstance(table, dict):
                raise InputError(f"must be a table, got {short(table)}", f"{key}.{name}")
    for one, (_, family) in PARKED.items():
        library_of(doc).block(family, doc[one].get("kind", usual[one]["kind"]), f"{one}.kind")
    _park(doc, usual)
    gaps = [key for key in plant.generators if "kind" not in doc[key]]
    if not usual.get("slots", {}).keys() <= doc.get("slots", {}).keys():
        gaps.append("slots")
    for key in gaps:
        doc[key] = {**usual[key], **doc[key]}
    return doc


def _park(doc: Document, usual: Document) -> None:
    """Move the parameters of the controller and the sensor in use to the tables of all of them."""
    for one, (all_of_them, _) in PARKED.items():
        table = doc.get(one)
        if isinstance(table, dict):
            kind = table.get("kind", usual[one]["kind"])
            rest = {name: value for name, value in table.items() if name != "kind"}
            if rest and isinstance(kind, str):
                group = doc.get(all_of_them, {})
                doc[all_of_them] = {**group, kind: {**group.get(kind, {}), **rest}}
            if table != {"kind": kind}:
                doc[one] = {"kind": kind}


def with_values(document: Document, values: dict[str, Any]) -> Document:
    """Return a copy of the document with dotted paths written over; tables on the way are made."""
    return written_over(copy.deepcopy(document), values)


def written_over(document: Document, values: dict[str, Any]) -> Document:
    """Return the document with dotted paths written over; it shares the tables that stay as they are."""
    doc = dict(document)
    _park(doc, defaults(plant_of(document)))
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
    if parts[-1] in ONE_STEP and value:
        _drop_other_steps(doc, path)
    if path in ONE_AMPLITUDE:
        table.pop(ONE_AMPLITUDE[path], None)
    if path in ONE_DRIVE:
        section, key = ONE_DRIVE[path]
        if isinstance(doc.get(section), dict):
            doc[section] = {name: entry for name, entry in doc[section].items() if name != key}
    exchanged = _exchanged(path)
    if exchanged is not None:
        # a new kind keeps the fields that it shares with the old one
        section, family, key, shared = exchanged
        fields = {key, *shared, *library_of(doc).block(family, value, path).Params.model_fields}
        doc[section] = {name: entry for name, entry in table.items() if name in fields}


def _drop_other_steps(doc: Document, path: str) -> None:
    """Leave a converter the spelling of its step that a path has just set; a sensor in use may have parked another."""
    for kept in (path, _kept(path, doc)):
        *way, leaf = kept.split(".")
        table: Any = doc
        for part in way:
            if not isinstance(table.get(part), dict):
                break
            table[part] = dict(table[part])
            table = table[part]
        else:
            for name in {*ONE_STEP} - {leaf}:
                table.pop(name, None)


def _exchanged(path: str) -> tuple[str, str, str, tuple[str, ...]] | None:
    """Return table, family, key and other allowed keys, of a path that names a block alone in its table."""
    if path in EXCHANGED:
        return EXCHANGED[path]
    section, _, key = path.partition(".")
    family = generators().get(section)
    return (section, family, key, ()) if family is not None and key == "kind" else None


def _position(part: str, items: list[Any], path: str) -> int:
    if not POSITION.fullmatch(part) or int(part) >= len(items):
        raise InputError(f"{short(part)} is not a position in a list of {len(items)}", path)
    return int(part)


def says_the_same(one: Any, other: Any) -> bool:
    """Return whether two parts of documents say the same, to the sign of a zero."""
    return one is other or repr(one) == repr(other)


def has(document: Document, path: str) -> bool:
    """Return whether a document says something at a path; parameters of controllers and sensors may be parked."""
    if _leads(document, path.split(".")):
        return True
    one, _, rest = path.partition(".")
    group = document.get(PARKED[one][0], {}) if one in PARKED else {}
    return bool(rest) and any(_leads(table, rest.split(".")) for table in group.values())


def _leads(table: Any, parts: list[str]) -> bool:
    """Return whether dotted parts lead to something in nested tables and lists."""
    for part in parts:
        if isinstance(table, dict) and part in table:
            table = table[part]
        elif isinstance(table, list) and POSITION.fullmatch(part) and int(part) < len(table):
            table = table[int(part)]
        else:
            return False
    return True


def written(document: Document) -> list[str]:
    """Return the paths of a document in the tables from which the normal form moves values to another table."""
    return [f"{one}.{name}" for one in ("plant", *PARKED) for name in document.get(one, {})]


def as_written(error: InputError, document: Document, paths: Iterable[str]) -> InputError:
    """Name a field by the path it was written at, not by where the normal form keeps it."""
    for path in paths:
        kept = _kept(path, document)
        if f"{error.field}.".startswith(f"{kept}."):
            return InputError(error.message, path + error.field.removeprefix(kept), error.hint, error.code)
    return error


def _kept(path: str, document: Document) -> str:
    """Return the path at which the normal form keeps the value of a path."""
    if path == "plant.drive":
        return "drive.kind"
    one, _, rest = path.partition(".")
    if one not in PARKED or rest in ("", "kind"):
        return path
    all_of_them, _ = PARKED[one]
    kind = document.get(one, {}).get("kind") or defaults(plant_of(document))[one]["kind"]
    return f"{all_of_them}.{kind}.{rest}"
