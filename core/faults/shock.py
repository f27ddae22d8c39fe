"""Shock."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Context, Equation, parameter
from core.elementary import floor, sin
from core.faults.fault import RAMP, Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record

STANDARD_GRAVITY = 9.80665
"""um/ms^2, the same number as m/s^2."""


class Shock(Fault):
    r"""Half a sine of acceleration of the frame, :math:`a=a_0\sin(\pi t/T)` for :math:`0<t<T`.

    The static displacement is 40.3 nm per g along x for the device of chapter 3, 10.6 pm sideways. An intermittent
    shock comes once each period.
    """

    title = "Shock"
    group, place = "Surroundings", 24
    shows = "frame"
    changes = (
        "acceleration along x in every plant; along y in the planar plant only. The stops are in the nonlinear and "
        "planar plants"
    )
    suggested = 20.0
    axes = None
    equations = (Equation("pulse", r"a=a_0\sin(\pi t/T),\quad m\ddot x=\dots-ma", "1.3.1"),)

    class Params(FaultParams):
        """Severity is the peak in g."""

        severity: float = parameter(0.0, "peak of the acceleration", "g", ge=-1e5, le=1e5)
        pulse_ms: float = parameter(1.0, "length of the half sine", "ms", gt=0, le=1e4)
        axis: Literal["x", "y"] = parameter("x", "direction: x is the drive, y sideways in the plane")

    class Packed(PackedFault):
        """Profile and severity, ticks of the half sine, and whether it is along y."""

        ticks: float
        along_y: float

    class Ports(BlockPorts):
        """The frame."""

        acceleration: float = effect("acceleration")
        acceleration_side: float = effect("acceleration_side")
        other: float = effect("other")
        severity: float = severity("g", "acceleration of the frame now")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity, profile, length in ticks and axis."""
        p: Shock.Packed = super().pack(params, context)
        p.ticks = max(1.0, params.pulse_ms / context.dt_ms)
        p.along_y = float(params.axis == "y")
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Accelerate the frame over the sample that begins, by the value in its middle."""
        peak = severity_now(p, x.tick)
        since = x.tick - p.start_tick + 0.5
        if p.kind > RAMP:
            since -= p.length * floor(since / p.length)
        pulse = 0.0
        if peak != 0.0 and since < p.ticks:
            pulse = peak * sin(math.pi * since / p.ticks)
            if p.along_y == 0.0:
                x.acceleration += STANDARD_GRAVITY * pulse
            else:
                x.acceleration_side += STANDARD_GRAVITY * pulse
            x.other += 1.0
        x.severity = pulse
