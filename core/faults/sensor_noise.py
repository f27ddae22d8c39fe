"""Sensor noise."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at
from core.noise import key, normal

KEY = 5
OFFSET, OTHER, DEVIATION = range(3)


def sensor_noise_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Add noise of its own to what is measured."""
    deviation = severity_at(p, w[TICK])
    w[io[DEVIATION]] = deviation
    if deviation != 0.0:
        w[io[OFFSET]] += deviation * normal(p[KEY], w[TICK])
        w[io[OTHER]] += 1.0


class SensorNoise(Fault):
    r"""White noise beside that of the sensor, :math:`z\to z+\sigma n`, with :math:`n` normal.

    Filters go on with the noise the sensor has without it: the residuals of all hypotheses grow by
    :math:`1+\sigma^2/\sigma_0^2` in their variance.
    """

    title = "Sensor noise"
    shows = "sensor"
    changes = "measured displacement, whatever the sensor; what filters assume of the noise stays"
    suggested = 0.1
    inputs = channels("sensor_offset", "other")
    outputs = (Port("severity", "um", "standard deviation of the noise added"),)
    equations = (Equation("effect", r"z\to z+\sigma n,\quad n\sim N(0,1)", "not in the text"),)

    class Params(FaultParams):
        """Severity is the standard deviation of one sample."""

        severity: float = parameter(0.0, "standard deviation of the noise added", "um", ge=0, le=100)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity, profile and noise stream."""
        return np.array([*super().pack(params, context).tolist(), key(context.seed, "faults.sensor_noise")])

    step = sensor_noise_step
