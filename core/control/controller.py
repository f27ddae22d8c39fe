"""The ports every controller has, and normalised time."""

from __future__ import annotations

from core.block import Oscillator, Port

REFERENCE, MODEL, MEASURED, APPLIED, ENGAGED, VOLTAGE = range(6)
"""Ports of every controller: five inputs, then its own would-be voltage."""

INPUTS = (
    Port("reference", "V", "reference voltage", source="reference.voltage"),
    Port("model", "um", "where the shuttle should be", source="model.displacement"),
    Port("measured", "um", "measured displacement", source="sensor.displacement"),
    Port("applied", "V", "voltage applied until now, whoever asked for it", source="drive.voltage"),
    Port("engaged", "1", "1 while this controller drives", source="@engaged"),
)
OUTPUT = Port("voltage", "V", "voltage this controller asks for")
FIRST_ORDER = "is for plants of second order, and this device is of first order"
"""Why many controllers cannot be on a bench with a plant that has no mass."""


def normalised(oscillator: Oscillator, frequency: float) -> tuple[float, float, float]:
    r"""Return :math:`a_1, a_2, k` of :math:`x''+a_1x'+a_2x=ku` with time in units of 1/frequency.

    Parameters
    ----------
    oscillator : Oscillator
        Plant or model.
    frequency : float
        rad/ms; the nominal device's :math:`\omega_0` makes :math:`a_2=1` there.
    """
    m = oscillator.mass
    return (
        oscillator.damping / (m * frequency),
        oscillator.stiffness / (m * frequency * frequency),
        oscillator.force / (m * frequency * frequency),
    )
