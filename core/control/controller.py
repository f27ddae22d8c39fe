"""The ports every controller has, normalised time, and the gains that would match the model."""

from __future__ import annotations

from typing import Any

from core.block import Oscillator, Port, kernel

REFERENCE, MODEL, MEASURED, APPLIED, ENGAGED, VOLTAGE = range(6)
"""Ports of every controller: five inputs, then its own would-be voltage; one with inputs of its own counts on."""

INPUTS = (
    Port("reference", "V", "reference voltage", source="reference.voltage"),
    Port("model", "um", "where the shuttle should be", source="model.displacement"),
    Port("measured", "um", "measured displacement", source="sensor.displacement"),
    Port("applied", "V", "voltage applied until now, whoever asked for it", source="drive.voltage"),
    Port("engaged", "1", "1 while this controller drives", source="@engaged"),
)
OUTPUT = Port("voltage", "V", "voltage this controller asks for")

TRUTH = (
    Port("mass_scale", "1", "true mass over nominal, for the ideal values", source="effects.mass_scale"),
    Port("stiffness_scale", "1", "true stiffness over nominal", source="effects.stiffness_scale"),
    Port("damping_scale", "1", "true damping over nominal", source="effects.damping_scale"),
    Port("drive_gain", "1", "voltage at the comb over the voltage applied", source="effects.drive_gain"),
)
"""What the bench knows and no controller may use: only ideal values for the taps are made of it."""

VELOCITY_INPUTS = (
    Port("velocity", "um/ms", "true velocity, for a source that measures it", source="plant.velocity"),
    Port("model_velocity", "um/ms", "velocity of the model", source="model.velocity"),
)


def pace(oscillator: Oscillator) -> float:
    """Return the rate that time is counted in, rad/ms: the resonance, or 1 for a plant that has none."""
    return oscillator.natural_frequency if oscillator.stiffness > 0.0 else 1.0


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


@kernel
def true_plant(w: Any, io: Any, first: int, a1: float, a2: float, gain: float) -> tuple[float, float, float]:
    """Return the true coefficients from the nominal ones and the inputs of ``TRUTH``, which begin at ``first``."""
    inverse = 1.0 / w[io[first]]
    return a1 * w[io[first + 2]] * inverse, a2 * w[io[first + 1]] * inverse, gain * w[io[first + 3]] * inverse


@kernel
def matching(
    a1: float, a2: float, gain: float, m1: float, m2: float, model_gain: float, pole: float
) -> tuple[float, float, float, float]:
    r"""Return the gains on r, w1, w2, y that make the loop equal the model.

    .. math:: k=\frac{k_m}{k_p},\quad \theta_1=a_{p1}-a_{m1},\quad
        \theta_0=\frac{a_{p2}+(\lambda-\theta_1)a_{p1}-a_{m2}-\lambda a_{m1}}{k_p},\quad
        \theta_2=\frac{(\lambda-\theta_1)a_{p2}-\lambda a_{m2}}{k_p}-\lambda\theta_0
    """
    inverse = 1.0 / gain
    first = a1 - m1
    zero = (a2 + (pole - first) * a1 - m2 - pole * m1) * inverse
    return model_gain * inverse, first, ((pole - first) * a2 - pole * m2) * inverse - pole * zero, zero


@kernel
def saturated(value: float, layer: float) -> float:
    """Return the sign of a value, or its share of a boundary layer inside of it."""
    if abs(value) >= layer:
        return 1.0 if value > 0.0 else -1.0 if value < 0.0 else 0.0
    return value / layer
