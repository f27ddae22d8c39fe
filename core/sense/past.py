"""The past: what was measured over the last samples, under which voltages; a filter that begins catches up with it."""

from __future__ import annotations

from core.kernel import kernel
from core.ports import reads
from core.record import Record, Records
from core.sense.tracker import Filter, Tracked, correct, predict
from core.voltage import AppliedPorts, Gathered, gather


class Entry(Record):
    """What was measured at a tick, the voltage before it; a variance of 0 says that nothing was measured."""

    measured: float
    applied: float
    middle: float
    end: float
    variance: float


KEPT = 32
"""Entries kept: noise of the speed falls with the power 3/2 of it. A unit that runs more rarely finds none."""
SPEED = 100.0
"""Variance of the speed a fresh filter assumes in motion, over that at rest: up to the stroke at resonance."""

PAST_PORT = reads("sensor.past", "mixed", "what was measured over the last samples, to begin from")


@kernel
def note(past: Records[Entry], x: AppliedPorts, measured: float, variance: float) -> None:
    """Write what was measured at this tick, and the voltage before it, over the oldest entry."""
    entry = past[int(x.tick) % KEPT]
    entry.measured = measured
    entry.applied = x.applied
    entry.middle = x.middle
    entry.end = x.end
    entry.variance = variance


@kernel
def catch_up(p: Tracked, s: Filter, drive: Gathered, past: Records[Entry], x: AppliedPorts) -> bool:
    """Run a fresh filter through the past, as often as it measures; return whether there was any.

    The voltage since the last entry that counts, that of this tick too, is left gathered.
    """
    every = int(p.every)
    begun = False
    place = s.p11
    drive.begun = 0.0
    for back in range(KEPT // every * every, 0, -1):
        entry = past[int(x.tick - back) % KEPT]
        gather(p.tick, drive, entry.applied, entry.middle, entry.end)
        if back % every != 0:
            continue
        if begun:
            predict(p, s, drive)
        drive.begun = 0.0
        if entry.variance > 0.0:
            if not begun:
                begun = True
                s.x = entry.measured
                s.p22 *= SPEED
            correct(s, entry.measured - s.x, 1.0, entry.variance)
    gather(p.tick, drive, x.applied, x.middle, x.end)
    if begun:
        # whatever the past says, another sensor may be off by as much as before
        s.p11 += place
    return begun
