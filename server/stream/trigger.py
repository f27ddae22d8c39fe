"""The trigger of a scope: it finds every crossing in the full-rate history once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

Edge = Literal["rising", "falling", "either"]
BLOCK = 50_000
"""Ticks scanned at once; bounds the memory of a scan."""


class Samples(Protocol):
    """The history that a trigger reads."""

    @property
    def first_tick(self) -> int:
        """Oldest tick kept."""

    @property
    def end_tick(self) -> int:
        """First tick not computed yet."""

    def read(self, signals: list[int], start: int, stop: int) -> NDArray[np.float32]:
        """Return ``(n, ticks)`` samples."""


@dataclass
class Trigger:
    """Finds the crossings of one signal in the order they happened.

    A rising crossing is the first sample at or above ``level`` after the signal was below
    ``level - hysteresis``; a falling one is its mirror image. The scan keeps its place and whether the
    signal has been back, so it may be called with any amount of new data.

    Parameters
    ----------
    index : int
        Signal to watch.
    edge : {"rising", "falling", "either"}
        Direction.
    level, hysteresis : float
        In the unit of the signal.
    next_tick : int
        Where the scan begins.
    """

    index: int
    edge: Edge
    level: float
    hysteresis: float
    next_tick: int

    def __post_init__(self) -> None:
        self._ready_up = False
        self._ready_down = False

    def restart(self, tick: int) -> None:
        """Forget the past; scan from ``tick``."""
        self.next_tick = tick
        self._ready_up = self._ready_down = False

    def scan(self, history: Samples, first_only: bool = False) -> list[int]:
        """Return the ticks of all crossings since the last scan, oldest first.

        Parameters
        ----------
        history : Samples
            Full-rate history; ticks it no longer holds cannot trigger.
        first_only : bool
            Stop behind the first crossing; the next scan goes on from there.
        """
        if not history.first_tick <= self.next_tick <= history.end_tick:
            # The history no longer has the tick, or the bench went back in time.
            self.restart(min(max(self.next_tick, history.first_tick), history.end_tick))
        crossings: list[int] = []
        while self.next_tick < history.end_tick:
            end = min(self.next_tick + BLOCK, history.end_tick)
            samples = history.read([self.index], self.next_tick, end)[0]
            crossings += self._crossings(samples, first_only)
            if crossings and first_only:
                return crossings
            self.next_tick = end
        return crossings

    def _crossings(self, samples: NDArray[np.float32], first_only: bool) -> list[int]:
        """Scan one block; both directions, merged in order."""
        hits: list[tuple[int, bool]] = []
        states = []
        for rising in (True, False):
            if self.edge not in ("either", "rising" if rising else "falling"):
                continue
            beyond = samples >= self.level if rising else samples <= self.level
            back = self.level - self.hysteresis if rising else self.level + self.hysteresis
            cleared = samples < back if rising else samples > back
            marks = np.where(beyond, np.int8(1), np.where(cleared, np.int8(-1), np.int8(0)))
            places = np.flatnonzero(marks)
            values = marks[places]
            ready = self._ready_up if rising else self._ready_down
            before = np.concatenate(([-1 if ready else 1], values[:-1])) if len(values) else values
            hits += [(int(place), rising) for place in places[(values == 1) & (before == -1)]]
            states.append((rising, marks, ready))
        hits.sort()
        stop = hits[0][0] + 1 if hits and first_only else len(samples)
        for rising, marks, ready in states:
            decided = np.flatnonzero(marks[:stop])
            state = bool(marks[decided[-1]] == -1) if len(decided) else ready
            if rising:
                self._ready_up = state
            else:
                self._ready_down = state
        ticks = sorted({self.next_tick + place for place, _ in hits if place < stop})
        if hits and first_only:
            self.next_tick += stop
        return ticks


def crossing_time(history: Samples, index: int, tick: int, level: float) -> float:
    """Place a crossing between two ticks, on the line between them, so that a picture stands still."""
    if tick - 1 < history.first_tick:
        return float(tick)
    before, after = (float(value) for value in history.read([index], tick - 1, tick + 1)[0])
    if before == after or not (min(before, after) <= level <= max(before, after)):
        return float(tick)
    return tick - 1 + (level - before) / (after - before)
