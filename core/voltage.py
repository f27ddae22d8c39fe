r"""The effect on a device of a voltage that moves over the interval between two samples.

The voltage may change at every tick, and within a tick when the drive is analogue. Two numbers describe its effect on a
device over an interval of N ticks: the displacement :math:`\alpha_i` that it has caused by the end of the interval, and
the displacement :math:`\beta_i` that is left of it one interval later, once the free motion is taken out:

.. math:: y_i+a_1y_{i-1}+a_2y_{i-2}=\alpha_i+\beta_{i-1},\qquad
    \alpha_i=g_1,\;\beta_i=\Phi_{12}g_2-\Phi_{22}g_1,\quad
    g=\sum_j\varphi^{N-1-j}\int_0^h e^{A(h-\tau)}B\,u_j(\tau)\,d\tau

Under a voltage that is held over the interval, :math:`\alpha=b_0u,\;\beta=b_1u`. A difference equation is therefore
given the voltages :math:`\alpha/b_0` and :math:`\beta/b_1` of the nominal device: means over the ticks, weighted by the
response of that device. They are exact for the nominal device and nearly exact for its neighbours (`lost` returns the
error).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping

import numpy as np

from core.block import Context, Oscillator
from core.device.oscillator import is_soft, transition, within, yielded
from core.elementary import exp
from core.format import format_short
from core.kernel import flush_tiny, kernel
from core.ports import BlockPorts, reads
from core.record import Record

MOST_LOST = 1e-3
"""Largest share of the response to a tone that may be lost without a caution."""


class AppliedPorts(BlockPorts):
    """The voltage at the start, middle and end of the tick that ends now, all equal when the drive holds it."""

    applied: float = reads("drive.voltage", "V", "voltage applied at the start of the sample that ends now")
    middle: float = reads("drive.middle", "V", "the same in its middle")
    end: float = reads("drive.end", "V", "the same at its end")


class MeasuredPorts(BlockPorts):
    """The measured displacement."""

    measured: float = reads("sensor.displacement", "um", "measured displacement")


class ObservedPorts(MeasuredPorts, AppliedPorts):
    """The measured displacement and the voltage that caused it: an identifier or a bank knows no more of the device."""

    missing: float = reads("plant.missing?", "1", "not zero where a record lacks the sample")


@kernel
def observed(x: ObservedPorts) -> float:
    """Return the measured displacement, or no number where a record lacks the sample and the measurement is held."""
    return math.nan if x.missing != 0.0 else x.measured


class Moves(Record):
    """Displacement and velocity gained from one volt more than at the start, in the middle or at the end of a tick."""

    middle1: float
    middle2: float
    end1: float
    end2: float


class Tick(Moves):
    """A device over a tick: transition, effect of a held volt, and of one volt more in the middle or at the end."""

    phi11: float
    phi12: float
    phi21: float
    phi22: float
    push1: float
    push2: float


class Interval(Tick):
    r"""A device over a tick and over the interval.

    Of the interval it holds :math:`-\Phi_{22},\;\Phi_{12}`, and the inverses of b0 and b1 for a unit gain.
    """

    later1: float
    later2: float
    first_share: float
    second_share: float


class Motion(Record):
    """Displacement and velocity, or a filtered signal and its derivative."""

    x: float
    v: float


class Gathered(Record):
    """Whether an interval has begun, the voltage at its start, and the motion caused by later changes of it."""

    begun: float
    start: float
    gained1: float
    gained2: float


@kernel
def moves(x: AppliedPorts) -> tuple[float, float, float]:
    """Return the voltage at the start of the tick that ends now, and by how much its middle and its end exceed that."""
    u = x.applied
    return u, x.middle - u, x.end - u


def over_tick(device: Oscillator, gain: float, h: float, analogue: bool) -> tuple[float, ...]:
    """Return the numbers of a `Tick`; statically, stiffness times displacement is the gain times the voltage."""
    phi11, phi12, phi21, phi22 = transition(device.mass, device.damping, device.stiffness, h)
    rest = gain / device.stiffness
    push1 = _gained(device, rest, h, phi11)
    effects = within(device.mass, device.damping, device.stiffness, h, gain) if analogue else (0.0, 0.0, 0.0, 0.0)
    return *effects, phi11, phi12, phi21, phi22, push1, -phi21 * rest


def tick_of(device: Oscillator, gain: float, h: float, analogue: bool) -> Tick:
    """Return a device over a tick."""
    return Tick(np.array(over_tick(device, gain, h, analogue)))


def interval_of(context: Context) -> Interval:
    """Return the nominal device over a tick and the interval of the block, for a static displacement of 1 um/V."""
    device, interval = context.device, Interval.blank()
    moving = over_tick(device, device.stiffness, context.dt_ms / context.every, context.analogue)
    interval.array[: len(moving)] = moving
    b0, b1, _, _ = difference_equation(device, 1.0, context.dt_ms)
    _, phi12, _, phi22 = transition(device.mass, device.damping, device.stiffness, context.dt_ms)
    interval.later1, interval.later2 = -phi22, phi12
    interval.first_share, interval.second_share = 1.0 / b0 if b0 else 0.0, 1.0 / b1 if b1 else 0.0
    return interval


@kernel
def advance_motion(p: Tick, s: Motion, u: float) -> None:
    """Advance a motion over an interval with a held voltage."""
    x = s.x
    v = s.v
    s.x = flush_tiny(p.phi11 * x + p.phi12 * v + p.push1 * u)
    s.v = flush_tiny(p.phi21 * x + p.phi22 * v + p.push2 * u)


@kernel
def add_moves(p: Moves, s: Motion, middle: float, end: float) -> None:
    """Add the effect on a motion of the volts by which the middle and the end of a tick exceed its start."""
    s.x += p.middle1 * middle + p.end1 * end
    s.v += p.middle2 * middle + p.end2 * end


@kernel
def gather(p: Tick, s: Gathered, u: float, middle: float, end: float) -> None:
    """Add a tick to the interval, with its voltage at the start, in the middle and at the end.

    The gathered motion is the effect of the voltage less its value at the start of the interval. A voltage that is held
    over the whole interval therefore adds nothing, to the bit.
    """
    if s.begun == 0.0:
        s.begun = 1.0
        s.start = u
        s.gained1 = 0.0
        s.gained2 = 0.0
    x = s.gained1
    v = s.gained2
    if middle == u and end == u and u == s.start and x == 0.0 and v == 0.0:
        return
    rise = u - s.start
    middle -= u
    end -= u
    gain1 = p.push1 * rise + p.middle1 * middle + p.end1 * end
    gain2 = p.push2 * rise + p.middle2 * middle + p.end2 * end
    s.gained1 = p.phi11 * x + p.phi12 * v + gain1
    s.gained2 = p.phi21 * x + p.phi22 * v + gain2


@kernel
def weighed_voltages(p: Interval, s: Gathered) -> tuple[float, float]:
    r"""Return :math:`\alpha/b_0` and :math:`\beta/b_1` of the interval that ends now; the next tick starts anew."""
    s.begun = 0.0
    x = s.gained1
    if x == 0.0 and s.gained2 == 0.0:
        return s.start, s.start
    later = p.later1 * x + p.later2 * s.gained2
    return s.start + p.first_share * x, s.start + p.second_share * later


def shuttle_memory(device: Oscillator, h: float) -> float:
    """Return the share that a mean keeps after an interval if its memory is the shuttle's, 2m/beta or a cycle."""
    cycle = 2.0 * math.pi / device.natural_frequency
    lasting = max(2.0 * device.mass / device.damping, cycle) if device.damping > 0.0 else cycle
    return exp(-h / lasting)


