"""History: every signal at full rate in a ring, with a pyramid of minima and maxima over it."""

from __future__ import annotations

import mmap
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray, IntArray, kernel
from core.board.board import Rows

Float32Array = NDArray[np.float32]
FACTOR = 16
"""Ticks under a bucket of the first level, and buckets under a bucket of the next."""
LEVELS = 3
TILE = 64
"""Ticks written at a time."""
WIDEST = 4096
"""Ticks under a bucket of the last level, FACTOR ** LEVELS."""


@kernel
def _write(ring: Any, signal: int, place: int, rows: FloatArray, c: int, start: int, stop: int) -> None:
    """Write a column of the rows into the ring of a signal."""
    capacity = ring.shape[1]
    first = min(stop - start, capacity - place)
    for i in range(first):
        ring[signal, place + i] = np.float32(rows[start + i, c])
    for i in range(first, stop - start):
        ring[signal, place + i - capacity] = np.float32(rows[start + i, c])


@kernel
def _fold(
    ring: Any, low: Any, high: Any, offsets: IntArray, sizes: IntArray, signal: int, first: int, end: int
) -> None:
    """Fold the ticks of a span into the pyramid.

    Every touched bucket is folded again from its start; the capacity is a multiple of the widest bucket.
    """
    capacity = ring.shape[1]
    for bucket in range(first // FACTOR, (end - 1) // FACTOR + 1):
        begin = bucket * FACTOR % capacity
        inner = min(FACTOR, end - bucket * FACTOR)
        # two at a time: each comparison waits for the one before
        least = most = ring[signal, begin]
        least_too = most_too = ring[signal, begin + inner - 1]
        for place in range(begin + 1, begin + inner - 1, 2):
            value, other = ring[signal, place], ring[signal, place + 1]
            least = value if value < least else least
            most = value if value > most else most
            least_too = other if other < least_too else least_too
            most_too = other if other > most_too else most_too
        low[signal, bucket % sizes[0]] = min(least, least_too)
        high[signal, bucket % sizes[0]] = max(most, most_too)
    span = FACTOR
    for level in range(1, LEVELS):
        for bucket in range(first // (span * FACTOR), (end - 1) // (span * FACTOR) + 1):
            begin = offsets[level - 1] + bucket * FACTOR % sizes[level - 1]
            least = low[signal, begin]
            most = high[signal, begin]
            inner = min(FACTOR, (end - 1) // span - bucket * FACTOR + 1)
            for place in range(begin + 1, begin + inner):
                least = min(least, low[signal, place])
                most = max(most, high[signal, place])
            low[signal, offsets[level] + bucket % sizes[level]] = least
            high[signal, offsets[level] + bucket % sizes[level]] = most
        span *= FACTOR


@kernel
def _append(
    ring: Any,
    low: Any,
    high: Any,
    offsets: IntArray,
    sizes: IntArray,
    steady: IntArray,
    last: Any,
    first: int,
    rows: FloatArray,
    at: int,
) -> None:
    """Write rows (ticks by signals) into the rings of some signals and fold them into the pyramid.

    Signals are columns of the rows and rows of the ring, so tiles that fit a near cache are written at a time. What
    has not changed for as long as the ring is long stands there already: memory nobody wrote to costs nothing, and
    most faults stay at zero.
    """
    capacity = ring.shape[1]
    count, signals = rows.shape
    moved = np.zeros(signals, dtype=np.bool_)
    changed = np.zeros(signals, dtype=np.bool_)
    for start in range(0, count, TILE):
        stop = min(start + TILE, count)
        place = (first + start) % capacity
        changed[:] = False
        for i in range(start, stop):
            for c in range(signals):
                changed[c] |= rows[i, c] != last[at + c]
        for c in range(signals):
            signal = at + c
            if not changed[c] and steady[signal] >= capacity:
                continue
            steady[signal] = 0 if changed[c] else steady[signal] + stop - start
            last[signal] = rows[stop - 1, c]
            moved[c] = True
            _write(ring, signal, place, rows, c, start, stop)
    for c in range(signals):
        if moved[c]:
            _fold(ring, low, high, offsets, sizes, at + c, first, first + count)


@kernel
def _columns(
    ring: Any,
    low: Any,
    high: Any,
    offsets: IntArray,
    sizes: IntArray,
    signals: IntArray,
    first: int,
    end: int,
    start: int,
    stop: int,
    out: Any,
) -> None:
    """Fill minima and maxima of each column from the widest buckets that fit."""
    columns = out.shape[2]
    capacity = ring.shape[1]
    for c in range(columns):
        a = max(start + (stop - start) * c // columns, first)
        b = min(max(start + (stop - start) * (c + 1) // columns, start + (stop - start) * c // columns + 1), end)
        for k in range(signals.shape[0]):
            signal = signals[k]
            least = np.float32(np.inf)
            most = np.float32(-np.inf)
            tick = a
            while tick < b:
                level = -1
                span = 1
                wider = FACTOR
                while level + 1 < LEVELS and tick % wider == 0 and tick + wider <= b:
                    level += 1
                    span = wider
                    wider *= FACTOR
                if level < 0:
                    value = ring[signal, tick % capacity]
                    least = min(least, value)
                    most = max(most, value)
                else:
                    bucket = offsets[level] + (tick // span) % sizes[level]
                    least = min(least, low[signal, bucket])
                    most = max(most, high[signal, bucket])
                tick += span
            if least > most:
                least = np.float32(np.nan)
                most = np.float32(np.nan)
            out[k, 0, c] = least
            out[k, 1, c] = most


@kernel
def _crossing(ring: Any, signal: int, sign: float, level: float, hysteresis: float, start: int, stop: int) -> int:
    """Return the last tick at which the signal crosses the level, having been beyond the hysteresis; -1 for none."""
    capacity = ring.shape[1]
    armed = False
    found = -1
    for tick in range(start, stop):
        value = sign * (ring[signal, tick % capacity] - level)
        if value < -hysteresis or (hysteresis == 0.0 and value < 0.0):
            armed = True
        elif value >= 0.0 and armed:
            found = tick
            armed = False
    return int(found)


def _untouched(rows: int, columns: int) -> Float32Array:
    """Return zeros that take memory page by page as they are written; numpy's own ask for huge pages."""
    size = max(1, rows * columns)
    return np.frombuffer(mmap.mmap(-1, 4 * size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS), dtype=np.float32)[
        : rows * columns
    ].reshape(rows, columns)


class History:
    """The last ticks of every signal.

    Parameters
    ----------
    signals : int
        Number of signals.
    capacity : int
        Ticks kept at least; one of the widest buckets more is held, because it is overwritten whole.
    """

    def __init__(self, signals: int, capacity: int = 200_000) -> None:
        self.capacity = (-(-capacity // WIDEST) + 1) * WIDEST
        self._sizes = np.array([self.capacity // FACTOR ** (level + 1) for level in range(LEVELS)], dtype=np.int64)
        self._offsets = np.concatenate([[0], np.cumsum(self._sizes)[:-1]]).astype(np.int64)
        self._ring = _untouched(signals, self.capacity)
        self._low = _untouched(signals, int(self._sizes.sum()))
        self._high = _untouched(signals, int(self._sizes.sum()))
        # ticks in a row each signal has been at its last value; memory starts as zeros throughout
        self._steady = np.full(signals, self.capacity, dtype=np.int64)
        self._last = np.zeros(signals)
        self._written = 0
        self._begin = 0
        self.end_tick = 0

    @property
    def first_tick(self) -> int:
        """Oldest tick kept; one bucket short of the capacity, because the widest bucket is overwritten whole."""
        return max(self._begin, self.end_tick - self.capacity + WIDEST)

    @property
    def nbytes(self) -> int:
        """Memory of the rings."""
        return int(self._ring.nbytes + self._low.nbytes + self._high.nbytes)

    def append(self, rows: Rows) -> None:
        """Add ticks that follow the last; ticks that do not start a new history there."""
        if rows.first_tick != self.end_tick:
            self._begin = self.end_tick = rows.first_tick
        if rows.first_tick != self._written:  # a jump: only what fills the ring is known to be steady
            self._steady[self._steady < self.capacity] = 0
        outputs = rows.outputs.shape[1]
        args = (
            self._ring,
            self._low,
            self._high,
            self._offsets,
            self._sizes,
            self._steady,
            self._last,
            rows.first_tick,
        )
        _append(*args, rows.outputs, 0)
        _append(*args, rows.taps, outputs)
        self.end_tick = self._written = rows.first_tick + rows.count

    def columns(self, signals: list[int], start: int, stop: int, columns: int) -> Float32Array:
        """Return minima and maxima, shape (signals, 2, columns); NaN where there is no data."""
        out = np.empty((len(signals), 2, columns), dtype=np.float32)
        _columns(
            self._ring,
            self._low,
            self._high,
            self._offsets,
            self._sizes,
            np.array(signals, dtype=np.int64),
            self.first_tick,
            self.end_tick,
            start,
            stop,
            out,
        )
        return out

    def read(self, signals: list[int], start: int, stop: int) -> Float32Array:
        """Return full-rate values, shape (signals, ticks); the span is cut to what is kept."""
        start, stop = max(start, self.first_tick), min(stop, self.end_tick)
        ticks = np.arange(start, max(stop, start)) % self.capacity
        return self._ring[np.array(signals, dtype=np.int64)[:, None], ticks]

    def crossing(self, signal: int, edge: str, level: float, hysteresis: float, start: int, stop: int) -> int | None:
        """Return the last tick in the span at which the signal crosses ``level`` on the rising or falling edge."""
        start, stop = max(start, self.first_tick), min(stop, self.end_tick)
        found = _crossing(self._ring, signal, 1.0 if edge == "rising" else -1.0, level, hysteresis, start, stop)
        return int(found) if found >= 0 else None
