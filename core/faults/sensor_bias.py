"""Sensor bias."""

from __future__ import annotations

from typing import Any

from core.block import TICK, Equation, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at

OFFSET, OTHER, BIAS = range(3)


def sensor_bias_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Shift what is measured."""
    bias = severity_at(p, w[TICK])
    w[io[BIAS]] = bias
    if bias != 0.0:
        w[io[OFFSET]] += bias
        w[io[OTHER]] += 1.0


class SensorBias(Fault):
    r"""Everything measured is off by the same, :math:`z\to z+b`; as a ramp, the sensor drifts."""

    title = "Sensor bias"
    shows = "sensor"
    changes = "measured displacement, whatever the sensor; a controller moves the shuttle by as much the other way"
    suggested = 0.5
    inputs = channels("sensor_offset", "other")
    outputs = (Port("severity", "um", "bias"),)
    equations = (Equation("effect", r"z\to z+b", "not in the text"),)

    class Params(FaultParams):
        """Severity is the bias itself."""

        severity: float = parameter(0.0, "bias", "um", ge=-100, le=100)

    step = sensor_bias_step
