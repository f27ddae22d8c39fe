r"""The last samples of normalised residuals: their power, and their part at one tone.

.. math:: S_k=\sum_W\nu_k^2\sim\chi^2_W,\qquad T_k=\frac{2}{W}\Bigl|\sum_W\nu_ke^{-j\omega t}\Bigr|^2\sim\chi^2_2

for a true and well tuned model, :math:`\nu=r/\sqrt\psi`. Sums slide: what enters is added and what leaves is taken off;
once per window each is exchanged for one summed anew, so that rounding never adds up.
"""

from __future__ import annotations

import math
from typing import Any

from core.block import TICK, Context, kernel

LENGTH, PLACE, HEAD = range(3)
COSINE_SUM, SINE_SUM, POWER_SUM, COSINE_NEW, SINE_NEW, POWER_NEW, SUMS = range(7)
"""Lanes of sums, each as long as there are models; then rings of cosines, sines and residuals."""
MOST = 512
"""Longest window that is not asked for."""


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


def size(n: int, capacity: int) -> int:
    """Return how many numbers a window of n models takes."""
    return HEAD + SUMS * n + (2 + n) * capacity


@kernel
def begin(s: Any, at: int, n: int, capacity: int, window: float) -> int:
    """Return the place of this sample; a window of another length starts empty."""
    if s[at + LENGTH] != window:
        for i in range(at, at + HEAD + SUMS * n + (2 + n) * capacity):
            s[i] = 0.0
        s[at + LENGTH] = window
    return int(s[at + PLACE])


@kernel
def push(s: Any, at: int, n: int, capacity: int, i: int, place: int, value: float, cosine: float, sine: float) -> None:
    """Let a normalised residual of one model in, and the oldest out."""
    sums = at + HEAD + i
    cosines = at + HEAD + SUMS * n
    sines = cosines + capacity
    ring = sines + capacity * (1 + i) + place
    old = s[ring]
    s[ring] = value
    c = value * cosine
    d = value * sine
    e = value * value
    s[sums + COSINE_SUM * n] += c - old * s[cosines + place]
    s[sums + SINE_SUM * n] += d - old * s[sines + place]
    s[sums + POWER_SUM * n] += e - old * old
    s[sums + COSINE_NEW * n] += c
    s[sums + SINE_NEW * n] += d
    s[sums + POWER_NEW * n] += e


@kernel
def end(s: Any, at: int, n: int, capacity: int, place: int, cosine: float, sine: float) -> None:
    """Go on to the next place; at the end of the window exchange the sums for those summed anew."""
    s[at + HEAD + SUMS * n + place] = cosine
    s[at + HEAD + SUMS * n + capacity + place] = sine
    place += 1
    if place >= s[at + LENGTH]:
        place = 0
        for i in range(3 * n):
            s[at + HEAD + i] = s[at + HEAD + COSINE_NEW * n + i]
            s[at + HEAD + COSINE_NEW * n + i] = 0.0
    s[at + PLACE] = place


@kernel
def tone(s: Any, at: int, n: int, i: int) -> float:
    """Return T of one model."""
    c = s[at + HEAD + COSINE_SUM * n + i]
    d = s[at + HEAD + SINE_SUM * n + i]
    return float(2.0 * (c * c + d * d) / s[at + LENGTH])


@kernel
def power(s: Any, at: int, n: int, i: int) -> float:
    """Return S of one model, never less than nothing by rounding."""
    return float(max(s[at + HEAD + POWER_SUM * n + i], 0.0))


@kernel
def angle(w: Any, cycles_per_ms: float, dt_ms: float) -> float:
    """Return the angle of the tone at this tick."""
    cycles = w[TICK] * dt_ms * cycles_per_ms
    return float(2.0 * math.pi * (cycles - math.floor(cycles)))
