"""Ticks that go from the signals of a board into its history while they are at hand, without rows between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from core.block import FloatArray, IntArray
from core.board.fold import Words, fold
from core.board.history import Float32Array, History
from core.board.program import DONE, TRIPPED, WATCHED, walk
from core.board.pyramid import FACTOR, LANES, fold_buckets, fold_ticks, keep
from core.board.rows import Rows
from core.compile.instructions import address_of
from core.kernel import kernel
from core.ports import RESERVED, TICK, TIME_MS

CHANGED = 3
"""Why the loop returned, besides the reasons of ``program.run``: a column that the observer follows has changed."""


@kernel
def run(
    n: int,
    first_tick: int,
    dt_ms: float,
    table: IntArray,
    p: FloatArray,
    s: FloatArray,
    w: FloatArray,
    io: IntArray,
    taps: int,
    folds: Words,
    trip: int,
    watches: FloatArray,
    columns: IntArray,
    last: FloatArray,
    ring: Any,
    low: Any,
    high: Any,
    offsets: IntArray,
    sizes: IntArray,
    resting: Any,
) -> tuple[int, int]:
    """Run up to ``n`` ticks as ``program.run`` does, into the rings of a history; return how many, and why it stopped.

    It stops behind a tick at which one of the columns differs from its last number; numbers that are NaN do not differ.
    """
    groups, places, outputs = ring.shape[0], ring.shape[1] // LANES, folds.shape[1]
    taps_at = (outputs + LANES - 1) // LANES
    bits = w.view(np.uint64)[RESERVED:]
    arrays = address_of(p), address_of(s), address_of(w), address_of(io)
    place, folded, ran, why = first_tick % places, first_tick, 0, DONE
    while ran < n and why == DONE:
        tick = first_tick + ran
        w[TICK] = tick
        w[TIME_MS] = tick * dt_ms
        walk(table, tick, 1, arrays[0], arrays[1], arrays[2], arrays[3])
        fold(folds, bits)
        keep(ring, place, w[RESERVED : RESERVED + outputs], resting, 0)
        keep(ring, place, w[RESERVED + outputs : RESERVED + outputs + taps], resting, taps_at)
        place = place + 1 if place + 1 < places else 0
        ran += 1
        if (tick + 1) % FACTOR == 0:
            for group in range(groups):
                if not resting[group]:
                    fold_ticks(ring[group], low[group], high[group], sizes[0], folded, tick + 1)
            folded = tick + 1
        for k in range(len(columns)):
            value = w[RESERVED + columns[k]]
            if value != last[k] and (value == value or last[k] == last[k]):
                why = CHANGED
        for c in range(watches.shape[0]):
            if watches[c, 1] * (w[int(watches[c, 0])] - watches[c, 2]) > 0.0:
                why = WATCHED
        if w[trip] != 0.0:
            why = TRIPPED
    for group in range(groups):
        if not resting[group]:
            if folded < first_tick + ran:
                fold_ticks(ring[group], low[group], high[group], sizes[0], folded, first_tick + ran)
            fold_buckets(low[group], high[group], offsets, sizes, first_tick, first_tick + ran)
    return ran, why


@dataclass(frozen=True)
class KeptTicks:
    """Ticks that were run, as a history has them."""

    first_tick: int
    count: int
    history: History

    def singles(self, columns: IntArray, first: int, end: int) -> Float32Array:
        """Return signals from a tick to before another of these, in single precision, shape (signals, ticks)."""
        return self.history.read(columns, self.first_tick + first, self.first_tick + end)


Ticks = Rows | KeptTicks
"""Ticks that were run: with their rows, or in a history."""
