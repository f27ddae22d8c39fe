"""Guard: stops the board before it does harm."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, FloatArray, Port, parameter

TRAVEL, RAIL_TICKS = range(2)
DISPLACEMENT, VELOCITY, MEASURED, COMMAND, SATURATED, TRIP = range(6)
OK, NOT_FINITE, BEYOND_TRAVEL, ON_THE_RAIL = 0.0, 1.0, 2.0, 3.0
REASONS = {
    1: ("the {signal} is not a finite number", "command"),
    2: ("the shuttle went beyond its travel", "plant.displacement"),
    3: ("the drive stayed at its limit", "drive.voltage"),
}


def guard_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Say whether the board must stop."""
    code = OK
    x = w[io[DISPLACEMENT]]
    s[0] = s[0] + 1.0 if w[io[SATURATED]] != 0.0 else 0.0
    if not (math.isfinite(x) and math.isfinite(w[io[VELOCITY]]) and math.isfinite(w[io[COMMAND]])):
        code = NOT_FINITE
    elif abs(x) > p[TRAVEL]:
        code = BEYOND_TRAVEL
    elif s[0] > p[RAIL_TICKS]:
        code = ON_THE_RAIL
    w[io[TRIP]] = code


class Guard(Block):
    """Trips on a value that is not finite, on travel beyond the stops, on a drive held at its limit."""

    title = "Guard"
    inputs = (
        Port("displacement", "um", "true displacement", source="plant.displacement"),
        Port("velocity", "um/ms", "true velocity", source="plant.velocity"),
        Port("measured", "um", "measured displacement", source="sensor.displacement"),
        Port("command", "V", "voltage asked for", source="@active"),
        Port("saturated", "1", "1 while the drive is at its limit", source="drive.saturated"),
    )
    outputs = (Port("trip", "1", "0 while all is well, else why the board stopped", hidden=True),)

    class Params(BlockParams):
        """When to stop."""

        travel_um: float = parameter(25.0, "largest displacement", "um", gt=0, le=1000)
        rail_ms: float = parameter(5.0, "longest time without a break at the limit of the drive", "ms", gt=0)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array([params.travel_um, max(1.0, round(params.rail_ms / context.dt_ms))])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Ticks at the limit."""
        return np.zeros(1)

    step = guard_step
