"""Sensor quantisation."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class SensorQuantisation(Fault):
    r"""A converter that has lost its lower bits, :math:`z\to q\lfloor z/q+\tfrac12\rfloor`.

    While the signal crosses many steps, the error is uniform over one step, :math:`q/\sqrt{12}` rms. A signal within
    half a step of zero is measured as zero.
    """

    title = "Sensor quantisation"
    group, place = "Measurement", 21
    shows = "sensor"
    changes = "measured displacement, in steps; small motion is not seen at all"
    suggested = 0.1
    axes = None
    equations = (Equation("effect", r"z\to q\lfloor z/q+\tfrac12\rfloor", "not in the text"),)

    class Params(FaultParams):
        """Severity is the step of the converter."""

        severity: float = parameter(0.0, "step of the converter", "um", ge=0, le=100)

    class Ports(BlockPorts):
        """The step to which the measurement is rounded."""

        sensor_quantum: float = effect("sensor_quantum")
        other: float = effect("other")
        severity: float = severity("um", "step of the converter")

    @staticmethod
    def step(p: PackedFault, s: Record, x: Ports) -> None:
        """Round the measurement more coarsely; of two converters in a row the coarser one counts."""
        width = severity_now(p, x.tick)
        x.severity = width
        if width != 0.0:
            x.sensor_quantum = max(x.sensor_quantum, width)
            x.other += 1.0
