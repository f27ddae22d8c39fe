"""Recovery from one beam: several Kalman filters that know the device, one for each way a turn may have gone."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port, kernel, parameter
from core.sense import tracker
from core.sense.grating import COUNT, FIRST, MEAN, OFFSET, WAVE
from core.sense.sensor import ENGAGED_PORT, LAST_PORT, Sensor, calibrated, rest
from core.sense.through_wafer import ThroughWafer
from core.sense.tracker import FILTER, P11, TrackerParams, V, X, coast, correct, predict

NOISE, FORGET, PENALTY, DROP, NEAR, SAME_X, SAME_V, MODEL = range(8)
GRATING = MODEL + tracker.MODEL
ENGAGED, LAST, LIGHT, APPLIED, TRUE, DISPLACEMENT, ERROR, ACTIVE, ALIVE, SWITCHES, SLIPS = range(11)
MOST = 10
SCORE, USED, WIDTH = FILTER, FILTER + 1, FILTER + 2
NO, YES, NEW = 0.0, 1.0, 2.0
RUNNING, BEST, CHANGES, FRESH = range(4)
OWN = FRESH + FILTER
"""State: whether it runs, the best hypothesis, how often that changed, a filter to start from, the hypotheses."""


@kernel
def light(p: Any, x: float) -> tuple[float, float, float]:
    """Return the intensity, its slope and its curvature by displacement."""
    angle = p[GRATING + WAVE] * (x - p[GRATING + OFFSET])
    c1 = math.cos(angle)
    s1 = math.sin(angle)
    c0 = 1.0
    s0 = 0.0
    twice = 2.0 * c1
    value = float(p[GRATING + MEAN])
    first = 0.0
    second = 0.0
    for i in range(int(p[GRATING + COUNT])):
        m = i + 1.0
        a = p[GRATING + FIRST + i]
        value += a * c1
        first -= m * a * s1
        second -= m * m * a * c1
        c2 = twice * c1 - c0
        s2 = twice * s1 - s0
        c0 = c1
        c1 = c2
        s0 = s1
        s1 = s2
    wave = p[GRATING + WAVE]
    return value, wave * first, wave * wave * second


@kernel
def alike(p: Any, s: Any, b: int, x: float, v: float) -> bool:
    """Say whether a hypothesis is at a place with a speed."""
    return bool(abs(s[b + X] - x) < p[SAME_X] and abs(s[b + V] - v) < p[SAME_V])


@kernel
def mirror(p: Any, s: Any, b: int, extreme: float) -> None:
    """Add the reflection of a hypothesis in an extreme of the light, unless there is one like it or better ones."""
    x = 2.0 * extreme - s[b + X]
    v = -s[b + V]
    low = s[b + SCORE] - p[PENALTY]
    to = -1
    for i in range(MOST):
        o = OWN + i * WIDTH
        if s[o + USED] == NO:
            # a free place is better than any
            to = o
            low = -math.inf
        elif alike(p, s, o, x, v):
            return
        elif s[o + SCORE] < low:
            to = o
            low = s[o + SCORE]
    if to < 0:
        return
    for j in range(FILTER):
        s[to + j] = s[b + j]
    s[to + X] = x
    s[to + V] = v
    s[to + SCORE] = s[b + SCORE] - p[PENALTY]
    s[to + USED] = NEW


@kernel
def follow(p: Any, s: Any, b: int, z: float) -> None:
    """Correct one hypothesis, which has been predicted, and score it."""
    value, first, second = light(p, s[b + X])
    # to second order: near an extreme of the light the slope is nothing and the curvature is all
    bend = 0.5 * second * s[b + P11]
    gain = correct(s, b, z - value - bend, first, p[NOISE] + 2.0 * bend * bend)
    s[b + SCORE] = p[FORGET] * s[b + SCORE] + gain


@kernel
def turns(p: Any, s: Any, b: int, x: float, v: float) -> None:
    """Add the reflection of a hypothesis that came from (x, v), if it passed an extreme or turned near one."""
    half = math.pi / p[GRATING + WAVE]
    before = math.floor((x - p[GRATING + OFFSET]) / half)
    place = (s[b + X] - p[GRATING + OFFSET]) / half
    after = math.floor(place)
    if after != before:
        mirror(p, s, b, p[GRATING + OFFSET] + half * max(before, after))
    elif v * s[b + V] < 0.0:
        nearest = math.floor(place + 0.5)
        if abs(place - nearest) * half < p[NEAR]:
            mirror(p, s, b, p[GRATING + OFFSET] + half * nearest)


@kernel
def sift(p: Any, s: Any) -> float:
    """Drop the unlikely and those that have become like a better one; find the best; return how many are left."""
    best = int(s[BEST])
    high = -math.inf
    for i in range(MOST):
        b = OWN + i * WIDTH
        if s[b + USED] != NO and s[b + SCORE] > high:
            best = i
            high = s[b + SCORE]
    if best != int(s[BEST]):
        s[BEST] = float(best)
        s[CHANGES] += 1.0
    left = 0.0
    for i in range(MOST):
        b = OWN + i * WIDTH
        if s[b + USED] == NO:
            continue
        keep = s[b + SCORE] > high - p[DROP]
        for j in range(MOST):
            o = OWN + j * WIDTH
            ahead = s[o + SCORE] > s[b + SCORE] or (s[o + SCORE] == s[b + SCORE] and j < i)
            if j != i and s[o + USED] != NO and ahead and alike(p, s, o, s[b + X], s[b + V]):
                keep = False
        s[b + USED] = YES if keep else NO
        left += 1.0 if keep else 0.0
    return left


def single_beam_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Follow every hypothesis and put out the likeliest."""
    if w[TICK] > 0.0:
        coast(p, MODEL, s, FRESH, w[io[APPLIED]])
    if w[io[ENGAGED]] == 0.0:
        s[RUNNING] = 0.0
        rest(w, io, DISPLACEMENT, SLIPS)
        return
    first = s[RUNNING] == 0.0
    if first:
        s[RUNNING] = 1.0
        s[BEST] = 0.0
        s[CHANGES] = 0.0
        for j in range(MOST * WIDTH):
            s[OWN + j] = 0.0
        for j in range(FILTER):
            s[OWN + j] = s[FRESH + j]
        if math.isfinite(w[io[LAST]]):
            s[OWN + X] = w[io[LAST]]
        s[OWN + USED] = YES
    z = w[io[LIGHT]]
    for i in range(MOST):
        b = OWN + i * WIDTH
        if s[b + USED] == YES:
            x = s[b + X]
            v = s[b + V]
            if not first:
                predict(p, MODEL, s, b, w[io[APPLIED]])
            if math.isfinite(z):
                follow(p, s, b, z)
                turns(p, s, b, x, v)
    left = sift(p, s)
    x = s[OWN + int(s[BEST]) * WIDTH + X]
    error = x - w[io[TRUE]]
    pitch = 2.0 * math.pi / p[GRATING + WAVE]
    w[io[DISPLACEMENT]] = x
    w[io[ERROR]] = error
    w[io[ACTIVE]] = 1.0
    w[io[ALIVE]] = left
    w[io[SWITCHES]] = s[CHANGES]
    w[io[SLIPS]] = math.floor(error / pitch + 0.5) if math.isfinite(error) else 0.0


