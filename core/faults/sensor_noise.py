"""Sensor noise."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.noise import normal
from core.ports import BlockPorts
from core.record import Record, stream


class SensorNoise(Fault):
    r"""White noise in addition to the noise of the sensor, :math:`z\to z+\sigma n`, with :math:`n` normal.

    Filters still assume the noise of the sensor without the fault: the variance of the residuals of all hypotheses
    grows by :math:`1+\sigma^2/\sigma_0^2`.
    """

    title = "Sensor noise"
    group, place = "Measurement", 18
    shows = "sensor"
    changes = "measured displacement, whatever the sensor; what filters assume of the noise stays"
    suggested = 0.1
    axes = None
    equations = (Equation("effect", r"z\to z+\sigma n,\quad n\sim N(0,1)", "not in the text"),)

    class Params(FaultParams):
        """Severity is the standard deviation of one sample."""

        severity: float = parameter(0.0, "standard deviation of the noise added", "um", ge=0, le=100)

    class Packed(PackedFault):
        """Profile and severity, and the noise stream."""

        key: float = stream("faults.sensor_noise")

    class Ports(BlockPorts):
        """The error added to the measurement."""

        sensor_offset: float = effect("sensor_offset")
        other: float = effect("other")
        severity: float = severity("um", "standard deviation of the noise added")

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Add noise from its own stream to the measurement."""
        deviation = severity_now(p, x.tick)
        x.severity = deviation
        if deviation != 0.0:
            x.sensor_offset += deviation * normal(p.key, x.tick)
            x.other += 1.0