def difference_equation(device: Oscillator, rest: float, h: float) -> tuple[float, float, float, float]:
    """Return b0, b1, a1, a2 of a device under a held voltage; one volt displaces it by ``rest`` in the steady state."""
    f11, f12, f21, f22 = transition(device.mass, device.damping, device.stiffness, h)
    g1, g2 = _gained(device, rest, h, f11), -f21 * rest
    return g1, f12 * g2 - f22 * g1, -(f11 + f22), f11 * f22 - f12 * f21


def _gained(device: Oscillator, rest: float, h: float, phi11: float) -> float:
    """Return the displacement that a held volt causes within ``h``; in the steady state it causes ``rest``."""
    of = device.mass, device.damping, device.stiffness, h
    return rest * device.stiffness * yielded(*of) if is_soft(*of) else (1.0 - phi11) * rest


def lost(nominal: Oscillator, other: Oscillator, context: Context, hz: float) -> float:
    r"""Return the error of a device's difference equation in the response to a tone, as a share of that response.

    The equation is given the voltages weighted by the nominal device. In a steady state
    :math:`g=(e^{j\omega Nh}I-\Phi)X`, where X is the phasor of the state.

    Parameters
    ----------
    nominal, other : Oscillator
        The device that weights the voltages, and the device of the response.
    context : Context
        Interval, ticks, and whether the drive is analogue.
    hz : float
        Frequency of the tone.
    """
    if hz <= 0.0 or (context.every == 1 and not context.analogue):
        return 0.0
    shift = cmath.exp(2j * math.pi * 1e-3 * hz * context.dt_ms)

    def response(device: Oscillator) -> tuple[complex, complex, complex]:
        a = np.array([[0.0, 1.0], [-device.stiffness / device.mass, -device.damping / device.mass]])
        if context.analogue:
            x = np.linalg.solve(2j * math.pi * 1e-3 * hz * np.eye(2) - a, np.array([0.0, -a[1, 0]]))
        else:
            h = context.dt_ms / context.every
            phi = np.reshape(transition(device.mass, device.damping, device.stiffness, h), (2, 2))
            turn = cmath.exp(2j * math.pi * 1e-3 * hz * h)
            x = np.linalg.solve(turn * np.eye(2) - phi, (np.eye(2) - phi)[:, 0])
        whole = np.reshape(transition(device.mass, device.damping, device.stiffness, context.dt_ms), (2, 2))
        g = shift * x - whole @ x
        return x[0], g[0], whole[0, 1] * g[1] - whole[1, 1] * g[0]

    n0, n1, _, _ = difference_equation(nominal, 1.0, context.dt_ms)
    b0, b1, a1, a2 = difference_equation(other, 1.0, context.dt_ms)
    _, alpha, beta = response(nominal)
    true = response(other)[0]
    predicted = (b0 / n0 * alpha * shift + b1 / n1 * beta) / (shift * shift + a1 * shift + a2)
    return abs(predicted / true - 1.0)


def caution(context: Context, others: Mapping[str, Oscillator], hz: float) -> str:
    """Name the device whose difference equation loses most of its response to a tone, and how much; "" if little."""
    shares = {name: lost(context.device, device, context, hz) for name, device in others.items()}
    worst = max(shares, key=lambda name: shares[name], default="")
    if not worst or shares[worst] <= MOST_LOST:
        return ""
    span = f"the voltages of {context.every} ticks" if context.every > 1 else "the voltage within a tick"
    share = format_short(100.0 * shares[worst], "%", 2)
    text = f"weighs {span} as the nominal device does: {share} of the response of {worst}"
    return f"{text} at {format_short(hz, 'Hz')} are lost to it"
