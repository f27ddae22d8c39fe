"""Cost of a unit, measured on a bench that has it, and the additional cost of the wall."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from core.block import Block
from core.wall import wall
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.speed import gyroscope
from scenarios.speed.boards import begun
from scenarios.speed.timing import ALIVE, block_costs, loop_cost
from scenarios.wall import with_unit

WARM_TICKS = 2000
WHERE = {
    "control": ({}, "{name}"),
    "reference": ({"reference.kind": "{name}"}, "reference"),
    "sense": ({"sensor.kind": "{name}"}, "{name}"),
    "diagnose": ({"diagnosers.{name}.kind": "{name}"}, "{name}"),
    "identify": ({"identifiers.{name}.kind": "{name}"}, "{name}"),
    "faults": ({}, "faults.{name}"),
    "supervise": ({"supervisor.kind": "{name}"}, "supervisor"),
    "readout": ({"readouts.{name}.kind": "{name}"}, "{name}"),
}
"""Values of a bench that has a unit of each family in use, and the block to measure."""


def native_and_walled() -> tuple[Callable[[], float], Callable[[], float]]:
    """Return the measurements of a sample of a PID as a unit, ns: in machine code and behind the wall.

    Raises
    ------
    InputError
        When the wall cannot be built here.
    """
    board = begun(with_unit())
    wall.demand()
    wall.demand(False)

    def walled() -> float:
        wall.demand()
        try:
            return loop_cost(board, ["pid"])
        finally:
            wall.demand(False)

    return lambda: loop_cost(board, ["pid"]), walled


def cost_ns(block: type[Block]) -> float | None:
    """Return the time of a sample, ns: of a first look with this unit, its step run once more.

    Of a family that a first look has no choice of, such as plants, there is no such time.

    Raises
    ------
    InputError
        When a bench cannot have the unit with the parameters it has by itself.
    """
    if block.family not in WHERE:
        return None
    (values, key), name = WHERE[block.family], block.name
    table: dict[str, Any] = {path.format(name=name): value.format(name=name) for path, value in values.items()}
    table |= {"expect": [], "events": []}
    if block.text:
        table[f"units.{name}.source"] = block.text
    base, alive = ("gyro-first-look", gyroscope.ALIVE) if block.axes else ("first-look", ALIVE)
    board = build(with_values(get(base), table))
    board.advance(WARM_TICKS)
    instance = key.format(name=name)
    cost = block_costs(board, instance, alive=[one for one in alive if one != instance])[instance]
    return max(0.0, cost)
