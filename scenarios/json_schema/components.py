"""The schemas as components of an OpenAPI document: for generators of clients, which know fewer keywords.

A component has the fields, types and ranges. It always names its kind, from the library alone: a scenario with units of
its own goes as TOML.
"""

from __future__ import annotations

from functools import cache

from pydantic import WithJsonSchema

from core.board.document import CHOSEN, generators
from scenarios.json_schema.blocks import NAMES
from scenarios.json_schema.definitions import Definitions, Schema, walked
from scenarios.json_schema.documents import FILE, campaign
from scenarios.reading import ADDRESS

COMPONENT = "x-component"
"""Stands for a reference to a component, until the whole OpenAPI document is built."""
HERE = "#/components/schemas/"
UNKNOWN = ("if", "then", "not", "allOf", "dependentRequired", "propertyNames", "maxProperties")
"""Keywords that generators do not know; without them a schema says less, and nothing else."""
CHOICES = {"plant": "plant", "reference": "reference", "controller": "control", "sensor": "sense", **generators()}
"""Sections that hold one block, with its family."""
FREE = ("controllers", "sensors", "twins")
"""Sections that repeat the tables of others, without a key that names the kind."""


def described_by(*components: str) -> WithJsonSchema:
    """Describe a table, which another reader checks with one clear line, by components of the OpenAPI document."""
    found: list[Schema] = [{COMPONENT: component} for component in components]
    return WithJsonSchema(found[0] if len(found) == 1 else {"anyOf": found})


@cache
def components() -> dict[str, Schema]:
    """Return the components of requests by name, with the components that they refer to."""
    known = Definitions()
    known.add("Campaign", campaign(known))
    for name in ("Campaign", "Scenario"):  # the address is for files, and generators write its name as "schema"
        del known.found[name]["properties"][ADDRESS]
    scenario = known.found["Scenario"]["properties"]
    for key, family in CHOICES.items():
        scenario[key] = {"description": scenario[key]["description"], "$ref": f"#/$defs/{NAMES[family]}"}
    for key, family in CHOSEN.items():
        tables = {"type": "object", "additionalProperties": {"$ref": f"#/$defs/{NAMES[family]}"}}
        scenario[key] = {"description": scenario[key]["description"], **tables}
    for key in FREE:
        scenario[key] = {"description": scenario[key]["description"], "type": "object", "additionalProperties": True}
    scenario["slots"] = {"description": scenario["slots"]["description"], **_without_title(known.found["SlotsTable"])}
    known.found["Campaign"]["properties"]["scenario"]["anyOf"].remove(FILE)  # a server reads no files of its callers
    known.found["ScenarioId"] = {"title": "ScenarioId", "type": "string", "description": "An id of the library."}
    known.found["Device"]["properties"]["id"] = {"type": "string", "description": "name in the catalogue"}
    unions = {name: one["required"][0] for name, one in known.found.items() if "oneOf" in one}
    members = {_name(ref): unions[name] for name in unions for ref in known.found[name]["oneOf"]}
    found = {name: _component(schema, members.get(name)) for name, schema in known.found.items()}
    found |= {name: _union(found[name], key, known.found) for name, key in unions.items()}
    return {name: found[name] for name in sorted(_needed(found, ["Campaign", "Device", "Environment"]))}


def _component(schema: Schema, key: str | None) -> Schema:
    """Return a definition as a component, which names its kind under a key if it is a member of a union."""

    def known(table: Schema) -> Schema:
        kept = {name: value for name, value in table.items() if name not in UNKNOWN}
        if isinstance(kept.get("const"), int):
            kept["enum"] = [kept.pop("const")]
        if isinstance(kept.get("$ref"), str):
            kept["$ref"] = HERE + _name(kept)
        return kept

    made: Schema = walked(schema, known)
    return made if key is None else {**made, "required": [key, *made.get("required", [])]}


def _union(schema: Schema, key: str, definitions: dict[str, Schema]) -> Schema:
    kinds = {definitions[_name(ref)]["properties"][key]["const"]: ref["$ref"] for ref in schema["oneOf"]}
    title = {"title": schema["title"], "oneOf": schema["oneOf"]}
    return {**title, "discriminator": {"propertyName": key, "mapping": kinds}}


def _without_title(schema: Schema) -> Schema:
    return {key: value for key, value in schema.items() if key != "title"}


def _name(reference: Schema) -> str:
    return str(reference["$ref"]).rpartition("/")[2]


def _needed(found: dict[str, Schema], names: list[str]) -> set[str]:
    """Return the names of components, and of all that they refer to."""
    needed: set[str] = set()
    while names:
        name = names.pop()
        if name not in needed:
            needed.add(name)
            walked(found[name], lambda one: names.append(_name(one)) if isinstance(one.get("$ref"), str) else one)
    return needed
