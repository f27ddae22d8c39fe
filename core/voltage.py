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
from typing import Any

import numpy as np

from core.block import Context, Oscillator, Port, inlined, kernel
from core.device.oscillator import transition, within
from core.format import format_short

APPLIED_PORTS = (
    Port("applied", "V", "voltage applied at the start of the sample that ends now", source="drive.voltage"),
    Port("middle", "V", "the same in its middle", source="drive.middle"),
    Port("end", "V", "the same at its end", source="drive.end"),
)
"""A held voltage is the same in all of them."""

PHI11, PHI12, PHI21, PHI22, PUSH1, PUSH2, MIDDLE1, MIDDLE2, END1, END2 = range(10)
"""A device over a tick: transition, effect of a held volt, and of a volt more in the middle and at the end."""
TICK_SIZE = 10
LATER1, LATER2, FIRST_SHARE, SECOND_SHARE, INTERVAL_SIZE = range(TICK_SIZE, TICK_SIZE + 5)
"""Behind it, over the interval: :math:`-\\Phi_{22},\\;\\Phi_{12}`, and the inverses of b0 and b1 of a unit gain."""
BEGUN, START, GAINED1, GAINED2, STATES = range(5)
"""State: whether the interval has begun, the voltage at its start, what motion the rest of it has made so far."""
MOST_LOST = 1e-3
"""Share of the response to a tone that may be lost unsaid."""


@inlined
def moved(w: Any, io: Any, at: int) -> tuple[float, float, float]:
    """Return the voltage at the start of the tick that ends now, and how much more it was in the middle and the end."""
    u = w[io[at]]
    return u, w[io[at + 1]] - u, w[io[at + 2]] - u


def pack_tick(device: Oscillator, gain: float, h: float, analogue: bool) -> list[float]:
    """Pack a device over a tick; its stiffness times its displacement at rest is the gain times the voltage."""
    phi = transition(device.mass, device.damping, device.stiffness, h)
    more = within(device.mass, device.damping, device.stiffness, h, gain) if analogue else (0.0, 0.0, 0.0, 0.0)
    rest = gain / device.stiffness
    return [*phi, (1.0 - phi[0]) * rest, -phi[2] * rest, *more]


def pack_interval(context: Context) -> list[float]:
    """Pack the nominal device over a tick and over the interval of the block, for a displacement at rest of 1 um/V."""
    device = context.device
    tick = pack_tick(device, device.stiffness, context.dt_ms / context.every, context.analogue)
    b0, b1, _, _ = difference_equation(device, 1.0, context.dt_ms)
    _, phi12, _, phi22 = transition(device.mass, device.damping, device.stiffness, context.dt_ms)
    return [*tick, -phi22, phi12, 1.0 / b0 if b0 else 0.0, 1.0 / b1 if b1 else 0.0]


def difference_equation(device: Oscillator, rest: float, h: float) -> tuple[float, float, float, float]:
    """Return b0, b1, a1, a2 of a device under a held voltage, of which a volt moves it by ``rest`` in the end."""
    f11, f12, f21, f22 = transition(device.mass, device.damping, device.stiffness, h)
    g1, g2 = (1.0 - f11) * rest, -f21 * rest
    return g1, f12 * g2 - f22 * g1, -(f11 + f22), f11 * f22 - f12 * f21


@kernel
def add_moved(p: Any, more: int, s: Any, at: int, middle: float, end: float) -> None:
    """Add to a motion what the voltage of a tick was more in its middle and at its end; the effects are at ``more``."""
    s[at] += p[more] * middle + p[more + 2] * end
    s[at + 1] += p[more + 1] * middle + p[more + 3] * end


@kernel
def follow(p: Any, at: int, s: Any, b: int, u: float, middle: float, end: float) -> None:
    """Take in a tick: its voltage at the start, in the middle and at the end.

    What is gathered is the motion by what the voltage is more than at the start of the interval, so that a voltage held
    over all of it adds nothing, to the bit.
    """
    if s[b + BEGUN] == 0.0:
        s[b + BEGUN] = 1.0
        s[b + START] = u
        s[b + GAINED1] = 0.0
        s[b + GAINED2] = 0.0
    x = s[b + GAINED1]
    v = s[b + GAINED2]
    if middle == u and end == u and u == s[b + START] and x == 0.0 and v == 0.0:
        return
    more = u - s[b + START]
    middle -= u
    end -= u
    own1 = p[at + PUSH1] * more + p[at + MIDDLE1] * middle + p[at + END1] * end
    own2 = p[at + PUSH2] * more + p[at + MIDDLE2] * middle + p[at + END2] * end
    s[b + GAINED1] = p[at + PHI11] * x + p[at + PHI12] * v + own1
    s[b + GAINED2] = p[at + PHI21] * x + p[at + PHI22] * v + own2


@kernel
def weighed(p: Any, at: int, s: Any, b: int) -> tuple[float, float]:
    r"""Return :math:`\alpha/b_0` and :math:`\beta/b_1` of the interval that ends now; the next tick begins another."""
    s[b + BEGUN] = 0.0
    x = s[b + GAINED1]
    if x == 0.0 and s[b + GAINED2] == 0.0:
        return s[b + START], s[b + START]
    later = p[at + LATER1] * x + p[at + LATER2] * s[b + GAINED2]
    return s[b + START] + p[at + FIRST_SHARE] * x, s[b + START] + p[at + SECOND_SHARE] * later


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
