"""Shock."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.faults.fault import KIND, LENGTH, RAMP, START, Fault, FaultParams, channels, severity_at

STANDARD_GRAVITY = 9.80665
"""um/ms^2, the same number as m/s^2."""
TICKS, AXIS = 5, 6


def shock_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Accelerate the frame over the sample that begins, by the value in its middle."""
    severity = severity_at(p, w[0])
    since = w[0] - p[START] + 0.5
    if p[KIND] > RAMP:
        since -= p[LENGTH] * math.floor(since / p[LENGTH])
    pulse = 0.0
    if severity != 0.0 and since < p[TICKS]:
        pulse = severity * math.sin(math.pi * since / p[TICKS])
        at = 0 if p[AXIS] == 0.0 else 1
        w[io[at]] += STANDARD_GRAVITY * pulse
        w[io[2]] += 1.0
    w[io[3]] = pulse


class Shock(Fault):
    r"""Half a sine of acceleration of the frame, :math:`a=a_0\sin(\pi t/T)` for :math:`0<t<T`.

    The displacement at rest is 40.3 nm per g along x for the device of chapter 3, 10.6 pm sideways. An intermittent
    shock comes once each period.
    """

    title = "Shock"
    shows = "frame"
    changes = (
        "acceleration along x in every plant; along y in the planar plant only. The stops are in the nonlinear and "
        "planar plants"
    )
    suggested = 20.0
    inputs = channels("acceleration", "acceleration_side", "other")
    outputs = (Port("severity", "g", "acceleration of the frame now"),)
    equations = (Equation("pulse", r"a=a_0\sin(\pi t/T),\quad m\ddot x=\dots-ma", "1.3.1"),)

    class Params(FaultParams):
        """Severity is the peak in g."""

        severity: float = parameter(0.0, "peak of the acceleration", "g", ge=-1e5, le=1e5)
        pulse_ms: float = parameter(1.0, "length of the half sine", "ms", gt=0, le=1e4)
        axis: Literal["x", "y"] = parameter("x", "direction: x is the drive, y sideways in the plane")

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity, profile, length in ticks and axis."""
        own = [max(1.0, params.pulse_ms / context.dt_ms), float(params.axis == "y")]
        return np.array([*super().pack(params, context).tolist(), *own])

    step = shock_step
