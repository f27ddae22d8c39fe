"""Guard: stops the board before it does harm."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, FloatArray, Port, parameter

TRAVEL, RAIL_TICKS, ON_CONTACT = range(3)
DISPLACEMENT, VELOCITY, MEASURED, COMMAND, SATURATED, CONTACT, SHORT, TRIP = range(8)
OK, NOT_FINITE, BEYOND_TRAVEL, ON_THE_RAIL, TOUCHING, SHORTED = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0
REASONS = {
    1: ("the {signal} is not a finite number", "command"),
    2: ("the shuttle went beyond its travel", "plant.displacement"),
    3: ("the drive stayed at its limit", "drive.voltage"),
    4: ("the fingers touched a stator", "plant.lateral"),
    5: ("a comb is shorted", "plant.short"),
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
    elif p[ON_CONTACT] != 0.0 and w[io[CONTACT]] != 0.0:
        code = TOUCHING
    elif p[ON_CONTACT] != 0.0 and w[io[SHORT]] != 0.0:
        code = SHORTED
    elif s[0] > p[RAIL_TICKS]:
        code = ON_THE_RAIL
    w[io[TRIP]] = code


class Guard(Block):
    """Trips on a value that is not finite, travel beyond the stops, contact, a short, a drive held at its limit."""

    title = "Guard"
    inputs = (
        Port("displacement", "um", "true displacement", source="plant.displacement"),
        Port("velocity", "um/ms", "true velocity", source="plant.velocity"),
        Port("measured", "um", "measured displacement", source="sensor.displacement"),
        Port("command", "V", "voltage asked for", source="@active"),
        Port("saturated", "1", "1 while the drive is at its limit", source="drive.saturated"),
        Port("contact", "1", "1 while fingers touch a stator", source="plant.contact"),
        Port("short", "1", "shorted combs", source="plant.short"),
    )
    outputs = (Port("trip", "1", "0 while all is well, else why the board stopped", hidden=True),)

    class Params(BlockParams):
        """When to stop."""

        travel_um: float = parameter(25.0, "largest displacement", "um", gt=0, le=1000)
        rail_ms: float = parameter(5.0, "longest time without a break at the limit of the drive", "ms", gt=0, le=1e9)
        stop_on_contact: bool = parameter(True, "stop when fingers touch or a comb is shorted; off for experiments")

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array([params.travel_um, max(1.0, round(params.rail_ms / context.dt_ms)), params.stop_on_contact])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Ticks at the limit."""
        return np.zeros(1)

    step = guard_step
