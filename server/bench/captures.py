"""Captures: stretches of the history around crossings of a trigger, kept at full rate after the history has gone on."""

from __future__ import annotations

from collections import OrderedDict, deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol
from weakref import WeakSet

import numpy as np

from core.block import IntArray
from core.board.history import Float32Array, History

if TYPE_CHECKING:
    from server.bench.bench import LiveBench

MOST = 50
"""Captures of one trigger."""
MOST_SETS = 16
"""Triggers whose captures a bench keeps at a time."""
AT_ONCE = 100_000
"""Samples copied at once: a millisecond of the event loop."""


class Finder(Protocol):
    """A view that finds crossings of a trigger."""

    def find(self, history: Any) -> None:
        """Find the crossings to capture."""


class Captured(NamedTuple):
    """Definition of a capture: signals, over a window of ticks around the crossings of a trigger."""

    signals: tuple[str, ...]
    trigger: str
    edge: str
    level: float
    upper: float | None
    hysteresis: float
    window: int
    before: int
    """Ticks of the window before the crossing."""


class TriggerCrossing(NamedTuple):
    """A crossing of a trigger: its tick, its place between ticks, and its branch of time."""

    tick: int
    at: float
    branch: int


@dataclass(eq=False)
class Capture:
    """Every sample of the window around a crossing, shape (signals, ticks)."""

    crossing: TriggerCrossing
    start: int
    samples: Float32Array
    copied: int = 0

    @property
    def stop(self) -> int:
        """The tick behind its last."""
        return self.start + int(self.samples.shape[1])


class CaptureSet:
    """The captures of one trigger, oldest first.

    Parameters
    ----------
    what : Captured
        Definition of the captures.
    columns : sequence of int
        Columns of its signals in the history.
    """

    def __init__(self, what: Captured, columns: Sequence[int]) -> None:
        self.what, self.columns = what, list(columns)
        self.captures: list[Capture] = []
        self.coming: Capture | None = None
        self.waiting: deque[TriggerCrossing] = deque(maxlen=MOST)
        self.views: WeakSet[Finder] = WeakSet()
        """Views that show it now."""
        self.edition = 0
        """Grows with each change."""
        self.is_short = False
        """Whether memory has left room for fewer than `MOST`."""

    @property
    def nbytes(self) -> int:
        """Memory of its samples."""
        coming = self.coming.samples.nbytes if self.coming is not None else 0
        return coming + sum(one.samples.nbytes for one in self.captures)

    def wants(self, tick: int) -> bool:
        """Whether a crossing is captured: captures do not overlap, so that none costs more than the history does."""
        return max(tick - self.what.before, 0) >= self._end

    def drop_oldest(self) -> None:
        """Forget the oldest."""
        del self.captures[0]
        self.edition += 1

    def keep(self, capture: Capture) -> None:
        """Take a capture that is whole."""
        self.captures.append(capture)
        self.coming = None
        self.edition += 1

    def retain(self, kept: list[Capture]) -> None:
        """Forget all but these."""
        self.coming = None
        self.waiting.clear()
        if len(kept) != len(self.captures):
            self.captures, self.edition = kept, self.edition + 1

    @property
    def _end(self) -> int:
        """The tick behind the last that is captured or waits to be."""
        if self.waiting:
            return self.waiting[-1].tick - self.what.before + self.what.window
        if self.coming is not None:
            return self.coming.stop
        return self.captures[-1].stop if self.captures else 0


