"""The counterpart of a scenario: the same with its controllers taken away, to see what they are worth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from core.board.commands import Switch
from core.board.document import Document
from core.errors import InputError
from scenarios.edit import written
from scenarios.run import run
from scenarios.schema import Scenario

OPEN = ("open_loop", "open_loop_rate")
"""The open loop of one displacement, and of the sense axis: a read-out that puts no force on it."""


def counterpart(scenario: Scenario, kind: str = "open_loop") -> Scenario | None:
    """Return the scenario with another controller in place of every one that drives, in its events and twins too.

    The same faults come at the same moments; switches lead to the other controller, and what events set of the
    controller in use is left out. The drive loop of a gyroscope goes on, because without it nothing swings; its sense
    axis is read in the open loop.

    Returns
    -------
    Scenario or None
        None where there is nothing to take away: studies, scenarios in the open loop, and a PID for a plant with axes.
    """
    switches = [command.switch for event in scenario.events for command in event if isinstance(command, Switch)]
    drive = {scenario.spec.active, *(twin.active for twin in scenario.twins.values()), *switches}
    if scenario.study is not None or drive <= {*OPEN, kind}:
        return None
    if scenario.spec.axes:
        if kind != "open_loop":
            return None
        kind = OPEN[1]
    values: Document = {"controller.kind": kind}
    for name, own in scenario.document.get("twins", {}).items():
        if "controller" in own:
            values[f"twins.{name}.controller"] = {"kind": kind}
    values["events"] = [event for event in (_without(entry, kind) for entry in scenario.head.events) if event]
    return Scenario.load(written(scenario.document, values))


def _without(event: Document, kind: str) -> Document | None:
    """Return an event with another controller, None if nothing is left of it."""
    kept = {name: value for name, value in event.items() if name != "cold"}
    if "switch" in kept:
        kept["switch"] = kind
    if "set" in kept:
        kept["set"] = {path: value for path, value in kept["set"].items() if not path.startswith("controller.")}
        if not kept["set"]:
            del kept["set"]
    return kept if {"switch", "set", "heal", "fault", "reset_trip"} & kept.keys() else None


def compared(scenario: Scenario, seeds: Sequence[int]) -> dict[str, dict[str, float]]:
    """Return the figures of the counterparts that the expectations are compared with, means over the seeds."""
    kinds = ["open_loop"] if scenario.head.expect else []
    kinds += ["pid"] if any(entry.compare == "pid" for entry in scenario.head.expect) else []
    found = {}
    for kind in kinds:
        try:
            other = counterpart(scenario, kind)
        except InputError:  # the plant has none
            continue
        if other is not None:
            runs = [run(other, seed).metrics for seed in seeds]
            names = {name for figures in runs for name in figures}
            means = {name: float(np.mean([one[name] for one in runs if name in one])) for name in names}
            found[kind] = {name: mean for name, mean in means.items() if math.isfinite(mean)}
    return found


def beside(summary: dict[str, Any], scenario: Scenario) -> dict[str, Any]:
    """Return the summary of a run with the figures of its counterparts beside each expectation."""
    first, last = summary.get("seeds", [summary["seed"]] * 2)
    others = compared(scenario, range(first, last + 1))
    rows = zip(summary["expectations"], scenario.head.expect, strict=True)
    return {
        **summary,
        "expectations": [
            {
                **row,
                "open_loop": others.get("open_loop", {}).get(entry.metric),
                "pid": others.get("pid", {}).get(entry.metric) if entry.compare == "pid" else None,
            }
            for row, entry in rows
        ],
    }
