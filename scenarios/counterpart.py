"""The counterpart of a scenario: the same without its controllers, for a comparison."""

from __future__ import annotations

from core.board.commands import COMMANDS, Switch
from core.board.document import Document
from scenarios.edit import written
from scenarios.schema import Scenario

OPEN = ("open_loop", "open_loop_rate")
"""The open loop of one displacement, and of the sense axis: a read-out that puts no force on it."""


def counterpart(scenario: Scenario, kind: str = "open_loop") -> Scenario | None:
    """Return the scenario with another controller in place of every driving controller, in its events and twins too.

    The same faults come at the same moments; switches lead to the other controller, and events that set parameters of
    the controller in use are left out. The drive loop of a gyroscope stays, because without it there is no oscillation;
    its sense axis is read in the open loop, and a slot between them has its usual controller.

    Returns
    -------
    Scenario or None
        None where there is nothing to take away: studies, scenarios in the open loop. A PID is the comparator of the
        scenario; None where it has none.
    """
    values = replaced(scenario, kind)
    return Scenario.load(written(scenario.document, values)) if values else None


def replaced(scenario: Scenario, kind: str) -> Document:
    """Return the fields that the counterpart writes over its scenario; empty without a controller."""
    switches = [command.switch for event in scenario.events for command in event if isinstance(command, Switch)]
    drive = {scenario.spec.active, *(twin.active for twin in scenario.twins.values()), *switches}
    usual = scenario.spec.plant.block.slots
    between = [(slot, name) for slot, name in list(scenario.spec.driving.items())[1:-1] if name != usual[slot]]
    if scenario.study is not None or (drive <= {*OPEN, kind} and not between):
        return {}
    other = scenario.head.comparator if kind == "pid" else None
    if kind == "pid" and (other is None or scenario.spec.axes):
        return {}
    if scenario.spec.axes:
        kind = OPEN[1]
    values: Document = {"controller.kind": kind} if other is None else {"controller": other.controller}
    values |= {f"slots.{slot}": usual[slot] for slot, _ in between}
    for name, own in scenario.document.get("twins", {}).items():
        if "controller" in own:
            values[f"twins.{name}.controller"] = {"kind": kind} if other is None else other.controller
    values["events"] = [event for event in (_without(entry, kind) for entry in scenario.head.events) if event]
    return values


def _without(event: Document, kind: str) -> Document | None:
    """Return an event with another controller, None if nothing is left of it."""
    kept = {name: value for name, value in event.items() if name != "cold"}
    if "switch" in kept:
        kept["switch"] = kind
    if "set" in kept:
        kept["set"] = {path: value for path, value in kept["set"].items() if not path.startswith("controller.")}
        if not kept["set"]:
            del kept["set"]
    return kept if COMMANDS.keys() & kept.keys() else None
