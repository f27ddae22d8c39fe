"""Guard of an axis: stops the board before one axis does harm."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, parameter
from core.loop.guard import BEYOND_TRAVEL, NOT_FINITE, OK, ON_THE_RAIL, PULLED_IN
from core.ports import BlockPorts, output, reads
from core.record import Record


class AxisGuard(Block):
    """Trips on a value that is not finite, travel beyond the stops, a force at its limit most of the time, pull-in.

    Forces alternate, and so leave the limit twice in every period even when a loop has run away: the measure is the
    time at the limit less a quarter of the time below it. A force that is at its limit a fifth of the time is endured.
    Each axis passes its result to the next; the last axis stops the board.
    """

    title = "Guard of an axis"
    per_axis = True

    class Params(BlockParams):
        """When to stop, the same for every axis."""

        travel_um: float = parameter(25.0, "largest displacement", "um", gt=0, le=1000)
        rail_ms: float = parameter(
            50.0, "longest time at the limit of the drive, less a quarter of that below it", "ms", gt=0, le=1e9
        )

    class Packed(Record):
        """Largest displacement, ticks at the limit of the drive."""

        travel_um: float
        rail_ticks: float

    class State(Record):
        """Ticks at the limit, less a quarter of those below it."""

        ticks_at_limit: float

    class Ports(BlockPorts):
        """Signals the guard watches, and its verdict."""

        before: float = reads("@before", "1", "result of the guard of the axis before")
        displacement: float = reads("plant.{axis}", "um", "true displacement")
        velocity: float = reads("plant.{axis}_velocity", "um/ms", "true velocity")
        command: float = reads("@command", "uN", "force asked for")
        saturated: float = reads("drive.{axis}.saturated", "1", "1 while the drive is at its limit")
        pulled_in: float = reads("plant.pulled_in?", "1", "1 where an electrode has pulled the mass in")
        trip: float = output("1", "0 while all is well, else why the board stopped", hidden=True)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        p.rail_ticks = max(1.0, round(params.rail_ms / context.dt_ms))
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Say whether the board must stop."""
        s.ticks_at_limit = max(0.0, s.ticks_at_limit + (1.0 if x.saturated != 0.0 else -0.25))
        code = OK
        if x.before != OK:
            code = x.before
        elif not (math.isfinite(x.displacement) and math.isfinite(x.velocity) and math.isfinite(x.command)):
            code = NOT_FINITE
        elif x.pulled_in != 0.0:
            code = PULLED_IN
        elif abs(x.displacement) > p.travel_um:
            code = BEYOND_TRAVEL
        elif s.ticks_at_limit > p.rail_ticks:
            code = ON_THE_RAIL
        x.trip = code
