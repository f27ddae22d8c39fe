"""The ports every controller has, normalised time, and the gains that would match the model."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, Context, Oscillator, Port, kernel, settled
from core.device.oscillator import held, within
from core.ports import BlockPorts, output, reads
from core.record import Record
from core.voltage import APPLIED_PORTS, AppliedPorts, Tick

REFERENCE, MODEL, MEASURED, APPLIED = range(4)
ENGAGED, VOLTAGE = APPLIED + len(APPLIED_PORTS), APPLIED + len(APPLIED_PORTS) + 1
"""Ports of every controller: its inputs, then its own would-be voltage; one with inputs of its own counts on.

``APPLIED`` is what was applied until now, whoever asked for it.
"""

INPUTS = (
    Port("reference", "V", "reference voltage", source="reference.voltage"),
    Port("model", "um", "where the shuttle should be", source="model.displacement"),
    Port("measured", "um", "measured displacement", source="sensor.displacement"),
    *APPLIED_PORTS,
    Port("engaged", "1", "1 while this controller drives", source="@engaged"),
)


class ReferencePorts(BlockPorts):
    """Reference, model and measurement."""

    reference: float = reads("reference.voltage", "V", "reference voltage")
    model: float = reads("model.displacement", "um", "where the shuttle should be")
    measured: float = reads("sensor.displacement", "um", "measured displacement")


class EngagedPorts(BlockPorts):
    """Whether the controller drives, and its own would-be voltage."""

    engaged: float = reads("@engaged", "1", "1 while this controller drives")
    voltage: float = output("V", "voltage this controller asks for")


class ControllerPorts(ReferencePorts, AppliedPorts, EngagedPorts):
    """Ports of every controller; ``applied`` is the voltage of whichever controller drives."""


class TruthPorts(BlockPorts):
    """Signals of the device that no controller may use: only ideal values for the taps are made of them."""

    mass_scale: float = reads("effects.mass_scale", "1", "true mass over nominal, for the ideal values")
    stiffness_scale: float = reads("effects.stiffness_scale", "1", "true stiffness over nominal")
    damping_scale: float = reads("effects.damping_scale", "1", "true damping over nominal")
    drive_gain: float = reads("effects.drive_gain", "1", "voltage at the comb over the voltage applied")


class VelocityPorts(BlockPorts):
    """Velocities, for controllers that are given one."""

    velocity: float = reads("plant.velocity", "um/ms", "true velocity, for a source that measures it")
    model_velocity: float = reads("model.velocity", "um/ms", "velocity of the model")


OUTPUT = Port("voltage", "V", "voltage this controller asks for")
FIRST_ORDER = "is for plants of second order, and this device is of first order"
"""Why many controllers cannot be on a bench with a plant that has no mass."""

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


def unsuited_second_order(device: Oscillator, model: Oscillator) -> str:
    """Say why a controller of second order cannot be used: the plant, or a model that does not come to rest."""
    if model.mass <= 0.0 or model.stiffness <= 0.0:
        return "needs a reference model of second order with a spring"
    return FIRST_ORDER if device.mass == 0.0 else ""


def unsuited_order(device: Oscillator, model: Oscillator) -> str:
    """Say why a controller for both orders cannot be used: a model that is quicker than the plant."""
    return "needs a reference model of second order" if device.mass > 0.0 and model.mass == 0.0 else ""


def first_order(oscillator: Oscillator, frequency: float) -> tuple[float, float, float]:
    r"""Return 0, a and k of :math:`x'+ax=ku` with time in units of 1/frequency; of a second order, its slow end."""
    inverse = 1.0 / (oscillator.damping * frequency)
    return 0.0, oscillator.stiffness * inverse, oscillator.force * inverse


def coefficients(context: Context) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return the coefficients of device and model, both of the order of the device, with gains that are not 0."""
    rate = context.device.natural_frequency
    of = normalised if context.device.mass > 0.0 else first_order
    (a1, a2, gain), (m1, m2, model_gain) = of(context.device, rate), of(context.model, rate)
    return (a1, a2, gain or 1.0), (m1, m2, model_gain or 1.0)  # identical stators give no gain to match


def model_filter(context: Context) -> list[float]:
    """Pack a copy of the model without its zero: transition by rows, effect of a volt held over a sample, of one more.

    That is, of a volt more in the middle of a sample and at its end than at its start.
    """
    m1, m2, gain = coefficients(context)[1]
    h = context.dt_ms * context.device.natural_frequency
    of = (1.0, m1, m2, h) if context.device.mass > 0.0 else (0.0, 1.0, m2, h)
    *phi, first, second = held(*of)
    more = within(*of, gain) if context.analogue else (0.0, 0.0, 0.0, 0.0)
    return [*phi, gain * first, gain * second, *more]


MODEL_FILTER_MORE = 6
MODEL_FILTER_SIZE = 10


@kernel
def advance_model(p: Any, packed: int, s: Any, at: int, voltage: float) -> None:
    """Advance one copy of the model over an interval with a held input."""
    x = s[at]
    v = s[at + 1]
    s[at] = settled(p[packed] * x + p[packed + 1] * v + p[packed + 4] * voltage)
    s[at + 1] = settled(p[packed + 2] * x + p[packed + 3] * v + p[packed + 5] * voltage)


def lag(pole: float, h: float, analogue: bool) -> list[float]:
    r"""Pack :math:`\dot x=-\lambda x+u`: what stays of x over a sample, and the effects of a volt as of the model."""
    decay = math.exp(-pole * h)
    more = within(0.0, 1.0, pole, h) if analogue else (0.0, 0.0, 0.0, 0.0)
    return [decay, (1.0 - decay) / pole, more[0], more[2]]


LAG_SIZE = 4


@kernel
def advance_lag(p: Any, packed: int, s: Any, at: int, u: float, middle: float, end: float) -> None:
    """Advance a lag under a voltage: at the start, and how much more it was in the middle and at the end."""
    more = p[packed + 2] * middle + p[packed + 3] * end
    s[at] = settled(p[packed] * s[at] + p[packed + 1] * u + more)


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
