"""Kalman filters side by side: the layout of a bank, and what its step is made of."""

from __future__ import annotations

import math
from typing import Any

from core.block import TICK, inlined, kernel, settled
from core.diagnose.lanes import LANE

COUNT, SENSOR, STEADY, PRINTED, EVERY, TAKEN, MEMORY, LEAST_DRIVE, LANES = range(9)
"""Packed parameters of every bank; the lanes of the models follow, then a bank's own."""
PHI11, PHI12, PHI21, PHI22, NOISE11, NOISE12, NOISE22, GAIN1, GAIN2, PSI, INVERSE_PSI = range(11)
MOVE11, MOVE12, MOVE21, MOVE22, PUSH1, PUSH2, MIDDLE1, MIDDLE2, END1, END2, WIDTH = range(11, 22)
"""Lanes of the parameters: over the interval of the bank, then a device over one tick (`core.voltage`)."""
STARTED, SUM, LEVEL, OWN = range(4)
"""State of every bank; the lanes of the filters follow, then a bank's own."""
X1, X2, P11, P12, P22, RESIDUAL, NIS, COVARIANCE, INVERSE, HALF_LOG, PUSHED1, PUSHED2, DEPTH = range(13)
"""Lanes of the state; half the logarithm of the residual covariance is kept while it stays."""
MEASURED, APPLIED, MIDDLE, END, PROBABILITY = range(5)
"""Ports of every bank."""
TAKE_MIDDLE, TAKE_START, TAKE_PARABOLA = range(3)
"""The voltages a filter may assume over a tick."""
LEAST = 1e-12
"""Least residual covariance, as a share of R."""


@inlined
def push(p: Any, s: Any, w: Any, io: Any, lane: int, low: int, high: int) -> float:
    """Write what the voltage of the tick that ends now does to the models from ``low`` to ``high``, and return it.

    An analogue drive moves within the tick: on the parabola through its start, middle and end, as the plant has it.
    """
    u = w[io[MIDDLE]] if p[TAKEN] == 0.0 else w[io[APPLIED]]
    for i in range(low, high):
        s[OWN + PUSHED1 * lane + i] = p[LANES + PUSH1 * lane + i] * u
        s[OWN + PUSHED2 * lane + i] = p[LANES + PUSH2 * lane + i] * u
    if p[TAKEN] == 2.0:
        middle = w[io[MIDDLE]] - u
        end = w[io[END]] - u
        for i in range(low, high):
            a = LANES + i
            s[OWN + PUSHED1 * lane + i] += p[a + MIDDLE1 * lane] * middle + p[a + END1 * lane] * end
            s[OWN + PUSHED2 * lane + i] += p[a + MIDDLE2 * lane] * middle + p[a + END2 * lane] * end
        u = w[io[MIDDLE]]
    return float(u)


@kernel
def gauge(p: Any, s: Any, u: float) -> None:
    """Keep the mean square of the voltage over the shuttle's own memory.

    Of a bank that runs every N ticks it is the square of their mean that counts.
    """
    mean = u if p[EVERY] == 1.0 else (s[SUM] + u) / p[EVERY]
    s[SUM] = 0.0
    s[LEVEL] = settled(p[MEMORY] * s[LEVEL] + (1.0 - p[MEMORY]) * mean * mean)


@inlined
def predicted(p: Any, s: Any, i: int, lane: int) -> tuple[float, float]:
    """Return where the state of a model is a tick later."""
    a = LANES + i
    b = OWN + i
    x1 = s[b + X1 * lane]
    x2 = s[b + X2 * lane]
    return (
        p[a + MOVE11 * lane] * x1 + p[a + MOVE12 * lane] * x2 + s[b + PUSHED1 * lane],
        p[a + MOVE21 * lane] * x1 + p[a + MOVE22 * lane] * x2 + s[b + PUSHED2 * lane],
    )


@kernel
def drift(p: Any, s: Any, lane: int, low: int, high: int) -> None:
    """Let the states of models follow the voltage of a tick, uncorrected."""
    for i in range(low, high):
        b = OWN + i
        x1, x2 = predicted(p, s, i, lane)
        s[b + X1 * lane] = settled(x1)
        s[b + X2 * lane] = settled(x2)


@inlined
def coasts(p: Any, s: Any, w: Any, io: Any, lane: int, low: int, high: int) -> bool:
    """Take in the voltage of a tick; say whether a bank that runs every N of them is between two of its turns.

    Then its states follow the voltage, which changes at every tick: were it taken for held at its mean, a bank would be
    sure of the wrong model. The models that run are those from ``low`` to ``high``.
    """
    u = push(p, s, w, io, lane, low, high)
    between: bool = p[EVERY] != 1.0 and w[TICK] % p[EVERY] != 0.0
    if between:
        s[SUM] += u
        drift(p, s, lane, low, high)
    else:
        gauge(p, s, u)
    return between


@kernel
def driven(p: Any, s: Any) -> bool:
    """Say whether there is drive enough for residuals to be evidence."""
    return bool(s[LEVEL] >= p[LEAST_DRIVE])


@kernel
def informed(p: Any, s: Any, w: Any, io: Any) -> bool:
    """Say whether this sample is evidence: it was measured, and there is drive enough."""
    return math.isfinite(w[io[MEASURED]]) and driven(p, s)


