"""Measurements and voltages of the last samples, from which a filter that begins catches up."""

from __future__ import annotations

from core.kernel import kernel
from core.ports import reads
from core.record import Record, Records
from core.sense.tracker import Filter, Tracked, correct, predict
from core.voltage import AppliedPorts, Gathered, gather


class Entry(Record):
    """Measurement at a tick, and the voltage before it; a variance of 0 marks a tick without a measurement."""

    measured: float
    applied: float
    middle: float
    end: float
    variance: float


KEPT = 32
"""Number of entries: the noise of the speed falls with its power 3/2. A unit that runs more rarely finds no entry."""
SPEED = 100.0
"""Variance of the speed that a new filter assumes in motion, over its variance without motion: it covers the stroke at
resonance."""

PAST_PORT = reads("sensor.past", "mixed", "measurements of the last samples, to begin from")


@kernel
def note(past: Records[Entry], x: AppliedPorts, measured: float, variance: float) -> None:
    """Write the measurement of this tick, and the voltage before it, over the oldest entry."""
    entry = past[int(x.tick) % KEPT]
    entry.measured = measured
    entry.applied = x.applied
    entry.middle = x.middle
    entry.end = x.end
    entry.variance = variance


@kernel
def catch_up(p: Tracked, s: Filter, drive: Gathered, past: Records[Entry], x: AppliedPorts) -> bool:
    """Run a new filter through the past at its own measurement interval; return whether there were any entries.

    The voltage since the last entry used, including this tick, stays gathered.
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
        # the past does not reduce the error that another sensor may have
        s.p11 += place
    return begun
