"""The schema of a bench: its sections, from the registry of blocks and the models of the parts that every bench has."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from core import registry
from core.block import Block
from core.board.document import CHOSEN, generators, sections
from core.board.ensemble import MOST as MOST_TWINS
from core.board.ensemble import OWN
from core.board.library import MOST_UNITS
from core.board.packages import NAME, PackageEntry
from core.board.spec import BoardSettings
from core.board.stages import AxesBoardParams, BoardParams
from core.device.catalogue import devices
from core.device.device import Device
from core.loop.axis_drive import AxisDrive
from core.loop.axis_guard import AxisGuard
from core.loop.drive import Drive
from core.loop.environment import Environment
from core.loop.guard import Guard
from core.loop.model import Model
from scenarios.json_schema.blocks import family, named, parked, pascal, usual
from scenarios.json_schema.definitions import Definitions, Schema, ref

ABOUT = {
    "device": "the device: an id of the catalogue, and values that replace its own",
    "environment": "the air around the device, and its age",
    "plant": "the equations of motion of the device",
    "reference": "the signal that drives the loop",
    "model": "the reference model, which a controller makes the device follow",
    "slots": "the controllers of the other slots of a plant with several, by slot",
    "controller": "the controller that drives",
    "controllers": "parameters of all controllers, by kind; the others run in shadow",
    "sensor": "the sensor in use",
    "sensors": "parameters of all sensors, by kind",
    "drive": "the stage between the controller and the device",
    "board": "the stages around the converters: filter and sampling before them, delay and amplifier behind",
    "guard": "the limits at which the bench takes its outputs to their safe values",
    "identifiers": "identifiers, each under a name of your own",
    "diagnosers": "diagnosers, each under a name of your own",
    "supervisor": "the supervisor, which acts on the verdict of a diagnoser",
    "readouts": "read-outs of a gyroscope, each under a name of your own",
    "twins": "benches that run beside this one and differ from it in some sections, each under a name of your own",
    "units": "units of your own, by name: their text",
    "packages": "installed packages whose blocks the bench names; the bench writes this table itself",
    "rate": "the angular rate of the frame of a gyroscope",
    "waveform": "the waveform that a controller of a gyroscope may put out",
}
"""The meaning of each section; the generators of an installed plant may have other names."""
CHOOSES = ("plant", "reference", "slots", "controller", "controllers", "sensor", "sensors", "identifiers", "diagnosers",
           "supervisor", "readouts", "twins")  # fmt: skip
"""Sections that name blocks, besides the generators: units of a bench's own may be among these blocks."""

UNIT: Schema = {
    "type": "object",
    "description": "A unit of your own.",
    "properties": {"source": {"type": "string", "description": "its text, in Python"}},
    "required": ["source"],
    "additionalProperties": False,
}


def bench(definitions: Definitions) -> tuple[dict[str, Schema], tuple[str, ...]]:
    """Return the schema of each key of a bench, and the keys in which units of its own may be named."""
    settings: dict[str, Schema] = definitions.model(BoardSettings)["properties"]
    found = {key: make(definitions) for key, make in _SECTIONS.items()}
    found |= {key: usual(definitions, name, ["constant"]) for key, name in generators().items()}
    choosing = (*CHOOSES, *generators())
    found |= {key: definitions.add(f"{pascal(key)}Table", found[key]) for key in choosing if key in found}
    found["twins"] = definitions.add("TwinsTable", _twins(definitions, found))
    return {**settings, **{key: {"description": ABOUT.get(key, key), **found[key]} for key in sections()}}, choosing


def device(definitions: Definitions) -> Schema:
    """Add the device, any of whose values may be left out; return the reference."""
    own = Definitions()
    own.add("Device", own.model(Device))
    own.found["Device"]["properties"]["id"] = {
        "enum": [one.id for one in devices()],
        "description": "name in the catalogue",
    }
    for name, schema in own.found.items():
        definitions.fix(name, {key: value for key, value in schema.items() if key != "required"})
    return ref("Device")


def _either(*blocks: type[Block]) -> Callable[[Definitions], Schema]:
    """Return a maker of a section that every bench has; where there are two such blocks, the plant decides."""

    def made(definitions: Definitions) -> Schema:
        found = [definitions.add(pascal(one.name), definitions.model(one.Params)) for one in blocks]
        return found[0] if len(found) == 1 else {"anyOf": found}

    return made


def _board(definitions: Definitions) -> Schema:
    """Return the schema of the stages of a board; the plant decides between the two."""
    return {"anyOf": [definitions.add(one.__name__, definitions.model(one)) for one in (BoardParams, AxesBoardParams)]}


def _slots() -> Schema:
    blocks = registry.blocks("control").values()
    others = dict.fromkeys(slot for plant in registry.blocks("plant").values() for slot in [*plant.slots][:-1])
    return {
        "type": "object",
        "properties": {slot: {"enum": [one.name for one in blocks if one.slot == slot]} for slot in others},
        "additionalProperties": False,
    }


def _twins(definitions: Definitions, found: dict[str, Schema]) -> Schema:
    """Return the schema of the twins: a table without its kind changes values of the bench, which is not looked up."""

    def table(key: str) -> Schema:
        if key in CHOSEN:
            return named(_if_named("kind", family(definitions, CHOSEN[key])))
        kinds = {"plant": "model", "controller": "kind", "sensor": "kind"}
        return _if_named(kinds[key], found[key]) if key in kinds else found[key]

    tables = {key: table(key) for key in OWN}
    return named({"type": "object", "properties": tables, "additionalProperties": False}, MOST_TWINS)


def _if_named(key: str, schema: Schema) -> Schema:
    return {"type": "object", "if": {"required": [key]}, "then": schema}


def _chosen(name: str, definitions: Definitions) -> Schema:
    """Return the schema of blocks of a family, each under a name of the bench's own."""
    return named(family(definitions, name))


def _packages(definitions: Definitions) -> Schema:
    entry = definitions.add("PackageEntry", definitions.model(PackageEntry))
    return {"type": "object", "propertyNames": {"pattern": f"^{NAME.pattern}$"}, "additionalProperties": entry}


def _of_plants(choose: Callable[[type[Block]], str]) -> list[str]:
    """Return the usual block of each plant, for a bench that chooses none."""
    return [choose(plant) for plant in registry.blocks("plant").values()]


_SECTIONS: dict[str, Callable[[Definitions], Schema]] = {
    "device": device,
    "environment": _either(Environment),
    "plant": lambda known: usual(known, "plant", [one.usual_plant for one in devices()], "model"),
    "reference": lambda known: family(known, "reference"),
    "model": _either(Model),
    "slots": lambda _: _slots(),
    "controller": lambda known: usual(known, "control", _of_plants(lambda plant: [*plant.slots.values()][-1])),
    "controllers": lambda known: parked(known, "control"),
    "sensor": lambda known: usual(known, "sense", _of_plants(lambda plant: plant.usual_sensor)),
    "sensors": lambda known: parked(known, "sense"),
    "drive": _either(Drive, AxisDrive),
    "board": _board,
    "guard": _either(Guard, AxisGuard),
    **{key: partial(_chosen, name) for key, name in CHOSEN.items()},
    "supervisor": lambda known: family(known, "supervise"),
    "units": lambda known: named(known.add("OwnUnit", UNIT), MOST_UNITS),
    "packages": _packages,
}
"""Makers of the sections, in the order of their definitions."""
