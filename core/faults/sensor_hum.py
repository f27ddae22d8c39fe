"""Sensor hum."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, TIME_MS, Context, Equation, FloatArray, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at

TURNS_PER_MS = 5
OFFSET, OTHER, AMPLITUDE = range(3)


def sensor_hum_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Add the hum; its phase goes on while an intermittent fault is off."""
    amplitude = severity_at(p, w[TICK])
    w[io[AMPLITUDE]] = amplitude
    if amplitude != 0.0:
        turns = p[TURNS_PER_MS] * w[TIME_MS]
        w[io[OFFSET]] += amplitude * math.sin(2.0 * math.pi * (turns - math.floor(turns)))
        w[io[OTHER]] += 1.0


class SensorHum(Fault):
    r"""The mains in what is measured, :math:`z\to z+a\sin2\pi ft`.

    One period of 50 Hz lasts 20 ms, which is as long as many a scenario.
    """

    title = "Sensor hum"
    shows = "sensor"
    changes = "measured displacement, whatever the sensor; a controller makes the shuttle follow the mains"
    suggested = 0.2
    inputs = channels("sensor_offset", "other")
    outputs = (Port("severity", "um", "amplitude of the hum"),)
    equations = (Equation("effect", r"z\to z+a\sin2\pi ft", "not in the text"),)

    class Params(FaultParams):
        """Severity is the amplitude."""

        severity: float = parameter(0.0, "amplitude of the hum", "um", ge=0, le=100)
        frequency_hz: float = parameter(50.0, "frequency of the mains, or of one of its multiples", "Hz", gt=0, le=1e5)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity, profile and frequency."""
        return np.array([*super().pack(params, context).tolist(), 1e-3 * params.frequency_hz])

    step = sensor_hum_step
