r"""Hypotheses of the position of a shuttle under one beam, each a Kalman filter, and their reflections.

The light is the same on both sides of each of its extremes, :math:`I(2x_e-x)=I(x)`. If a hypothesis passes an extreme,
or turns near one, a second hypothesis with the reflected motion explains the light equally well.
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
    """Grating, noise, forgetting and odds, and the distances within which hypotheses count as near or as alike."""

    noise: float
    forgetting: float
    reflection_odds: float
    drop: float
    near_um: float
    same_x: float
    same_v: float


class FringeHypothesis(Filter):
    """A filter, its score, whether it is followed."""

    score: float
    used: float


class Followed(Record):
    """The best hypothesis, how often that changed, the hypotheses."""

    best: float
    changes: float
    hypotheses: Records[FringeHypothesis] = several(MOST)


@kernel
def alike(p: Odds, hypothesis: Filter, x: float, v: float) -> bool:
    """Say whether a hypothesis has nearly this position and speed."""
    return bool(abs(hypothesis.x - x) < p.same_x and abs(hypothesis.v - v) < p.same_v)


@kernel
def mirror(p: Odds, s: Followed, hypothesis: FringeHypothesis, extreme: float) -> None:
    """Add the reflection of a hypothesis in an extreme of the light, unless a similar one or only better ones exist."""
    x = 2.0 * extreme - hypothesis.x
    v = -hypothesis.v
    low = hypothesis.score - p.reflection_odds
    place = -1
    for i in range(MOST):
        rival = s.hypotheses[i]
        if rival.used == NO:
            # a free place is better than replacing a hypothesis
            place = i
            low = -math.inf
        elif alike(p, rival, x, v):
            return
        elif rival.score < low:
            place = i
            low = rival.score
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
def follow(p: Odds, hypothesis: FringeHypothesis, z: float) -> None:
    """Correct one hypothesis, which has been predicted, and score it."""
    value, first, second = series(p, hypothesis.x)
    # to second order: near an extreme of the light the slope vanishes and only the curvature counts
    bend = 0.5 * second * hypothesis.p11
    gain = correct(hypothesis, z - value - bend, first, p.noise + 2.0 * bend * bend)
    hypothesis.score = p.forgetting * hypothesis.score + gain


@kernel
def turns(p: Odds, s: Followed, hypothesis: FringeHypothesis, x: float, v: float) -> None:
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
    """Drop unlikely hypotheses and those similar to a better one; find the best; return how many are left."""
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
            rival = s.hypotheses[j]
            ahead = rival.score > hypothesis.score or (rival.score == hypothesis.score and j < i)
            if j != i and rival.used != NO and ahead and alike(p, rival, hypothesis.x, hypothesis.v):
                keep = False
        hypothesis.used = YES if keep else NO
        left += 1.0 if keep else 0.0
    return left
