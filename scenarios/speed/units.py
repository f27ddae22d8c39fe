"""Cost of a unit of one's own, measured on a bench that has it."""

from __future__ import annotations

from core.own.unit import Unit
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.speed import gyroscope
from scenarios.speed.timing import ALIVE, block_costs

WARM_TICKS = 2000
WHERE = {
    "control": ({}, "{name}"),
    "reference": ({"reference.kind": "{name}"}, "reference"),
    "sense": ({"sensor.kind": "{name}"}, "{name}"),
    "diagnose": ({"diagnosers.{name}.kind": "{name}"}, "{name}"),
    "identify": ({"identifiers.{name}.kind": "{name}"}, "{name}"),
    "faults": ({}, "faults.{name}"),
    "readout": ({"readouts.{name}.kind": "{name}"}, "{name}"),
}
"""Values of a bench that has a unit of each family in use, and the block to measure."""


def cost_ns(unit: Unit) -> float:
    """Return the time of a sample, ns: of a first look with this unit, its step run once more.

    Raises
    ------
    InputError
        When a bench cannot have the unit with the parameters it has by itself.
    """
    values, key = WHERE[unit.family]
    named = {path.format(name=unit.name): value.format(name=unit.name) for path, value in values.items()}
    table = {f"units.{unit.name}.source": unit.source, "expect": [], "events": []}
    base, alive = ("gyro-first-look", gyroscope.ALIVE) if unit.block.axes else ("first-look", ALIVE)
    board = build(with_values(get(base), table | named))
    board.advance(WARM_TICKS)
    instance = key.format(name=unit.name)
    cost = block_costs(board, instance, alive=[one for one in alive if one != instance])[instance]
    return max(0.0, cost)
