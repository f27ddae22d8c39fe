"""The schema of an event: the fields of all commands, and the parameters of each fault."""

from __future__ import annotations

from core.board.commands import COMMANDS
from core.registry import blocks
from scenarios.json_schema.blocks import defined, fault_parameters
from scenarios.json_schema.definitions import Definitions, Schema, ref

MOMENTS = ("at_sample", "at_ms", "when")


def event(definitions: Definitions) -> Schema:
    """Add an event as any bench takes it; return the reference.

    Its fields have no defaults: a field of a command that the event does not give is refused.
    """
    fields: dict[str, Schema] = {}
    for model in COMMANDS.values():
        for name, field in definitions.model(model)["properties"].items():
            fields[name] = {key: value for key, value in field.items() if key != "default"}
    table = {
        "type": "object",
        "description": "Commands to the bench at one moment.",
        "properties": fields,
        "allOf": [{"anyOf": [{"required": [name]} for name in names]} for names in (COMMANDS, MOMENTS)],
        "dependentRequired": {"fault": ["severity"], "severity": ["fault"]},
        "additionalProperties": False,
    }
    return definitions.add("ScenarioEvent", table)


def library_event(definitions: Definitions) -> Schema:
    """Add an event of a bench without units of its own: all its blocks are in the library; return the reference."""
    cases = []
    for name in blocks("faults"):
        severity, parameters = fault_parameters(definitions, name)
        own = definitions.add(defined(name, "faults"), parameters)
        named = {"properties": {"fault": {"const": name}}, "required": ["fault"]}
        cases.append({"if": named, "then": {"properties": {"severity": severity, "parameters": own}}})
    faults = [*blocks("faults")]
    choices = {
        "fault": {"enum": faults},
        "heal": {"anyOf": [{"const": "all"}, {"type": "array", "items": {"enum": faults}}]},
        "switch": {"enum": [*blocks("control")]},
    }
    return definitions.add("LibraryEvent", {"properties": choices, "allOf": cases})


def events(most: int) -> Schema:
    """Return the schema of a list of events."""
    return {"type": "array", "items": ref("ScenarioEvent"), "maxItems": most}
