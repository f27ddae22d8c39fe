"""The rings of a history and the pyramid over them: how ticks are added, from rows or from the signals of a board."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import FloatArray, IntArray
from core.kernel import kernel

FACTOR = 16
"""Ticks under a bucket of the first level, and buckets under a bucket of the next."""
LEVELS = 3
WIDEST = 4096
"""Ticks under a bucket of the last level, FACTOR ** LEVELS."""
LANES = 32
"""Signals side by side in memory: a tick of them is written, and two of them compared, by a few vector instructions."""


@kernel
def _copy(source: Any, target: Any) -> None:
    """Copy doubles to single precision."""
    for k in range(source.shape[0]):
        target[k] = np.float32(source[k])


@kernel
def _least(a: Any, b: Any, out: Any) -> None:
    """Take the smaller of two arrays, place by place."""
    for k in range(out.shape[0]):
        out[k] = a[k] if a[k] < b[k] else b[k]


@kernel
def _most(a: Any, b: Any, out: Any) -> None:
    """Take the larger of two arrays, place by place."""
    for k in range(out.shape[0]):
        out[k] = a[k] if a[k] > b[k] else b[k]


@kernel
def _write(ring: Any, place: int, rows: FloatArray, first: int) -> None:
    """Write columns of the rows, from ``first`` on, into the ring of a group."""
    places = ring.shape[0] // LANES
    width = min(LANES, rows.shape[1] - first)
    for i in range(rows.shape[0]):
        _copy(rows[i, first : first + width], ring[place * LANES : place * LANES + width])
        place = place + 1 if place + 1 < places else 0


@kernel
def _fold_bucket(ticks: Any, lowest: Any, highest: Any) -> None:
    """Fold the ticks of a bucket of the first level: the first half with the second, until one tick is left."""
    least, most = np.empty(FACTOR // 2, dtype=np.float32), np.empty(FACTOR // 2, dtype=np.float32)
    for c in range(LANES):
        for k in range(FACTOR // 2):
            a, b = ticks[k * LANES + c], ticks[(k + FACTOR // 2) * LANES + c]
            least[k] = a if a < b else b
            most[k] = a if a > b else b
        for k in range(FACTOR // 4):
            least[k] = least[k] if least[k] < least[k + FACTOR // 4] else least[k + FACTOR // 4]
            most[k] = most[k] if most[k] > most[k + FACTOR // 4] else most[k + FACTOR // 4]
        for k in range(FACTOR // 8):
            least[k] = least[k] if least[k] < least[k + FACTOR // 8] else least[k + FACTOR // 8]
            most[k] = most[k] if most[k] > most[k + FACTOR // 8] else most[k + FACTOR // 8]
        lowest[c] = least[0] if least[0] < least[1] else least[1]
        highest[c] = most[0] if most[0] > most[1] else most[1]


@kernel
def fold_ticks(ring: Any, low: Any, high: Any, buckets: int, first: int, end: int) -> None:
    """Fold ticks into the buckets of the first level; every touched bucket is folded again from its start."""
    places = ring.shape[0] // LANES
    for bucket in range(first // FACTOR, (end - 1) // FACTOR + 1):
        begin = bucket * FACTOR % places * LANES
        at = bucket % buckets * LANES
        lowest, highest = low[at : at + LANES], high[at : at + LANES]
        if end >= (bucket + 1) * FACTOR:
            _fold_bucket(ring[begin : begin + FACTOR * LANES], lowest, highest)
        else:
            lowest[:] = ring[begin : begin + LANES]
            highest[:] = lowest
            for place in range(begin + LANES, begin + (end - bucket * FACTOR) * LANES, LANES):
                tick = ring[place : place + LANES]
                _least(lowest, tick, lowest)
                _most(highest, tick, highest)


@kernel
def _widen(low: Any, high: Any, begin: int, inner: int, lowest: Any, highest: Any) -> None:
    """Fold the first buckets under a bucket of the next level, one by one."""
    least, most = np.empty(LANES, dtype=np.float32), np.empty(LANES, dtype=np.float32)
    for c in range(LANES):
        a, b = low[begin + c], high[begin + c]
        for k in range(1, FACTOR):
            # the last of them again and again: so the rounds are as many as ever, and need no loop
            at = begin + min(k, inner - 1) * LANES + c
            a = a if a < low[at] else low[at]
            b = b if b > high[at] else high[at]
        least[c], most[c] = a, b
    lowest[:] = least
    highest[:] = most


@kernel
def fold_buckets(low: Any, high: Any, offsets: IntArray, sizes: IntArray, first: int, end: int) -> None:
    """Fold the buckets of each level into the buckets of the next."""
    span = FACTOR
    for level in range(1, LEVELS):
        for bucket in range(first // (span * FACTOR), (end - 1) // (span * FACTOR) + 1):
            begin = (offsets[level - 1] + bucket * FACTOR % sizes[level - 1]) * LANES
            at = (offsets[level] + bucket % sizes[level]) * LANES
            inner = min(FACTOR, (end - 1) // span - bucket * FACTOR + 1)
            _widen(low, high, begin, inner, low[at : at + LANES], high[at : at + LANES])
        span *= FACTOR


@kernel
def rest(idle: Any, first: int, steady: IntArray, places: int, still: Any, resting: Any) -> None:
    """Note which groups, from the first on, are idle for the next ticks, and which of them hold zeros throughout.

    Nothing is written into these: memory that is never written costs nothing.
    """
    group = first
    for start in range(0, idle.shape[0], LANES):
        is_still = True
        for c in range(start, min(start + LANES, idle.shape[0])):
            is_still &= idle[c]
        still[group] = is_still
        resting[group] = is_still and steady[group] >= places
        group += 1


@kernel
def rested(steady: IntArray, still: Any, resting: Any, count: int) -> None:
    """Count the ticks in a row that each group has been idle."""
    for group in range(steady.shape[0]):
        if not resting[group]:
            steady[group] = steady[group] + count if still[group] else 0


@kernel
def append(
    ring: Any,
    low: Any,
    high: Any,
    offsets: IntArray,
    sizes: IntArray,
    resting: Any,
    first: int,
    rows: FloatArray,
    group: int,
) -> None:
    """Write rows (ticks by signals) into the rings, from a group on, and fold them into the pyramid."""
    count, signals = rows.shape
    places = ring.shape[1] // LANES
    for start in range(0, signals, LANES):
        if not resting[group]:
            _write(ring[group], first % places, rows, start)
            fold_ticks(ring[group], low[group], high[group], sizes[0], first, first + count)
            fold_buckets(low[group], high[group], offsets, sizes, first, first + count)
        group += 1


@kernel
def keep(ring: Any, place: int, signals: FloatArray, resting: Any, group: int) -> None:
    """Write a tick of signals into a place of the rings, from a group on."""
    count = signals.shape[0]
    at = place * LANES
    for start in range(0, count, LANES):
        if not resting[group]:
            width = min(LANES, count - start)
            _copy(signals[start : start + width], ring[group, at : at + width])
        group += 1
