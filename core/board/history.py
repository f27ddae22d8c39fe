"""History: every signal at full rate in a ring, with a pyramid of minima and maxima over it."""

from __future__ import annotations

import mmap
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import BoolArray, IntArray
from core.board.pyramid import FACTOR, LANES, LEVELS, WIDEST, append, rest, rested
from core.board.rows import Rows
from core.kernel import kernel

Float32Array = NDArray[np.float32]


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
def cut(
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


@kernel
def _read(ring: Any, groups: IntArray, lanes: IntArray, first: int, out: Any) -> None:
    """Copy ticks of signals, from the first on."""
    places = ring.shape[1] // LANES
    for k in range(out.shape[0]):
        group, at = groups[k], first % places * LANES + lanes[k]
        for i in range(out.shape[1]):
            out[k, i] = ring[group, at]
            at = at + LANES if at + LANES < places * LANES else lanes[k]


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
        self._groups, self._lanes = np.array(places, dtype=np.int64).reshape(-1, 2).T.copy()
        self._ring = _untouched(groups, self.capacity * LANES)
        self._low = _untouched(groups, int(self._sizes.sum()) * LANES)
        self._high = _untouched(groups, int(self._sizes.sum()) * LANES)
        # ticks in a row each group has been idle; memory starts as zeros throughout
        self._steady = np.full(groups, self.capacity, dtype=np.int64)
        self._still, self._resting = np.zeros((2, groups), dtype=np.bool_)
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

    @property
    def rings(self) -> tuple[Float32Array, Float32Array, Float32Array, IntArray, IntArray]:
        """The samples, the minima and the maxima of each group, and where each level begins and how long it is."""
        return self._ring, self._low, self._high, self._offsets, self._sizes

    def append(self, rows: Rows) -> None:
        """Add ticks that follow the last; ticks that do not start a new history there."""
        resting = self.begin(rows.first_tick, rows.idle)
        for part, group in ((rows.outputs, 0), (rows.taps, self._taps_at)):
            append(*self.rings, resting, rows.first_tick, part, group)
        self.end(rows.count)

    def begin(self, tick: int, idle: BoolArray) -> BoolArray:
        """Prepare to add ticks in which some taps stay 0; return which groups stay as they are."""
        if tick != self.end_tick:
            self._begin = self.end_tick = tick
        if tick != self._written:  # a jump: only groups idle for a whole ring are known to be steady
            self._steady[self._steady < self.capacity] = 0
        rest(idle, self._taps_at, self._steady, self.capacity, self._still, self._resting)
        return self._resting

    def end(self, count: int) -> None:
        """Note how many ticks were added."""
        rested(self._steady, self._still, self._resting, count)
        self.end_tick = self._written = self.end_tick + count

    def adopt(self, other: History, start: int, stop: int) -> None:
        """Begin an empty history with ticks that another of the same signals keeps; more ticks may be appended."""
        start = max(start, other.first_tick)
        if start >= stop:
            return
        _adopt(*self.rings, self._steady, *other.rings, other._steady, start, stop)
        self._begin, self.end_tick, self._written = start, stop, stop

    def columns(self, signals: list[int], start: int, stop: int, columns: int) -> Float32Array:
        """Return minima and maxima, shape (signals, 2, columns); NaN where there is no data."""
        out = np.empty((len(signals), 2, columns), dtype=np.float32)
        cut(*self.rings, *self.places(signals), self.first_tick, self.end_tick, start, stop, out)
        return out

    def read(self, signals: list[int] | IntArray, start: int, stop: int) -> Float32Array:
        """Return full-rate values, shape (signals, ticks); the span is cut to the ticks kept."""
        start, stop = max(start, self.first_tick), min(stop, self.end_tick)
        found: Float32Array = np.empty((len(signals), max(stop - start, 0)), dtype=np.float32)
        _read(self._ring, *self.places(signals), start, found)
        return found

    def places(self, signals: list[int] | IntArray) -> tuple[IntArray, IntArray]:
        """Return group and lane of signals."""
        return self._groups[signals], self._lanes[signals]

    def crossing(self, signal: int, edge: str, level: float, hysteresis: float, start: int, stop: int) -> int | None:
        """Return the last tick in the span at which the signal crosses ``level`` on the rising or falling edge."""
        start, stop = max(start, self.first_tick), min(stop, self.end_tick)
        group, lane = int(self._groups[signal]), int(self._lanes[signal])
        found = _crossing(self._ring, group, lane, 1.0 if edge == "rising" else -1.0, level, hysteresis, start, stop)
        return int(found) if found >= 0 else None
