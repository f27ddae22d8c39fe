r"""The last samples of normalised residuals: their power, and their part at one tone.

.. math:: S_k=\sum_W\nu_k^2\sim\chi^2_W,\qquad T_k=b_k^TG^{-1}b_k\sim\chi^2_2,\quad
    b_k=\sum_W\nu_k\binom{\cos\omega t}{\sin\omega t}

for a true and well tuned model, :math:`\nu=r/\sqrt\psi`. The sum of the squares and products of cosine and sine is

.. math:: G=\frac12\begin{pmatrix}W+D\cos2\theta&D\sin2\theta\\D\sin2\theta&W-D\cos2\theta\end{pmatrix},\qquad
    D=\frac{\sin W\omega h}{\sin\omega h},

with the angle :math:`\theta` in the middle of the window; over whole half periods :math:`D=0` and
:math:`T_k=\tfrac2W|b_k|^2`. While the window fills, :math:`T_k` is less than it may be. Sums slide: what enters is
added and what leaves is taken off; once per window each is exchanged for one summed anew, so that rounding never adds
up.
"""

from __future__ import annotations

import math
from typing import Any

from core.block import TICK, Context, inlined, kernel
from core.diagnose.filters import COVARIANCE, OWN, RESIDUAL
from core.diagnose.lanes import LANE

LENGTH, PLACE, TONE, HEAD = range(4)
COSINE_SUM, SINE_SUM, POWER_SUM, COSINE_NEW, SINE_NEW, POWER_NEW, SUMS = range(7)
"""Lanes of sums; then rings of cosines, of sines, and of lanes of normalised residuals."""
MOST = 512
"""Longest window that is not asked for."""
ALONG, ACROSS, SPAN, LEAN = range(4)
"""Packed parameters of the tone: D/W at the angle of the last sample, and W - D^2/W."""


def tone_hz(params: Any, context: Context) -> float:
    """Return the tone: given, or that of the reference, or the resonance."""
    return float(params.tone_hz or context.tone_hz or 1e3 * context.device.natural_frequency / (2.0 * math.pi))


def length(params: Any, context: Context) -> int:
    """Return the length of the window: given, or one period of the tone, as far as there is room."""
    period = 1e3 / (tone_hz(params, context) * context.dt_ms)
    return params.window or min(max(2, round(period)), MOST)


def room(params: Any) -> int:
    """Return how many samples there is room for."""
    return params.window or MOST


def size(capacity: int) -> int:
    """Return how many numbers a window takes."""
    return HEAD + SUMS * LANE + (2 + LANE) * capacity


def lean(params: Any, context: Context, samples: int) -> list[float]:
    """Pack by how much the squares and products of cosine and sine over the window are not those of whole half periods.

    Where they are nearly dependent only the larger direction counts: one degree of freedom, which is conservative.
    """
    cycles = tone_hz(params, context) / 1e3 * context.dt_ms
    step = 2.0 * math.pi * (cycles - math.floor(cycles))
    back = (samples - 1) * step
    sine = math.sin(step)
    share = math.sin(samples * step) / sine / samples if abs(sine) > 1e-9 else math.cos(back)
    if abs(share) < 1e-9:
        share = 0.0
    span = samples * (1.0 - share * share)
    if abs(share) > 1.0 - 1e-6:
        share, span = -math.copysign(1.0, share), 4.0 * samples
    return [share * math.cos(back), share * math.sin(back), span]


@kernel
def begin(s: Any, at: int, capacity: int, window: float, tone: float) -> int:
    """Return the place of this sample; a window of another length starts empty, and of another tone without a tone."""
    sums = at + HEAD
    rings = sums + SUMS * LANE
    if s[at + LENGTH] != window:
        for i in range(at, rings + (2 + LANE) * capacity):
            s[i] = 0.0
        s[at + LENGTH] = window
    if s[at + TONE] != tone:
        for i in range(LANE):
            for row in (COSINE_SUM, SINE_SUM, COSINE_NEW, SINE_NEW):
                s[sums + row * LANE + i] = 0.0
        for i in range(rings, rings + 2 * capacity):
            s[i] = 0.0
        s[at + TONE] = tone
    return int(s[at + PLACE])


@inlined
def push(s: Any, at: int, n: int, capacity: int, place: int, cosine: float, sine: float) -> None:
    """Let the normalised residuals of all models in, and the oldest out; go on to the next place.

    At the end of the window the sums are exchanged for those summed anew.
    """
    sums = at + HEAD
    ring = sums + SUMS * LANE
    rows = ring + 2 * capacity
    old_cosine = s[ring + place]
    old_sine = s[ring + capacity + place]
    s[ring + place] = cosine
    s[ring + capacity + place] = sine
    row = rows + LANE * place
    for i in range(n):
        value = s[OWN + RESIDUAL * LANE + i] / math.sqrt(s[OWN + COVARIANCE * LANE + i])
        old = s[row + i]
        s[row + i] = value
        c = value * cosine
        d = value * sine
        e = value * value
        s[sums + COSINE_SUM * LANE + i] += c - old * old_cosine
        s[sums + SINE_SUM * LANE + i] += d - old * old_sine
        s[sums + POWER_SUM * LANE + i] += e - old * old
        s[sums + COSINE_NEW * LANE + i] += c
        s[sums + SINE_NEW * LANE + i] += d
        s[sums + POWER_NEW * LANE + i] += e
    place += 1
    if place >= s[at + LENGTH]:
        place = 0
        for i in range(3 * LANE):
            s[sums + i] = s[sums + COSINE_NEW * LANE + i]
            s[sums + COSINE_NEW * LANE + i] = 0.0
    s[at + PLACE] = place


@inlined
def leaning(p: Any, a: int, cosine: float, sine: float) -> tuple[float, float]:
    """Return D/W times cosine and twice the sine of the doubled angle in the middle of the window."""
    c = cosine * cosine - sine * sine
    d = 2.0 * cosine * sine
    return p[a + ALONG] * c + p[a + ACROSS] * d, 2.0 * (p[a + ALONG] * d - p[a + ACROSS] * c)


@inlined
def tone(s: Any, at: int, i: int, along: float, across: float, span: float) -> float:
    """Return T of one model."""
    c = s[at + HEAD + COSINE_SUM * LANE + i]
    d = s[at + HEAD + SINE_SUM * LANE + i]
    return 2.0 * (c * c + d * d - (along * (c * c - d * d) + across * (c * d))) / span  # type: ignore[no-any-return]


@inlined
def power(s: Any, at: int, i: int) -> float:
    """Return S of one model, never less than nothing by rounding."""
    return max(s[at + HEAD + POWER_SUM * LANE + i], 0.0)  # type: ignore[no-any-return]


@kernel
def angle(w: Any, cycles_per_ms: float, dt_ms: float) -> float:
    """Return the angle of the tone at this tick."""
    cycles = w[TICK] * dt_ms * cycles_per_ms
    return float(2.0 * math.pi * (cycles - math.floor(cycles)))
