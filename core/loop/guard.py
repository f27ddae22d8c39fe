"""Guard: stops the board before it does harm."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, parameter
from core.ports import BlockPorts, output, reads
from core.record import Record

OK, NOT_FINITE, BEYOND_TRAVEL, ON_THE_RAIL, TOUCHING, SHORTED = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0
PULLED_IN = 6.0
REASONS = {
    1: ("the {signal} is not a finite number", "command"),
    2: ("the shuttle went beyond its travel", "plant.displacement"),
    3: ("the drive stayed at its limit", "drive.voltage"),
    4: ("the fingers touched a stator", "plant.lateral"),
    5: ("a comb is shorted", "plant.short"),
    6: ("the tuning electrode pulled the mass in", "plant.pulled_in"),
}


class Guard(Block):
    """Trips on a value that is not finite, travel beyond the stops, contact, a short, a drive held at its limit."""

    title = "Guard"

    class Params(BlockParams):
        """When to stop."""

        travel_um: float = parameter(25.0, "largest displacement", "um", gt=0, le=1000)
        rail_ms: float = parameter(5.0, "longest time without a break at the limit of the drive", "ms", gt=0, le=1e9)
        stop_on_contact: bool = parameter(True, "stop when fingers touch or a comb is shorted; off for experiments")

    class Packed(Record):
        """Largest displacement, ticks at the limit of the drive, whether contact stops the board."""

        travel_um: float
        rail_ticks: float
        stop_on_contact: float

    class State(Record):
        """Ticks at the limit."""

        ticks_at_limit: float

    class Ports(BlockPorts):
        """Signals the guard watches, and its verdict."""

        displacement: float = reads("plant.displacement", "um", "true displacement")
        velocity: float = reads("plant.velocity", "um/ms", "true velocity")
        measured: float = reads("sensor.displacement", "um", "measured displacement")
        command: float = reads("@active", "V", "voltage asked for")
        saturated: float = reads("drive.saturated", "1", "1 while the drive is at its limit")
        contact: float = reads("plant.contact", "1", "1 while fingers touch a stator")
        short: float = reads("plant.short", "1", "shorted combs")
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
        s.ticks_at_limit = s.ticks_at_limit + 1.0 if x.saturated != 0.0 else 0.0
        code = OK
        if not (math.isfinite(x.displacement) and math.isfinite(x.velocity) and math.isfinite(x.command)):
            code = NOT_FINITE
        elif abs(x.displacement) > p.travel_um:
            code = BEYOND_TRAVEL
        elif p.stop_on_contact != 0.0 and x.contact != 0.0:
            code = TOUCHING
        elif p.stop_on_contact != 0.0 and x.short != 0.0:
            code = SHORTED
        elif s.ticks_at_limit > p.rail_ticks:
            code = ON_THE_RAIL
        x.trip = code
