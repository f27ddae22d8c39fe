r"""The last samples of normalised residuals: their power, and their part at one tone.

.. math:: S_k=\sum_W\nu_k^2\sim\chi^2_W,\qquad T_k=b_k^TG^{-1}b_k\sim\chi^2_2,\quad
    b_k=\sum_W\nu_k\binom{\cos\omega t}{\sin\omega t}

for a true and well tuned model, :math:`\nu=r/\sqrt\psi`. The sum of the squares and products of cosine and sine is

.. math:: G=\frac12\begin{pmatrix}W+D\cos2\theta&D\sin2\theta\\D\sin2\theta&W-D\cos2\theta\end{pmatrix},\qquad
    D=\frac{\sin W\omega h}{\sin\omega h},

with the angle :math:`\theta` in the middle of the window; over whole half periods :math:`D=0` and
:math:`T_k=\tfrac2W|b_k|^2`. While the window fills, :math:`T_k` is less than it may be. The sums slide: each new sample
is added and the oldest is subtracted. Once per window each sum is replaced by one formed anew, so that rounding errors
never accumulate.
"""

from __future__ import annotations

import math
from typing import Any

from core.block import Context
from core.diagnose.kalman import KalmanBank
from core.diagnose.lanes import LANE
from core.elementary import cos, floor, sin
from core.kernel import kernel
from core.record import Choice, Record, Records, Vector, tail, vector

MOST = 512
"""Longest window that the block chooses by itself."""


class Packed(KalmanBank.Packed):
    """Parameters of the filters; tone, tick, samples of the window and room for them; D/W at the last sample's angle.

    ``span`` is W - D^2/W.
    """

    cycles_per_ms: float
    tick_ms: float
    samples: float
    capacity: Choice
    along: float
    across: float
    span: float


class WindowSample(Record):
    """Cosine, sine, and the normalised residuals of all models."""

    cosine: float
    sine: float
    residual: Vector = vector(LANE)


class State(KalmanBank.State):
    """The filters; length, next place and tone of the window; its sums, the sums of this turn of the ring; the ring."""

    samples: float
    place: float
    tone: float
    cosine_sum: Vector = vector(LANE)
    sine_sum: Vector = vector(LANE)
    power_sum: Vector = vector(LANE)
    cosine_new: Vector = vector(LANE)
    sine_new: Vector = vector(LANE)
    power_new: Vector = vector(LANE)
    ring: Records[WindowSample] = tail()


def tone_hz(params: Any, context: Context) -> float:
    """Return the given tone, or the tone of the reference, or the resonance."""
    return float(params.tone_hz or context.tone_hz or 1e3 * context.device.natural_frequency / (2.0 * math.pi))


def length(params: Any, context: Context) -> int:
    """Return the given length of the window, or one period of the tone, as far as there is room."""
    period = 1e3 / (tone_hz(params, context) * context.dt_ms)
    return params.window or min(max(2, round(period)), MOST)


def room(params: Any) -> int:
    """Return the number of samples the window has room for."""
    return params.window or MOST


def lean(params: Any, context: Context, samples: int) -> tuple[float, float, float]:
    """Return the deviation of the sums of squares and products of cosine and sine from those over whole half periods.

    If cosine and sine are nearly dependent, only the larger direction counts: one degree of freedom, which is
    conservative.
    """
    cycles = tone_hz(params, context) / 1e3 * context.dt_ms
    step = 2.0 * math.pi * (cycles - math.floor(cycles))
    back = (samples - 1) * step
    sine = sin(step)
    share = sin(samples * step) / sine / samples if abs(sine) > 1e-9 else cos(back)
    if abs(share) < 1e-9:
        share = 0.0
    span = samples * (1.0 - share * share)
    if abs(share) > 1.0 - 1e-6:
        share, span = -math.copysign(1.0, share), 4.0 * samples
    return share * cos(back), share * sin(back), span


def fill(p: Packed, params: Any, context: Context, samples: int, capacity: int) -> None:
    """Pack the tone and the window."""
    p.cycles_per_ms = tone_hz(params, context) / 1e3
    p.tick_ms = context.dt_ms / context.every
    p.samples, p.capacity = samples, capacity
    p.along, p.across, p.span = lean(params, context, samples)


@kernel
def begin(p: Packed, s: State) -> int:
    """Return the place of this sample; clear the window if its length changed, and its tone if that changed."""
    capacity = int(p.capacity)
    if s.samples != p.samples:
        s.place = 0.0
        s.tone = 0.0
        for i in range(LANE):
            s.power_sum[i] = 0.0
            s.power_new[i] = 0.0
        for place in range(capacity):
            sample = s.ring[place]
            for i in range(LANE):
                sample.residual[i] = 0.0
        clear_tone(s, capacity)
        s.samples = p.samples
    if s.tone != p.cycles_per_ms:
        clear_tone(s, capacity)
        s.tone = p.cycles_per_ms
    return int(s.place)


@kernel
def clear_tone(s: State, capacity: int) -> None:
    """Clear the sums and samples at the tone."""
    for i in range(LANE):
        s.cosine_sum[i] = 0.0
        s.sine_sum[i] = 0.0
        s.cosine_new[i] = 0.0
        s.sine_new[i] = 0.0
    for place in range(capacity):
        sample = s.ring[place]
        sample.cosine = 0.0
        sample.sine = 0.0


@kernel
def push(s: State, n: int, place: int, cosine: float, sine: float) -> None:
    """Add the normalised residuals of all models, subtract the oldest residuals, and move to the next place.

    At the end of the window the sums are replaced by those formed anew.
    """
    sample = s.ring[place]
    old_cosine = sample.cosine
    old_sine = sample.sine
    sample.cosine = cosine
    sample.sine = sine
    row = sample.residual
    for i in range(n):
        value = s.residual[i] / math.sqrt(s.covariance[i])
        old = row[i]
        row[i] = value
        c = value * cosine
        d = value * sine
        e = value * value
        s.cosine_sum[i] += c - old * old_cosine
        s.sine_sum[i] += d - old * old_sine
        s.power_sum[i] += e - old * old
        s.cosine_new[i] += c
        s.sine_new[i] += d
        s.power_new[i] += e
    place += 1
    if place >= s.samples:
        place = 0
        for i in range(LANE):
            s.cosine_sum[i] = s.cosine_new[i]
            s.sine_sum[i] = s.sine_new[i]
            s.power_sum[i] = s.power_new[i]
            s.cosine_new[i] = 0.0
            s.sine_new[i] = 0.0
            s.power_new[i] = 0.0
    s.place = place


@kernel
def leaning(p: Packed, cosine: float, sine: float) -> tuple[float, float]:
    """Return D/W times cosine and twice the sine of the doubled angle in the middle of the window."""
    c = cosine * cosine - sine * sine
    d = 2.0 * cosine * sine
    return p.along * c + p.across * d, 2.0 * (p.along * d - p.across * c)


@kernel
def tone(s: State, i: int, along: float, across: float, span: float) -> float:
    """Return T of one model."""
    c = s.cosine_sum[i]
    d = s.sine_sum[i]
    return 2.0 * (c * c + d * d - (along * (c * c - d * d) + across * (c * d))) / span  # type: ignore[no-any-return]


@kernel
def power(s: State, i: int) -> float:
    """Return S of one model, which rounding cannot make negative."""
    return max(s.power_sum[i], 0.0)  # type: ignore[no-any-return]


@kernel
def angle(p: Packed, tick: float) -> float:
    """Return the angle of the tone at this tick."""
    cycles = tick * p.tick_ms * p.cycles_per_ms
    return 2.0 * math.pi * (cycles - floor(cycles))
