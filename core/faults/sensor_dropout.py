"""Sensor drop-out."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at
from core.noise import key, uniform

KEY = 5
HELD, OTHER, SHARE = range(3)


def sensor_dropout_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Lose the sample, or not."""
    share = severity_at(p, w[TICK])
    w[io[SHARE]] = share
    if share != 0.0:
        if uniform(p[KEY], w[TICK]) < share:
            w[io[HELD]] += 1.0
        w[io[OTHER]] += 1.0


class SensorDropout(Fault):
    r"""Samples get lost at random, and the last one that came stands in for them.

    .. math:: z_i\to z_{i-1}\quad\text{with probability}\ q

    The gaps are geometric, :math:`1/(1-q)` samples from one that comes to the next on average. An intermittent
    drop-out of everything is a loose contact.
    """

    title = "Sensor drop-out"
    shows = "sensor"
    changes = "measured displacement, which stays where it was while samples are lost; filters take it for new"
    suggested = 0.2
    inputs = channels("sensor_held", "other")
    outputs = (Port("severity", "1", "share of samples lost"),)
    equations = (Equation("effect", r"z_i\to z_{i-1}\ \text{with probability}\ q", "not in the text"),)

    class Params(FaultParams):
        """Severity is the probability that a sample is lost."""

        severity: float = parameter(0.0, "share of samples lost", "1", ge=0, le=1)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity, profile and noise stream."""
        return np.array([*super().pack(params, context).tolist(), key(context.seed, "faults.sensor_dropout")])

    step = sensor_dropout_step