@inlined
def filter_step(p: Any, s: Any, i: int, lane: int, z: float, first: bool, seen: bool) -> int:
    r"""Predict one filter, unless this is its first sample; correct it, if there is a measurement.

    .. math:: x^-=\Phi x+g,\quad P^-=\Phi P\Phi^T+W

    .. math:: r=z-Hx^-,\quad\psi=HP^-H^T+R,\quad K=P^-H^T/\psi,\quad x=x^-+Kr,\quad P=(I-KH)P^-

    with g what the voltage does and W what the pseudo-noise of the ticks since the last sample has become by now.

    What is decided is the same for all filters, so it chooses between values and not between ways: a loop of this
    stays one of vectors. Returns 1 if the residual covariance has changed, so that its logarithm is no longer right.
    """
    a = LANES + i
    b = OWN + i
    printed = p[PRINTED] != 0.0
    c11 = s[b + P11 * lane]
    c12 = s[b + P12 * lane]
    c22 = s[b + P22 * lane]
    f11 = p[a + PHI11 * lane]
    f12 = p[a + PHI12 * lane]
    f21 = p[a + PHI21 * lane]
    f22 = p[a + PHI22 * lane]
    q1 = f11 * c11 + f12 * c12
    q2 = f11 * c12 + f12 * c22
    q3 = f21 * c11 + f22 * c12
    q4 = f21 * c12 + f22 * c22
    c11 = c11 if first else q1 * f11 + q2 * f12 + p[a + NOISE11 * lane]
    c12 = c12 if first else q1 * f21 + q2 * f22 + p[a + NOISE12 * lane]
    c22 = c22 if first else q3 * f21 + q4 * f22 + p[a + NOISE22 * lane]
    total = c11 + p[SENSOR]
    # the text prints psi without R, and without assumed noise that would end at nothing
    psi = max(c11, LEAST * p[SENSOR]) if printed else total
    inverse = 1.0 / psi
    innovation = 1.0 / total if printed else inverse
    k1 = c11 * innovation
    k2 = c12 * innovation
    correct_state(p, s, i, lane, z, first, seen, k1, k2, inverse)
    s[b + P11 * lane] = c11 - k1 * c11 if seen else c11
    s[b + P12 * lane] = c12 - k1 * c12 if seen else c12
    s[b + P22 * lane] = c22 - k2 * c12 if seen else c22
    changed = 1 if psi != s[b + COVARIANCE * lane] else 0
    s[b + COVARIANCE * lane] = psi
    return changed


@inlined
def correct_state(
    p: Any, s: Any, i: int, lane: int, z: float, first: bool, seen: bool, k1: float, k2: float, inverse: float
) -> None:
    """Predict the state of one filter and correct it by a known gain."""
    b = OWN + i
    before1 = s[b + X1 * lane]
    before2 = s[b + X2 * lane]
    x1, x2 = predicted(p, s, i, lane)
    x1 = before1 if first else x1
    x2 = before2 if first else x2
    residual = settled(z - x1) if seen else 0.0
    s[b + X1 * lane] = settled(x1 + k1 * residual)
    s[b + X2 * lane] = settled(x2 + k2 * residual)
    s[b + RESIDUAL * lane] = residual
    s[b + INVERSE * lane] = inverse
    s[b + NIS * lane] = residual * residual * inverse


@inlined
def filters_step(p: Any, s: Any, w: Any, io: Any, n: int, residual_tap: int) -> bool:
    """Predict and correct all filters; show their residuals at a tap, and the squares over psi at the next.

    Returns whether a residual covariance has changed, so that its logarithm is no longer right.
    """
    z = w[io[MEASURED]]
    seen = math.isfinite(z)
    first = s[STARTED] == 0.0
    s[STARTED] = 1.0
    changed = 0
    if p[STEADY] == 0.0:
        for i in range(n):
            changed += filter_step(p, s, i, LANE, z, first, seen)
    else:
        for i in range(n):
            a = LANES + i
            psi = p[a + PSI * LANE]
            correct_state(
                p, s, i, LANE, z, first, seen, p[a + GAIN1 * LANE], p[a + GAIN2 * LANE], p[a + INVERSE_PSI * LANE]
            )
            changed += 1 if psi != s[OWN + COVARIANCE * LANE + i] else 0
            s[OWN + COVARIANCE * LANE + i] = psi
    residuals = io[residual_tap]
    squares = io[residual_tap + 1]
    for i in range(n):
        w[residuals + i] = s[OWN + RESIDUAL * LANE + i]
        w[squares + i] = s[OWN + NIS * LANE + i]
    return changed != 0


@kernel
def take_logarithms(s: Any, n: int) -> None:
    """Keep half the logarithm of every residual covariance."""
    for i in range(n):
        s[OWN + HALF_LOG * LANE + i] = 0.5 * math.log(s[OWN + COVARIANCE * LANE + i])


@inlined
def judge(s: Any, log: int, likelihood: int, n: int, evidence: bool) -> float:
    """Write the logarithms the residuals leave, from those at ``log`` to ``likelihood``; return the largest."""
    best = -math.inf
    for i in range(n):
        before = s[log + i]
        after = before - (0.5 * s[OWN + NIS * LANE + i] + s[OWN + HALF_LOG * LANE + i])
        after = after if evidence else before
        s[likelihood + i] = after
        best = max(best, after)
    return best


@kernel
def hand_over(s: Any, lane: int, source: int, target: int) -> None:
    """Let a filter go on from where another is: its state and its covariance."""
    for row in (X1, X2, P11, P12, P22):
        s[OWN + row * lane + target] = s[OWN + row * lane + source]
