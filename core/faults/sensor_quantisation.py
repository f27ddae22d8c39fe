"""Sensor quantisation."""

from __future__ import annotations

from typing import Any

from core.block import TICK, Equation, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at

QUANTUM, OTHER, WIDTH = range(3)


def sensor_quantisation_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Coarsen what is measured; of two converters in a row the coarser counts."""
    width = severity_at(p, w[TICK])
    w[io[WIDTH]] = width
    if width != 0.0:
        w[io[QUANTUM]] = max(w[io[QUANTUM]], width)
        w[io[OTHER]] += 1.0


class SensorQuantisation(Fault):
    r"""A converter that has lost its lower bits, :math:`z\to q\lfloor z/q+\tfrac12\rfloor`.

    While the signal crosses many steps the error is evenly spread over one, :math:`q/\sqrt{12}` rms; a signal within
    half a step of zero is not seen at all.
    """

    title = "Sensor quantisation"
    shows = "sensor"
    changes = "measured displacement, in steps; small motion is not seen at all"
    suggested = 0.1
    inputs = channels("sensor_quantum", "other")
    outputs = (Port("severity", "um", "step of the converter"),)
    equations = (Equation("effect", r"z\to q\lfloor z/q+\tfrac12\rfloor", "not in the text"),)

    class Params(FaultParams):
        """Severity is the step of the converter."""

        severity: float = parameter(0.0, "step of the converter", "um", ge=0, le=100)

    step = sensor_quantisation_step
