"""A command in words, and as an event of a scenario."""

from __future__ import annotations

from typing import Any

from core import registry
from core.board.commands import Command, Heal, Inject, Set, Switch
from core.errors import short


def describe(command: Command) -> str:
    """Say in words what a command does."""
    if isinstance(command, Inject):
        shape = "" if command.profile.kind == "step" else f", {command.profile.kind}"
        chosen = "".join(f", {name} {short(value)}" for name, value in command.parameters.items())
        return f"inject {command.fault} {command.severity:+g}{_unit_of(command.fault)}{shape}{chosen}"
    if isinstance(command, Heal):
        return "heal all" if command.faults == "all" else f"heal {', '.join(command.faults)}"
    if isinstance(command, Set):
        return "set " + ", ".join(f"{path} = {value}" for path, value in command.values.items())
    if isinstance(command, Switch):
        return f"switch to {command.controller}{' from a cold start' if command.cold else ''}"
    return "reset after the trip"


def _unit_of(fault: str) -> str:
    """Return the unit of a severity, with a space before it; nothing for a share."""
    block = registry.blocks("faults").get(fault)
    unit = block.outputs[0].unit if block is not None else "1"
    return "" if unit == "1" else f" {unit}"


def event(command: dict[str, Any]) -> dict[str, Any]:
    """Return a logged command as an event of a scenario."""
    rest = {key: value for key, value in command.items() if key != "kind"}
    kind = command["kind"]
    if kind == "heal":
        return {**{k: v for k, v in rest.items() if k != "faults"}, "heal": rest["faults"]}
    if kind == "set":
        return {**{k: v for k, v in rest.items() if k != "values"}, "set": rest["values"]}
    if kind == "switch":
        return {
            **{k: v for k, v in rest.items() if k not in ("controller", "cold")},
            "switch": rest["controller"],
            **({"cold": True} if rest.get("cold") else {}),
        }
    if kind == "reset_trip":
        return {**rest, "reset_trip": True}
    if rest["profile"]["kind"] == "step":
        del rest["profile"]  # what a fault does unless told otherwise
    if not rest.get("parameters"):
        rest.pop("parameters", None)
    return rest