class SingleBeam(Sensor):
    r"""Displacement from one beam by several extended Kalman filters that know the device and the voltage.

    The light is the same on both sides of each of its extremes, :math:`I(2x_e-x)=I(x)`. So whenever a hypothesis
    passes an extreme, or turns near one, its reflection :math:`(2x_e-x,-\dot x)` is followed as well, at most ten in
    all; only one of the two keeps obeying the equation of motion. The likeliest is put out, by a likelihood with a
    memory of a few periods of the drive.

    It costs as much as the rest of the bench together, and therefore rests while no one uses it: unless it is the
    sensor in use or ``always`` is set, its output is 0 and so is the tap ``active``. Then only the nominal model goes
    on under the voltage: the speed to start with. The displacement to start with is what was measured last.
    The text leaves the unit to others (2.2.3: Dawson 2000, 2002; Wang 2005); this one is the bench's own.
    """

    title = "Single beam, several hypotheses"
    inputs = (
        ENGAGED_PORT,
        LAST_PORT,
        Port("light", "1", "light through the wafer", source="through_wafer.intensity"),
        Port("applied", "V", "voltage applied over the sample that ends now", source="drive.voltage"),
        Port("true", "um", "true displacement, for the error only", source="plant.displacement"),
    )
    outputs = (Port("displacement", "um", "recovered displacement"),)
    taps = (
        Port("error", "um", "recovered minus true displacement"),
        Port("active", "1", "0 while it rests"),
        Port("hypotheses", "1", "hypotheses followed"),
        Port("switches", "1", "how often another hypothesis became the likeliest"),
        Port("slips", "1", "whole pitches it is off by"),
    )
    equations = (
        Equation("motion", r"\ddot x=\frac{F_e-\beta\dot x-kx}{m}+f,\quad \dot f=n"),
        Equation("reflection", r"x'=2x_e-x,\quad\dot x'=-\dot x"),
        Equation(
            "likelihood",
            r"\ell\leftarrow\lambda\ell-\tfrac{r^2}{2\psi}-\tfrac12\ln\psi,\quad"
            r"\psi=I'^2P_{11}+\tfrac12I''^2P_{11}^2+R",
        ),
    )

    class Params(TrackerParams):
        """What it assumes of the shuttle, and how it treats hypotheses."""

        memory_ms: float = parameter(2.8, "memory of the likelihood", "ms", gt=0, le=1e4)
        reflection_odds: float = parameter(8.0, "logarithm of the odds against a reflection", ge=0, le=100)
        drop: float = parameter(40.0, "log-likelihood below the best at which a hypothesis is dropped", gt=0, le=1e4)
        near_um: float = parameter(0.5, "turns this near an extreme are reflected", "um", ge=0, le=100)

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of a pair of beams of the same quality; the filter's own error is close to it."""
        return calibrated(context, "through_wafer", ThroughWafer.Params).phase_noise_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step, with the grating as calibrated."""
        beam = calibrated(context, "through_wafer", ThroughWafer.Params)
        noise = max(beam.noise, 1e-4 * abs(beam.harmonics[0]), 1e-30)
        own = [
            noise * noise,
            math.exp(-context.dt_ms / params.memory_ms),
            params.reflection_odds,
            params.drop,
            params.near_um,
            0.0125 * beam.pitch_um,
            0.025 * beam.pitch_um * context.device.natural_frequency,
        ]
        return np.array(own + tracker.pack_model(params, context) + beam.packed(context))

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it runs, the best hypothesis, changes of it, a filter to start from, the hypotheses."""
        return np.array([0.0, 0.0, 0.0, *tracker.start(params, context), *[0.0] * (MOST * WIDTH)])

    step = single_beam_step
