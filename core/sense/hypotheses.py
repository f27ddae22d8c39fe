r"""Hypotheses of where a shuttle under one beam is, each a Kalman filter, and their reflections.

The light is the same on both sides of each of its extremes, :math:`I(2x_e-x)=I(x)`: a hypothesis that passes an
extreme, or turns near one, has a double that did the opposite.
"""

from __future__ import annotations

import math

from core.elementary import floor
from core.kernel import kernel
from core.record import Record, Records, several
from core.sense.grating import Grating, series
from core.sense.tracker import Filter, correct

MOST = 10
NO, YES, NEW = 0.0, 1.0, 2.0


class Odds(Grating):
    """What hypotheses are judged by, over the grating: noise, forgetting, odds, what counts as near and as alike."""

    noise: float
    forgetting: float
    reflection_odds: float
    drop: float
    near_um: float
    same_x: float
    same_v: float


class Hypothesis(Filter):
    """A filter, its score, whether it is followed."""

    score: float
    used: float


class Followed(Record):
    """The best hypothesis, how often that changed, the hypotheses."""

    best: float
    changes: float
    hypotheses: Records[Hypothesis] = several(MOST)


@kernel
def alike(p: Odds, hypothesis: Filter, x: float, v: float) -> bool:
    """Say whether a hypothesis is at a place with a speed."""
    return bool(abs(hypothesis.x - x) < p.same_x and abs(hypothesis.v - v) < p.same_v)


@kernel
def mirror(p: Odds, s: Followed, hypothesis: Hypothesis, extreme: float) -> None:
    """Add the reflection of a hypothesis in an extreme of the light, unless there is one like it or better ones."""
    x = 2.0 * extreme - hypothesis.x
    v = -hypothesis.v
    low = hypothesis.score - p.reflection_odds
    place = -1
    for i in range(MOST):
        other = s.hypotheses[i]
        if other.used == NO:
            # a free place is better than any
            place = i
            low = -math.inf
        elif alike(p, other, x, v):
            return
        elif other.score < low:
            place = i
            low = other.score
    if place < 0:
        return
    double = s.hypotheses[place]
    double.x = x
    double.v = v
    double.f = hypothesis.f
    double.p11 = hypothesis.p11
    double.p12 = hypothesis.p12
    double.p13 = hypothesis.p13
    double.p22 = hypothesis.p22
    double.p23 = hypothesis.p23
    double.p33 = hypothesis.p33
    double.score = hypothesis.score - p.reflection_odds
    double.used = NEW


@kernel
def follow(p: Odds, hypothesis: Hypothesis, z: float) -> None:
    """Correct one hypothesis, which has been predicted, and score it."""
    value, first, second = series(p, hypothesis.x)
    # to second order: near an extreme of the light the slope is nothing and the curvature is all
    bend = 0.5 * second * hypothesis.p11
    gain = correct(hypothesis, z - value - bend, first, p.noise + 2.0 * bend * bend)
    hypothesis.score = p.forgetting * hypothesis.score + gain


@kernel
def turns(p: Odds, s: Followed, hypothesis: Hypothesis, x: float, v: float) -> None:
    """Add the reflection of a hypothesis that came from (x, v), if it passed an extreme or turned near one."""
    half = math.pi / p.wave
    before = floor((x - p.offset) / half)
    place = (hypothesis.x - p.offset) / half
    after = floor(place)
    if after != before:
        mirror(p, s, hypothesis, p.offset + half * max(before, after))
    elif v * hypothesis.v < 0.0:
        nearest = floor(place + 0.5)
        if abs(place - nearest) * half < p.near_um:
            mirror(p, s, hypothesis, p.offset + half * nearest)


@kernel
def sift(p: Odds, s: Followed) -> float:
    """Drop the unlikely and those that have become like a better one; find the best; return how many are left."""
    best = int(s.best)
    high = -math.inf
    for i in range(MOST):
        hypothesis = s.hypotheses[i]
        if hypothesis.used != NO and hypothesis.score > high:
            best = i
            high = hypothesis.score
    if best != int(s.best):
        s.best = float(best)
        s.changes += 1.0
    left = 0.0
    for i in range(MOST):
        hypothesis = s.hypotheses[i]
        if hypothesis.used == NO:
            continue
        keep = hypothesis.score > high - p.drop
        for j in range(MOST):
            other = s.hypotheses[j]
            ahead = other.score > hypothesis.score or (other.score == hypothesis.score and j < i)
            if j != i and other.used != NO and ahead and alike(p, other, hypothesis.x, hypothesis.v):
                keep = False
        hypothesis.used = YES if keep else NO
        left += 1.0 if keep else 0.0
    return left
