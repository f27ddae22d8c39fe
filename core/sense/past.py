"""The past: what was measured over the last samples, under which voltages; a filter that begins catches up with it."""

from __future__ import annotations

from typing import Any

from core.block import TICK, Port, kernel
from core.sense.tracker import P11, P22, X, correct, predict

MEASURED, APPLIED, VARIANCE, ENTRY = range(4)
"""Layout of an entry, and its length; a variance of 0 says that nothing was measured."""
KEPT = 32
"""Entries kept: noise of the speed falls with the power 3/2 of it. A unit that runs more rarely finds none."""
SPEED = 100.0
"""Variance of the speed a fresh filter assumes in motion, over that at rest: up to the stroke at resonance."""

PAST_PORT = Port("past", "mixed", "what was measured over the last samples, to begin from", source="sensor.past")


@kernel
def note(w: Any, at: int, measured: float, applied: float, variance: float) -> None:
    """Write what was measured at this tick over the oldest entry."""
    entry = at + int(w[TICK]) % KEPT * ENTRY
    w[entry + MEASURED] = measured
    w[entry + APPLIED] = applied
    w[entry + VARIANCE] = variance


@kernel
def catch_up(p: Any, at: int, s: Any, b: int, w: Any, past: int, every: int) -> bool:
    """Run the fresh filter at ``b`` through the past, one entry in ``every``; return whether there was any."""
    begun = False
    place = s[b + P11]
    for back in range(KEPT // every * every, 0, -every):
        entry = past + int(w[TICK] - back) % KEPT * ENTRY
        if begun:
            predict(p, at, s, b, w[entry + APPLIED])
        if w[entry + VARIANCE] > 0.0:
            if not begun:
                begun = True
                s[b + X] = w[entry + MEASURED]
                s[b + P22] *= SPEED
            correct(s, b, w[entry + MEASURED] - s[b + X], 1.0, w[entry + VARIANCE])
    if begun:
        # whatever the past says, another sensor may be off by as much as before
        s[b + P11] += place
    return begun
