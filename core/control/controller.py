"""The ports every controller has, normalised time, and the gains that would match the model."""

from __future__ import annotations

from core.block import Context, Oscillator
from core.device.oscillator import held, within
from core.elementary import exp
from core.kernel import flush_tiny, kernel
from core.ports import BlockPorts, output, reads
from core.record import Record
from core.voltage import AppliedPorts, Tick

FIRST_ORDER = "is for plants of second order, and this device is of first order"
"""Why many controllers cannot be on a bench with a plant that has no mass."""


class ReferencePorts(BlockPorts):
    """Reference, model and measurement."""

    reference: float = reads("reference.voltage", "V", "reference voltage")
    model: float = reads("model.displacement", "um", "where the shuttle should be")
    measured: float = reads("sensor.displacement", "um", "measured displacement")


class EngagedPorts(BlockPorts):
    """Whether the controller drives, and the voltage it would apply itself."""

    engaged: float = reads("@engaged", "1", "1 while this controller drives")
    voltage: float = output("V", "voltage this controller asks for")


class ControllerPorts(ReferencePorts, AppliedPorts, EngagedPorts):
    """Ports of every controller; ``applied`` is the voltage of the controller that drives."""


class FeedForwardPorts(ControllerPorts):
    """Ports of a law without feedback, which knows its voltage between samples too, so the drive may be analogue."""

    reference_middle: float = reads("reference.middle", "V", "reference half a sample later")
    reference_end: float = reads("reference.end", "V", "reference one sample later")
    voltage_middle: float = output("V", "voltage this controller asks for half a sample later", hidden=True)
    voltage_end: float = output("V", "voltage this controller asks for one sample later", hidden=True)


class TruthPorts(BlockPorts):
    """True scales of the device, from which the taps compute ideal values; no law may use them."""

    mass_scale: float = reads("effects.mass_scale", "1", "true mass over nominal, for the ideal values")
    stiffness_scale: float = reads("effects.stiffness_scale", "1", "true stiffness over nominal")
    damping_scale: float = reads("effects.damping_scale", "1", "true damping over nominal")
    drive_gain: float = reads("effects.drive_gain", "1", "voltage at the comb over the voltage applied")


class VelocityPorts(BlockPorts):
    """Velocities, for controllers that are given one."""

    velocity: float = reads("plant.velocity", "um/ms", "true velocity, for a source that measures it")
    model_velocity: float = reads("model.velocity", "um/ms", "velocity of the model")


class Coefficients(Record):
    """Coefficients of :math:`x''+a_1x'+a_2x=ku` with time in units of 1/w0; of a first order, :math:`x'+a_2x=ku`."""

    a1: float
    a2: float
    gain: float


class NormalisedPacked(Record):
    """Sample interval in 1/w0, coefficients of plant and model."""

    h: float
    plant: Coefficients
    model: Coefficients


class Lag(Record):
    r"""A lag :math:`\dot x=-\lambda x+u` over a sample: the share of x that stays, and the effects of the input.

    The input is one volt held, then one volt more in the middle of a sample, and at its end, than at its start.
    """

    decay: float
    push: float
    middle: float
    end: float


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
    r"""Return 0, a and k of :math:`x'+ax=ku` with time in units of 1/frequency; of a second order, its slow mode."""
    inverse = 1.0 / (oscillator.damping * frequency)
    return 0.0, oscillator.stiffness * inverse, oscillator.force * inverse


def coefficients(context: Context) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return the coefficients of device and model, both in the order of the device, with gains that are not 0."""
    rate = context.device.natural_frequency
    of = normalised if context.device.mass > 0.0 else first_order
    (a1, a2, gain), (m1, m2, model_gain) = of(context.device, rate), of(context.model, rate)
    return (a1, a2, gain or 1.0), (m1, m2, model_gain or 1.0)  # identical stators give no gain to match


def fill_normalised(p: NormalisedPacked, context: Context) -> None:
    """Pack the sample interval and the coefficients."""
    p.h = context.dt_ms * context.device.natural_frequency
    plant, model = coefficients(context)
    p.plant.a1, p.plant.a2, p.plant.gain = plant
    p.model.a1, p.model.a2, p.model.gain = model


def model_filter(context: Context) -> Tick:
    """Return a copy of the model without its zero: its transition over a sample and the effects of a voltage.

    The voltage is one volt held, then one volt more in the middle of a sample, and at its end, than at its start.
    """
    m1, m2, gain = coefficients(context)[1]
    h = context.dt_ms * context.device.natural_frequency
    of = (1.0, m1, m2, h) if context.device.mass > 0.0 else (0.0, 1.0, m2, h)
    tick = Tick.blank()
    tick.phi11, tick.phi12, tick.phi21, tick.phi22, first, second = held(*of)
    tick.push1, tick.push2 = gain * first, gain * second
    effects = within(*of, gain) if context.analogue else (0.0, 0.0, 0.0, 0.0)
    tick.middle1, tick.middle2, tick.end1, tick.end2 = effects
    return tick


def lag(pole: float, h: float, analogue: bool) -> Lag:
    """Pack a lag with its pole in 1/w0, for an interval in 1/w0."""
    packed = Lag.blank()
    packed.decay = exp(-pole * h)
    packed.push = (1.0 - packed.decay) / pole
    packed.middle, _, packed.end, _ = within(0.0, 1.0, pole, h) if analogue else (0.0, 0.0, 0.0, 0.0)
    return packed


@kernel
def advance_lag(p: Lag, x: float, u: float, middle: float, end: float) -> float:
    """Return a lag one sample later; the voltage is ``u`` at the start and more by ``middle`` and ``end`` after it."""
    moved = p.middle * middle + p.end * end
    return flush_tiny(p.decay * x + p.push * u + moved)


@kernel
def true_plant(x: TruthPorts, plant: Coefficients) -> tuple[float, float, float]:
    """Scale the nominal coefficients of the plant to the true ones."""
    inverse = 1.0 / x.mass_scale
    a1 = plant.a1 * x.damping_scale * inverse
    return a1, plant.a2 * x.stiffness_scale * inverse, plant.gain * x.drive_gain * inverse


@kernel
def matching(a1: float, a2: float, gain: float, model: Coefficients, pole: float) -> tuple[float, float, float, float]:
    r"""Return the gains on r, w1, w2, y that make the loop equal the model.

    .. math:: k=\frac{k_m}{k_p},\quad \theta_1=a_{p1}-a_{m1},\quad
        \theta_0=\frac{a_{p2}+(\lambda-\theta_1)a_{p1}-a_{m2}-\lambda a_{m1}}{k_p},\quad
        \theta_2=\frac{(\lambda-\theta_1)a_{p2}-\lambda a_{m2}}{k_p}-\lambda\theta_0
    """
    inverse = 1.0 / gain
    first = a1 - model.a1
    zero = (a2 + (pole - first) * a1 - model.a2 - pole * model.a1) * inverse
    return model.gain * inverse, first, ((pole - first) * a2 - pole * model.a2) * inverse - pole * zero, zero


@kernel
def saturated(value: float, layer: float) -> float:
    """Return the sign of a value; within the boundary layer, return its share of the layer."""
    if abs(value) >= layer:
        return 1.0 if value > 0.0 else -1.0 if value < 0.0 else 0.0
    return value / layer
