"""Schemas of blocks: a definition for each, and one for each family, chosen by the key that names its kind."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from core import registry
from core.block import Block, BlockParams
from core.board.library import IDENTIFIER
from core.faults.fault import FaultParams
from core.loop.drive import Drive
from scenarios.json_schema.definitions import Definitions, Schema, ref, summary
from scenarios.studies import studies

NAMES = {
    "reference": "Reference",
    "rate": "Rate",
    "plant": "Plant",
    "sense": "Sensor",
    "control": "Controller",
    "identify": "Identifier",
    "diagnose": "Diagnoser",
    "supervise": "Supervisor",
    "readout": "ReadOut",
    "faults": "Fault",
}
"""The name of each family that a scenario chooses from."""
EVERY: Schema = {
    "type": "integer",
    "minimum": 1,
    "maximum": 10000,
    "default": 1,
    "description": "ticks of the board between two samples of the block",
}


def pascal(name: str) -> str:
    """Return the name of a file as the name of a definition."""
    return "".join(part.capitalize() for part in name.split("_"))


def defined(name: str, family: str) -> str:
    """Return the name of the definition of a block."""
    return pascal(name) + NAMES[family]


def family(definitions: Definitions, name: str, key: str = "kind") -> Schema:
    """Add the blocks of a family, and the union of those a scenario may choose; return the reference to the union."""
    for block in registry.blocks(name).values():
        definitions.add(defined(block.name, name), _block(definitions, block, key))
    return definitions.add(NAMES[name], union({one: defined(one, name) for one in choices(name)}, key))


def choices(family: str) -> list[str]:
    """Return the blocks of a family that a scenario may choose.

    The sensor in use puts out a displacement; ``controller.kind`` names a controller of the last slot of a plant.
    """
    blocks = registry.blocks(family)
    if family == "sense":
        return [name for name, one in blocks.items() if any(port.name == "displacement" for port in one.outputs)]
    if family == "control":
        last = {[*plant.slots][-1] for plant in registry.blocks("plant").values()}
        return [name for name, one in blocks.items() if one.slot in last]
    return list(blocks)


def union(names: Mapping[str, str], key: str) -> Schema:
    """Return the union of definitions by kind; a key names the kind."""
    kinds = {key: {"enum": [*names]}}
    return {"type": "object", "required": [key], "properties": kinds, "oneOf": [ref(name) for name in names.values()]}


def study(definitions: Definitions) -> Schema:
    """Add the studies, and their union; return the reference to the union."""
    names = {name: f"{pascal(name)}Study" for name in studies()}
    for name, kind in studies().items():
        definitions.add(names[name], _chosen(definitions, kind.Params, "kind", name, kind.title))
    return definitions.add("Study", union(names, "kind"))


def usual(definitions: Definitions, name: str, kinds: Iterable[str], key: str = "kind") -> Schema:
    """Return the schema of a table that may leave out the key, and then has one of the usual kinds."""
    return {"anyOf": [family(definitions, name, key), *(ref(defined(kind, name)) for kind in dict.fromkeys(kinds))]}


def parked(definitions: Definitions, name: str) -> Schema:
    """Return the schema of the tables of all blocks of a family: the key of each table is the name of its block."""
    family(definitions, name)
    tables = {
        one: {"allOf": [ref(defined(one, name)), {"not": {"required": ["kind"]}}]} for one in registry.blocks(name)
    }
    return {"type": "object", "properties": tables, "additionalProperties": False}


def named(schema: Schema, most: int | None = None) -> Schema:
    """Return the schema of tables under short names of their own."""
    limit = {} if most is None else {"maxProperties": most}
    return {
        "type": "object",
        "propertyNames": {"pattern": IDENTIFIER.pattern},
        "additionalProperties": schema,
        **limit,
    }


def fault_parameters(definitions: Definitions, name: str) -> tuple[Schema, Schema]:
    """Return the schema of the severity of a fault, and the schema of its other parameters."""
    schema = definitions.model(registry.block("faults", name).Params)
    own = {key: value for key, value in schema["properties"].items() if key not in FaultParams.model_fields}
    table = {"type": "object", "description": schema["description"], "properties": own, "additionalProperties": False}
    return schema["properties"]["severity"], table


def _block(definitions: Definitions, block: type[Block], key: str) -> Schema:
    about = f"{block.title}: {summary(block.__doc__ or '')}"
    more = {"every": EVERY}
    if block.family == "plant":
        more["drive"] = definitions.model(Drive.Params)["properties"]["kind"]
    return _chosen(definitions, block.Params, key, block.name, about, more)


def _chosen(
    definitions: Definitions,
    params: type[BlockParams],
    key: str,
    kind: str,
    about: str,
    more: Mapping[str, Any] | None = None,
) -> Schema:
    """Return the schema of a table: the key that chooses it, and its parameters."""
    schema = definitions.model(params)
    properties = {key: {"const": kind, "description": about}, **schema.get("properties", {}), **(more or {})}
    return {**schema, "description": about, "properties": properties}
