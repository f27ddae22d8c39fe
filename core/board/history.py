"""History: every signal at full rate in a ring, with a pyramid of minima and maxima over it."""

from __future__ import annotations

import mmap
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray, IntArray
from core.board.rows import Rows
from core.kernel import kernel

Float32Array = NDArray[np.float32]
FACTOR = 16
"""Ticks under a bucket of the first level, and buckets under a bucket of the next."""
LEVELS = 3
WIDEST = 4096
"""Ticks under a bucket of the last level, FACTOR ** LEVELS."""
LANES = 32
"""Signals side by side in memory: a tick of them is written, and two of them compared, by a few vector instructions."""
HALF = FACTOR * LANES // 2
"""Numbers of half a bucket of the first level."""


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
def _fold_ticks(ring: Any, low: Any, high: Any, buckets: int, first: int, end: int) -> None:
    """Fold ticks into the buckets of the first level; every touched bucket is folded again from its start."""
    places = ring.shape[0] // LANES
    least, most = np.empty(HALF, dtype=np.float32), np.empty(HALF, dtype=np.float32)
    for bucket in range(first // FACTOR, (end - 1) // FACTOR + 1):
        begin = bucket * FACTOR % places * LANES
        at = bucket % buckets * LANES
        lowest, highest = low[at : at + LANES], high[at : at + LANES]
        if end >= (bucket + 1) * FACTOR:
            size = HALF
            earlier, later = ring[begin : begin + size], ring[begin + size : begin + 2 * size]
            _least(earlier, later, least)
            _most(earlier, later, most)
            while size > 2 * LANES:
                size //= 2
                _least(least[:size], least[size : 2 * size], least[:size])
                _most(most[:size], most[size : 2 * size], most[:size])
            _least(least[:LANES], least[LANES : 2 * LANES], lowest)
            _most(most[:LANES], most[LANES : 2 * LANES], highest)
        else:
            lowest[:] = ring[begin : begin + LANES]
            highest[:] = lowest
            for place in range(begin + LANES, begin + (end - bucket * FACTOR) * LANES, LANES):
                tick = ring[place : place + LANES]
                _least(lowest, tick, lowest)
                _most(highest, tick, highest)


@kernel
def _fold_buckets(low: Any, high: Any, offsets: IntArray, sizes: IntArray, first: int, end: int) -> None:
    """Fold the buckets of each level into the buckets of the next."""
    span = FACTOR
    for level in range(1, LEVELS):
        for bucket in range(first // (span * FACTOR), (end - 1) // (span * FACTOR) + 1):
            begin = (offsets[level - 1] + bucket * FACTOR % sizes[level - 1]) * LANES
            at = (offsets[level] + bucket % sizes[level]) * LANES
            inner = min(FACTOR, (end - 1) // span - bucket * FACTOR + 1)
            lowest, highest = low[at : at + LANES], high[at : at + LANES]
            lowest[:] = low[begin : begin + LANES]
            highest[:] = high[begin : begin + LANES]
            for place in range(begin + LANES, begin + inner * LANES, LANES):
                _least(lowest, low[place : place + LANES], lowest)
                _most(highest, high[place : place + LANES], highest)
        span *= FACTOR


@kernel
def _append(
    ring: Any,
    low: Any,
    high: Any,
    offsets: IntArray,
    sizes: IntArray,
    steady: IntArray,
    first: int,
    rows: FloatArray,
    idle: Any,
    group: int,
) -> None:
    """Write rows (ticks by signals) into the rings, from a group on, and fold them into the pyramid.

    A group that has been idle for the length of the ring holds zeros already: memory that is never written costs
    nothing.
    """
    count, signals = rows.shape
    places = ring.shape[1] // LANES
    for start in range(0, signals, LANES):
        rests = True
        for c in range(start, min(start + LANES, signals)):
            rests &= idle[c]
        if not rests or steady[group] < places:
            steady[group] = steady[group] + count if rests else 0
            _write(ring[group], first % places, rows, start)
            _fold_ticks(ring[group], low[group], high[group], sizes[0], first, first + count)
            _fold_buckets(low[group], high[group], offsets, sizes, first, first + count)
        group += 1


@kernel
def _copy_run(to: Any, places: int, of: Any, others: int, first: int, end: int) -> None:
    """Copy places of a ring to another of another length, from ``first`` to ``end`` as both count."""
    at = first
    while at < end:
        count = min(end - at, places - at % places, others - at % others)
        start, begin = at % places * LANES, at % others * LANES
        to[start : start + count * LANES] = of[begin : begin + count * LANES]
        at += count


@kernel
def _adopt(
    ring: Any,
    low: Any,
    high: Any,
    offsets: IntArray,
    sizes: IntArray,
    steady: IntArray,
    of: Any,
    of_low: Any,
    of_high: Any,
    of_offsets: IntArray,
    of_sizes: IntArray,
    of_steady: IntArray,
    first: int,
    end: int,
) -> None:
    """Copy ticks of other rings and the buckets over them; groups that are idle in both hold zeros already.

    The first and last bucket of a level may cover ticks that are not copied. Readers use only buckets whose ticks are
    all kept, and the next append folds the last bucket anew.
    """
    places, others = ring.shape[1] // LANES, of.shape[1] // LANES
    for group in range(ring.shape[0]):
        if steady[group] >= places and of_steady[group] >= others:
            continue
        steady[group] = 0
        _copy_run(ring[group], places, of[group], others, first, end)
        span = FACTOR
        for level in range(LEVELS):
            size, of_size = sizes[level], of_sizes[level]
            at, of_at = offsets[level] * LANES, of_offsets[level] * LANES
            begin, stop = first // span, (end - 1) // span + 1
            to, other = low[group, at : at + size * LANES], of_low[group, of_at : of_at + of_size * LANES]
            _copy_run(to, size, other, of_size, begin, stop)
            to, other = high[group, at : at + size * LANES], of_high[group, of_at : of_at + of_size * LANES]
            _copy_run(to, size, other, of_size, begin, stop)
            span *= FACTOR


@kernel
def _columns(
    ring: Any,
    low: Any,
    high: Any,
    offsets: IntArray,
    sizes: IntArray,
    groups: IntArray,
    lanes: IntArray,
    first: int,
    end: int,
    start: int,
    stop: int,
    out: Any,
) -> None:
    """Fill minima and maxima of each column from the widest buckets that fit."""
    columns = out.shape[2]
    places = ring.shape[1] // LANES
    for c in range(columns):
        a = max(start + (stop - start) * c // columns, first)
        b = min(max(start + (stop - start) * (c + 1) // columns, start + (stop - start) * c // columns + 1), end)
        for k in range(groups.shape[0]):
            group, lane = groups[k], lanes[k]
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
                    value = ring[group, tick % places * LANES + lane]
                    least = min(least, value)
                    most = max(most, value)
                else:
                    bucket = (offsets[level] + (tick // span) % sizes[level]) * LANES + lane
                    least = min(least, low[group, bucket])
                    most = max(most, high[group, bucket])
                tick += span
            if least > most:
                least = np.float32(np.nan)
                most = np.float32(np.nan)
            out[k, 0, c] = least
            out[k, 1, c] = most


@kernel
def _crossing(
    ring: Any, group: int, lane: int, sign: float, level: float, hysteresis: float, start: int, stop: int
) -> int:
    """Return the last tick at which the signal crosses the level, having been beyond the hysteresis; -1 for none."""
    places = ring.shape[1] // LANES
    armed = False
    found = -1
    for tick in range(start, stop):
        value = sign * (ring[group, tick % places * LANES + lane] - level)
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
    outputs, taps : int
        Number of signals of each kind.
    capacity : int
        Ticks kept at least; one of the widest buckets more is held, because it is overwritten whole.
    """

    def __init__(self, outputs: int, taps: int, capacity: int = 200_000) -> None:
        self.capacity = (-(-capacity // WIDEST) + 1) * WIDEST
        self._sizes = np.array([self.capacity // FACTOR ** (level + 1) for level in range(LEVELS)], dtype=np.int64)
        self._offsets = np.concatenate([[0], np.cumsum(self._sizes)[:-1]]).astype(np.int64)
        self._taps_at = -(-outputs // LANES)
        groups = self._taps_at + -(-taps // LANES)
        places = [(signal // LANES, signal % LANES) for signal in range(outputs)]
        places += [(self._taps_at + signal // LANES, signal % LANES) for signal in range(taps)]
        self._places = np.array(places, dtype=np.int64).reshape(-1, 2)
        self._ring = _untouched(groups, self.capacity * LANES)
        self._low = _untouched(groups, int(self._sizes.sum()) * LANES)
        self._high = _untouched(groups, int(self._sizes.sum()) * LANES)
        # ticks in a row each group has been idle; memory starts as zeros throughout
        self._steady = np.full(groups, self.capacity, dtype=np.int64)
        self._never = np.zeros(outputs, dtype=np.bool_)
        self._written = 0
        self._begin = 0
        self.end_tick = 0

    @staticmethod
    def ticks_within(megabytes: float, outputs: int, taps: int) -> int:
        """Return how many ticks of so many signals fit into so much memory."""
        lanes = (-(-outputs // LANES) + -(-taps // LANES)) * LANES
        pyramid = 2.0 * sum(FACTOR ** -(level + 1) for level in range(LEVELS))
        return max(WIDEST, int(megabytes * 1e6 / (4.0 * lanes * (1.0 + pyramid))) - WIDEST)

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
        if rows.first_tick != self._written:  # a jump: only groups idle for a whole ring are known to be steady
            self._steady[self._steady < self.capacity] = 0
        args = (self._ring, self._low, self._high, self._offsets, self._sizes, self._steady, rows.first_tick)
        _append(*args, rows.outputs, self._never, 0)
        _append(*args, rows.taps, rows.idle, self._taps_at)
        self.end_tick = self._written = rows.first_tick + rows.count

    def adopt(self, other: History, start: int, stop: int) -> None:
        """Begin an empty history with ticks that another of the same signals keeps; more ticks may be appended."""
        start = max(start, other.first_tick)
        if start >= stop:
            return
        to, of = [(one._ring, one._low, one._high, one._offsets, one._sizes, one._steady) for one in (self, other)]
        _adopt(*to, *of, start, stop)
        self._begin, self.end_tick, self._written = start, stop, stop

    def columns(self, signals: list[int], start: int, stop: int, columns: int) -> Float32Array:
        """Return minima and maxima, shape (signals, 2, columns); NaN where there is no data."""
        out = np.empty((len(signals), 2, columns), dtype=np.float32)
        _columns(
            self._ring,
            self._low,
            self._high,
            self._offsets,
            self._sizes,
            *self._at(signals),
            self.first_tick,
            self.end_tick,
            start,
            stop,
            out,
        )
        return out

    def read(self, signals: list[int], start: int, stop: int) -> Float32Array:
        """Return full-rate values, shape (signals, ticks); the span is cut to the ticks kept."""
        start, stop = max(start, self.first_tick), min(stop, self.end_tick)
        ticks = np.arange(start, max(stop, start)) % self.capacity
        groups, lanes = self._at(signals)
        found: Float32Array = self._ring[groups[:, None], ticks * LANES + lanes[:, None]]
        return found

    def _at(self, signals: list[int]) -> tuple[IntArray, IntArray]:
        """Return group and lane of signals."""
        places = self._places[signals]
        return np.ascontiguousarray(places[:, 0]), np.ascontiguousarray(places[:, 1])

    def crossing(self, signal: int, edge: str, level: float, hysteresis: float, start: int, stop: int) -> int | None:
        """Return the last tick in the span at which the signal crosses ``level`` on the rising or falling edge."""
        start, stop = max(start, self.first_tick), min(stop, self.end_tick)
        group, lane = self._places[signal]
        found = _crossing(self._ring, group, lane, 1.0 if edge == "rising" else -1.0, level, hysteresis, start, stop)
        return int(found) if found >= 0 else None
