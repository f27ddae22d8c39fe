"""The past: what was measured over the last samples, under which voltages; a filter that begins catches up with it."""

from __future__ import annotations

from typing import Any

from core.block import TICK, Port, kernel
from core.sense.tracker import EVERY, P11, P22, TICK_MODEL, X, correct, predict
from core.voltage import BEGUN, follow

MEASURED, APPLIED, MIDDLE, END, VARIANCE, ENTRY = range(6)
"""Layout of an entry, and its length; a variance of 0 says that nothing was measured."""
KEPT = 32
"""Entries kept: noise of the speed falls with the power 3/2 of it. A unit that runs more rarely finds none."""
SPEED = 100.0
"""Variance of the speed a fresh filter assumes in motion, over that at rest: up to the stroke at resonance."""

PAST_PORT = Port("past", "mixed", "what was measured over the last samples, to begin from", source="sensor.past")


@kernel
def note(w: Any, io: Any, past: int, applied: int, measured: float, variance: float) -> None:
    """Write what was measured at this tick, and the voltage before it, over the oldest entry."""
    entry = io[past] + int(w[TICK]) % KEPT * ENTRY
    w[entry + MEASURED] = measured
    w[entry + APPLIED] = w[io[applied]]
    w[entry + MIDDLE] = w[io[applied + 1]]
    w[entry + END] = w[io[applied + 2]]
    w[entry + VARIANCE] = variance


@kernel
def catch_up(p: Any, at: int, s: Any, b: int, drive: int, w: Any, io: Any, past: int, applied: int) -> bool:
    """Run the fresh filter at ``b`` through the past, as often as it measures; return whether there was any.

    The voltage since the last entry that counts, that of this tick too, is left gathered at ``drive``.
    """
    every = int(p[at + EVERY])
    begun = False
    place = s[b + P11]
    s[drive + BEGUN] = 0.0
    for back in range(KEPT // every * every, 0, -1):
        entry = io[past] + int(w[TICK] - back) % KEPT * ENTRY
        follow(p, at + TICK_MODEL, s, drive, w[entry + APPLIED], w[entry + MIDDLE], w[entry + END])
        if back % every != 0:
            continue
        if begun:
            predict(p, at, s, b, drive)
        s[drive + BEGUN] = 0.0
        if w[entry + VARIANCE] > 0.0:
            if not begun:
                begun = True
                s[b + X] = w[entry + MEASURED]
                s[b + P22] *= SPEED
            correct(s, b, w[entry + MEASURED] - s[b + X], 1.0, w[entry + VARIANCE])
    follow(p, at + TICK_MODEL, s, drive, w[io[applied]], w[io[applied + 1]], w[io[applied + 2]])
    if begun:
        # whatever the past says, another sensor may be off by as much as before
        s[b + P11] += place
    return begun
