"""A command in words."""

from __future__ import annotations

from core.board.commands import Command, HealFaults, Inject, MakeSafe, ResetTrip, SetValues, Switch
from core.board.library import Library
from core.errors import short
from core.format import format_short


def describe(command: Command, library: Library) -> str:
    """Describe a command on a bench with these blocks in words."""
    if isinstance(command, Inject):
        shape = "" if command.profile.kind == "step" else f", {command.profile.kind}"
        chosen = "".join(f", {name} {short(value)}" for name, value in command.parameters.items())
        return f"inject {command.fault} {_severity(command, library)}{shape}{chosen}"
    if isinstance(command, HealFaults):
        return "heal all" if command.heal == "all" else f"heal {', '.join(command.heal)}"
    if isinstance(command, SetValues):
        return "set " + ", ".join(f"{path} = {value}" for path, value in command.set.items())
    if isinstance(command, Switch):
        return f"switch to {command.switch}{' from a cold start' if command.cold else ''}"
    if isinstance(command, MakeSafe):
        return f"safe outputs: {command.make_safe}"
    assert isinstance(command, ResetTrip)
    return "reset after the trip"


def _severity(command: Inject, library: Library) -> str:
    """Return a severity with its sign and unit; a share has none."""
    block = library.blocks("faults").get(command.fault)
    unit = block.outputs[0].unit if block is not None else "1"
    return f"{'' if command.severity < 0.0 else '+'}{format_short(command.severity, unit, 6)}"
