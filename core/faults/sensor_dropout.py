"""Sensor drop-out."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.noise import uniform
from core.ports import BlockPorts
from core.record import Record, stream


class SensorDropout(Fault):
    r"""Samples are lost at random, and the last received sample replaces them.

    .. math:: z_i\to z_{i-1}\quad\text{with probability}\ q

    The lengths of the gaps are geometric: a sample arrives every :math:`1/(1-q)` samples on average. An intermittent
    drop-out of all samples is a loose contact.
    """

    title = "Sensor drop-out"
    group, place = "Measurement", 20
    shows = "sensor"
    changes = "measured displacement, which stays where it was while samples are lost; filters take it for new"
    suggested = 0.2
    axes = None
    equations = (Equation("effect", r"z_i\to z_{i-1}\ \text{with probability}\ q", "not in the text"),)

    class Params(FaultParams):
        """Severity is the probability that a sample is lost."""

        severity: float = parameter(0.0, "share of samples lost", "1", ge=0, le=1)

    class Packed(PackedFault):
        """Profile and severity, and the noise stream."""

        key: float = stream("faults.sensor_dropout")

    class Ports(BlockPorts):
        """Whether the sample is lost."""

        sensor_held: float = effect("sensor_held")
        other: float = effect("other")
        severity: float = severity("1", "share of samples lost")

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Lose the sample, or not."""
        share = severity_now(p, x.tick)
        x.severity = share
        if share != 0.0:
            if uniform(p.key, x.tick) < share:
                x.sensor_held += 1.0
            x.other += 1.0
