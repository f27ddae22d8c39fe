"""Sensor bias."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class SensorBias(Fault):
    r"""Everything measured is off by the same, :math:`z\to z+b`; as a ramp, the sensor drifts."""

    title = "Sensor bias"
    group, place = "Measurement", 19
    shows = "sensor"
    changes = "measured displacement, whatever the sensor; a controller moves the shuttle by as much the other way"
    suggested = 0.5
    axes = None
    equations = (Equation("effect", r"z\to z+b", "not in the text"),)

    class Params(FaultParams):
        """Severity is the bias itself."""

        severity: float = parameter(0.0, "bias", "um", ge=-100, le=100)

    class Ports(BlockPorts):
        """The error added to the measurement."""

        sensor_offset: float = effect("sensor_offset")
        other: float = effect("other")
        severity: float = severity("um", "bias")

    @staticmethod
    def step(p: PackedFault, s: Record, x: Ports) -> None:
        """Shift the measurement."""
        bias = severity_now(p, x.tick)
        x.severity = bias
        if bias != 0.0:
            x.sensor_offset += bias
            x.other += 1.0
