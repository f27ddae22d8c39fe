r"""Hypotheses of where a shuttle under one beam is, each a Kalman filter, and their reflections.

The light is the same on both sides of each of its extremes, :math:`I(2x_e-x)=I(x)`: a hypothesis that passes an
extreme, or turns near one, has a double that did the opposite.
"""

from __future__ import annotations

import math
from typing import Any

from core.block import kernel
from core.sense import tracker
from core.sense.grating import OFFSET, WAVE, series
from core.sense.tracker import FILTER, P11, V, X, correct

NOISE, FORGET, PENALTY, DROP, NEAR, SAME_X, SAME_V, MODEL = range(8)
GRATING = MODEL + tracker.MODEL
"""Layout of the packed parameters: those of the hypotheses, the model of the shuttle, the grating."""
MOST = 10
SCORE, USED, WIDTH = FILTER, FILTER + 1, FILTER + 2
"""Layout of a hypothesis: a filter, its score, whether it is followed; and its length."""
NO, YES, NEW = 0.0, 1.0, 2.0
STARTED, BEST, CHANGES, OWN = range(4)
"""State: whether it has run, the best hypothesis, how often that changed, the hypotheses."""


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
    value, first, second = series(p, GRATING, s[b + X])
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