class Captures:
    """The captures of a bench, as it may be seen; all of it on the event loop.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    most_bytes : int
        Memory of all captures; where that is not enough, the trigger with the most gives its oldest.
    """

    def __init__(self, bench: LiveBench, most_bytes: int) -> None:
        self._bench, self.most_bytes = bench, most_bytes
        self._sets: OrderedDict[Captured, CaptureSet] = OrderedDict()
        self._branch = self._head = 0

    def sets(self) -> list[CaptureSet]:
        """Return the captures of each trigger."""
        self.follow()
        return list(self._sets.values())

    def open(self, what: Captured, columns: Sequence[int]) -> CaptureSet | None:
        """Return the captures of a trigger; None if the bench has the visible captures of too many others."""
        if (known := self._sets.get(what)) is not None:
            self._sets.move_to_end(what)
            return known
        if len(self._sets) >= MOST_SETS:
            unseen = next((key for key, one in self._sets.items() if not one.views), None)
            if unseen is None:
                return None
            del self._sets[unseen]
        return self._sets.setdefault(what, CaptureSet(what, columns))

    def follow(self) -> None:
        """Follow the bench: after it went back, captures ahead of it are not in its past."""
        branch, head = self._bench.branches.current, self._bench.history.end_tick
        if branch != self._branch or head < self._head:
            for one in self._sets.values():
                one.retain([capture for capture in one.captures if self._is_past(capture, head)])
        self._branch, self._head = branch, head

    def found(self, kept: CaptureSet, tick: int, at: float) -> None:
        """Note a crossing whose window is complete; its samples are copied by `gather`."""
        kept.waiting.append(TriggerCrossing(tick, at, self._branch))

    def gather(self) -> bool:
        """Copy the samples of crossings that wait, some at a time; return whether crossings still wait."""
        self.follow()
        room = AT_ONCE
        for key, one in list(self._sets.items()):
            if room > 0 and (one.waiting or one.coming is not None):
                room = self._copy(one, room)
                self._sets.move_to_end(key)
        return any(one.waiting or one.coming for one in self._sets.values())

    def fold(self, columns: Float32Array, signals: list[int], start: int, stop: int) -> None:
        """Fold captures into columns of whole ticks, minima and maxima, where the history has gone on."""
        if start >= self._bench.history.first_tick:
            return
        edges = start + (stop - start) * np.arange(columns.shape[2] + 1) // columns.shape[2]
        for one in self.sets():
            rows = [(at, one.columns.index(signal)) for at, signal in enumerate(signals) if signal in one.columns]
            for capture in one.captures if rows else ():
                _fold(capture, rows, edges, columns)

    def covering(self, signals: list[int], start: int, stop: int) -> Float32Array | None:
        """Return every sample of a span if one capture has all of them, shape (signals, ticks)."""
        for one in self.sets():
            if not set(signals) <= set(one.columns):
                continue
            rows = [one.columns.index(signal) for signal in signals]
            for capture in one.captures:
                if capture.start <= start and stop <= capture.stop:
                    found: Float32Array = capture.samples[rows, start - capture.start : stop - capture.start]
                    return found
        return None

    def _is_past(self, capture: Capture, head: int) -> bool:
        return capture.stop <= head and self._bench.branches.share(capture.crossing.branch, capture.stop)

    def _copy(self, one: CaptureSet, room: int) -> int:
        """Copy at most a number of samples; return how many more may be copied."""
        history = self._bench.history
        while room > 0 and (one.coming is not None or one.waiting):
            coming = one.coming = one.coming or self._begin(one, history)
            if coming is None:
                continue
            at = coming.start + coming.copied
            end = min(at + max(1, room // len(one.columns)), coming.stop)
            part = history.read(one.columns, at, end)
            if (
                at < history.first_tick
                or part.shape[1] != end - at
                or coming.crossing.branch != self._bench.branches.current
            ):
                one.coming = None  # the bench was faster, or has gone back meanwhile
                continue
            coming.samples[:, coming.copied : coming.copied + end - at] = part
            coming.copied += end - at
            room -= part.size
            if coming.copied == coming.samples.shape[1]:
                one.keep(coming)
        return room

    def _begin(self, one: CaptureSet, history: History) -> Capture | None:
        """Make room for the next crossing that waits, if the history still has its window."""
        crossing = one.waiting.popleft()
        start = max(crossing.tick - one.what.before, 0)
        ticks = crossing.tick - one.what.before + one.what.window - start
        if start < history.first_tick or crossing.branch != self._bench.branches.current:
            return None
        if len(one.captures) >= MOST:
            one.drop_oldest()
            one.is_short = False
        if not self._make_room(4 * ticks * len(one.columns), one):
            return None
        return Capture(crossing, start, np.empty((len(one.columns), ticks), np.float32))

    def _make_room(self, nbytes: int, wanting: CaptureSet) -> bool:
        """Make room for a capture; false if it is larger than all the memory there is."""
        while sum(one.nbytes for one in self._sets.values()) + nbytes > self.most_bytes:
            largest = max(
                (one for one in self._sets.values() if one.captures), key=lambda one: one.nbytes, default=None
            )
            wanting.is_short = True
            if largest is None:
                wanting.edition += 1
                return False
            largest.drop_oldest()
            largest.is_short = True
        return True


def _fold(capture: Capture, rows: list[tuple[int, int]], edges: IntArray, found: Float32Array) -> None:
    """Fold the samples of a capture into the columns between edges."""
    start, stop = max(capture.start, int(edges[0])), min(capture.stop, int(edges[-1]))
    if start >= stop:
        return
    first, last = int(np.searchsorted(edges, start, "right")) - 1, int(np.searchsorted(edges, stop, "left"))
    begins = np.maximum(edges[first:last], start) - start
    into, of = [at for at, _ in rows], [row for _, row in rows]
    samples = capture.samples[of, start - capture.start : stop - capture.start]
    least, most = np.minimum.reduceat(samples, begins, axis=1), np.maximum.reduceat(samples, begins, axis=1)
    found[into, 0, first:last] = np.fmin(found[into, 0, first:last], least)
    found[into, 1, first:last] = np.fmax(found[into, 1, first:last], most)
