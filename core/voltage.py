r"""The voltage of an interval, as a device feels it: it moves between ticks, and within one when the drive is analogue.

Over an interval of N ticks the forced response of a device is that of a constant voltage only for one device, and it
takes two numbers to say: the displacement is :math:`\alpha_i`, and what is left of it an interval later, when the free
motion is taken out, :math:`\beta_i`:

.. math:: y_i+a_1y_{i-1}+a_2y_{i-2}=\alpha_i+\beta_{i-1},\qquad
    \alpha_i=g_1,\;\beta_i=\Phi_{12}g_2-\Phi_{22}g_1,\quad
    g=\sum_j\varphi^{N-1-j}\int_0^h e^{A(h-\tau)}B\,u_j(\tau)\,d\tau

Under a voltage that is held over the interval :math:`\alpha=b_0u,\;\beta=b_1u`. So :math:`\alpha/b_0` and
:math:`\beta/b_1` of the nominal device are the voltages a difference equation is to be given: means of the ticks,
weighed as that device does. For the nominal device they are exact, for its neighbours nearly so (``lost``).
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping

import numpy as np

from core.block import Context, Oscillator
from core.device.oscillator import transition, within
from core.format import format_short
from core.kernel import flush_tiny, inlined, kernel
from core.ports import BlockPorts, reads
from core.record import Record

MOST_LOST = 1e-3
"""Share of the response to a tone that may be lost unsaid."""


class AppliedPorts(BlockPorts):
    """The voltage of the tick that ends now; a held voltage is the same in all of them."""

    applied: float = reads("drive.voltage", "V", "voltage applied at the start of the sample that ends now")
    middle: float = reads("drive.middle", "V", "the same in its middle")
    end: float = reads("drive.end", "V", "the same at its end")


class MeasuredPorts(BlockPorts):
    """What was measured."""

    measured: float = reads("sensor.displacement", "um", "measured displacement")


class ObservedPorts(MeasuredPorts, AppliedPorts):
    """What was measured, and the voltage that made it: all that an identifier or a bank knows of the device."""


class Moves(Record):
    """Effect of a volt more in the middle and at the end of a tick than at its start."""

    middle1: float
    middle2: float
    end1: float
    end2: float


class Tick(Moves):
    """A device over a tick: transition, effect of a held volt, and of a volt more in the middle and at the end."""

    phi11: float
    phi12: float
    phi21: float
    phi22: float
    push1: float
    push2: float


class Interval(Tick):
    r"""A device over a tick and over the interval.

    There :math:`-\Phi_{22},\;\Phi_{12}`, and the inverses of b0 and b1 of a unit gain.
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
    """Whether an interval has begun, the voltage at its start, the motion that later voltages have made so far."""

    begun: float
    start: float
    gained1: float
    gained2: float


@inlined
def moves(x: AppliedPorts) -> tuple[float, float, float]:
    """Return the voltage at the start of the tick that ends now, and how much more it was in the middle and the end."""
    u = x.applied
    return u, x.middle - u, x.end - u


def fill_tick(p: Tick, device: Oscillator, gain: float, h: float, analogue: bool) -> None:
    """Pack a device over a tick; its stiffness times its displacement at rest is the gain times the voltage."""
    p.phi11, p.phi12, p.phi21, p.phi22 = transition(device.mass, device.damping, device.stiffness, h)
    rest = gain / device.stiffness
    p.push1, p.push2 = (1.0 - p.phi11) * rest, -p.phi21 * rest
    more = within(device.mass, device.damping, device.stiffness, h, gain) if analogue else (0.0, 0.0, 0.0, 0.0)
    p.middle1, p.middle2, p.end1, p.end2 = more


def tick_of(device: Oscillator, gain: float, h: float, analogue: bool) -> Tick:
    """Return a device over a tick."""
    tick = Tick.blank()
    fill_tick(tick, device, gain, h, analogue)
    return tick


def interval_of(context: Context) -> Interval:
    """Return the nominal device over a tick and the interval of the block, for a displacement at rest of 1 um/V."""
    device, interval = context.device, Interval.blank()
    fill_tick(interval, device, device.stiffness, context.dt_ms / context.every, context.analogue)
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
    """Add to a motion the effect of a voltage that was more in the middle and at the end than at the start."""
    s.x += p.middle1 * middle + p.end1 * end
    s.v += p.middle2 * middle + p.end2 * end


@kernel
def gather(p: Tick, s: Gathered, u: float, middle: float, end: float) -> None:
    """Take in a tick: its voltage at the start, in the middle and at the end.

    The motion gathered is that by what the voltage is more than at the start of the interval, so that a voltage held
    over all of it adds nothing, to the bit.
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
    more = u - s.start
    middle -= u
    end -= u
    gain1 = p.push1 * more + p.middle1 * middle + p.end1 * end
    gain2 = p.push2 * more + p.middle2 * middle + p.end2 * end
    s.gained1 = p.phi11 * x + p.phi12 * v + gain1
    s.gained2 = p.phi21 * x + p.phi22 * v + gain2


@kernel
def weighed_voltages(p: Interval, s: Gathered) -> tuple[float, float]:
    r"""Return :math:`\alpha/b_0` and :math:`\beta/b_1` of the interval that ends now; the next tick begins another."""
    s.begun = 0.0
    x = s.gained1
    if x == 0.0 and s.gained2 == 0.0:
        return s.start, s.start
    later = p.later1 * x + p.later2 * s.gained2
    return s.start + p.first_share * x, s.start + p.second_share * later


def difference_equation(device: Oscillator, rest: float, h: float) -> tuple[float, float, float, float]:
    """Return b0, b1, a1, a2 of a device under a held voltage, of which a volt moves it by ``rest`` in the end."""
    f11, f12, f21, f22 = transition(device.mass, device.damping, device.stiffness, h)
    g1, g2 = (1.0 - f11) * rest, -f21 * rest
    return g1, f12 * g2 - f22 * g1, -(f11 + f22), f11 * f22 - f12 * f21


def lost(nominal: Oscillator, other: Oscillator, context: Context, hz: float) -> float:
    r"""Return how far the response of a device to a tone is from what its difference equation says of it, as a share.

    When that equation is given the voltages as the nominal device weighs them. In a steady state
    :math:`g=(e^{j\omega Nh}I-\Phi)X`, with X the phasor of the state.

    Parameters
    ----------
    nominal, other : Oscillator
        The device whose weights are taken, and the one whose response is asked for.
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
    said = (b0 / n0 * alpha * shift + b1 / n1 * beta) / (shift * shift + a1 * shift + a2)
    return abs(said / true - 1.0)


def caution(context: Context, others: Mapping[str, Oscillator], hz: float) -> str:
    """Say how much of the response of which device a difference equation loses at a tone; nothing when it is little."""
    shares = {name: lost(context.device, device, context, hz) for name, device in others.items()}
    worst = max(shares, key=lambda name: shares[name], default="")
    if not worst or shares[worst] <= MOST_LOST:
        return ""
    what = f"the voltages of {context.every} ticks" if context.every > 1 else "the voltage within a tick"
    share = format_short(100.0 * shares[worst], "%", 2)
    text = f"weighs {what} as the nominal device does: {share} of the response of {worst}"
    return f"{text} at {format_short(hz, 'Hz')} are lost to it"
