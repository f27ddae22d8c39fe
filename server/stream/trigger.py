"""The trigger of a scope: it finds every crossing in the full-rate history once."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

Edge = Literal["rising", "falling", "either", "enters", "leaves"]
BLOCK = 50_000
"""Ticks scanned at once; bounds the memory of a scan."""


class TriggerSamples(Protocol):
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
    ``level - hysteresis``; a falling one is its mirror image. A signal leaves the window from ``level`` to ``upper``
    with the first sample at or beyond one of them after it was within both by more than ``hysteresis``; it enters with
    the first sample within after it was beyond one by more. The scan keeps its place and whether the signal has been
    back, so it may be called with any amount of new data.

    Parameters
    ----------
    index : int
        Signal to watch.
    edge : {"rising", "falling", "either", "enters", "leaves"}
        Direction.
    level, hysteresis : float
        In the unit of the signal.
    next_tick : int
        Where the scan begins.
    upper : float
        The upper end of the window.
    """

    index: int
    edge: Edge
    level: float
    hysteresis: float
    next_tick: int
    upper: float = math.inf

    def __post_init__(self) -> None:
        self._ways = ("rising", "falling") if self.edge == "either" else (self.edge,)
        self._ready = dict.fromkeys(self._ways, False)

    def restart(self, tick: int) -> None:
        """Forget the past; scan from ``tick``."""
        self.next_tick = tick
        self._ready = dict.fromkeys(self._ways, False)

    def scan(self, history: TriggerSamples, first_only: bool = False) -> list[int]:
        """Return the ticks of all crossings since the last scan, oldest first.

        Parameters
        ----------
        history : Samples
            Full-rate history; ticks it no longer holds cannot trigger.
        first_only : bool
            Stop after the first crossing; the next scan continues from there.
        """
        if not history.first_tick <= self.next_tick <= history.end_tick:
            # The history no longer has the tick, or the bench went back in time.
            self.restart(min(max(self.next_tick, history.first_tick), history.end_tick))
        crossings: list[int] = []
        while self.next_tick < history.end_tick:
            end = min(self.next_tick + BLOCK, history.end_tick)
            samples = history.read([self.index], self.next_tick, end)[0]
            if len(samples) < end - self.next_tick:  # meanwhile the history has lost its oldest ticks
                self.restart(end - len(samples))
            crossings += self._crossings(samples, first_only)
            if crossings and first_only:
                return crossings
            self.next_tick = end
        return crossings

    def _crossings(self, samples: NDArray[np.float32], first_only: bool) -> list[int]:
        """Scan one block; all ways, merged in order."""
        hits: list[int] = []
        states = []
        for way in self._ways:
            beyond, cleared = self._judged(way, samples)
            marks = np.where(beyond, np.int8(1), np.where(cleared, np.int8(-1), np.int8(0)))
            places = np.flatnonzero(marks)
            values = marks[places]
            before = np.concatenate(([-1 if self._ready[way] else 1], values[:-1])) if len(values) else values
            hits += [int(place) for place in places[(values == 1) & (before == -1)]]
            states.append((way, marks))
        hits.sort()
        stop = hits[0] + 1 if hits and first_only else len(samples)
        for way, marks in states:
            decided = np.flatnonzero(marks[:stop])
            if len(decided):
                self._ready[way] = bool(marks[decided[-1]] == -1)
        ticks = sorted({self.next_tick + place for place in hits if place < stop})
        if hits and first_only:
            self.next_tick += stop
        return ticks

    def _judged(self, way: str, samples: NDArray[np.float32]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return where the signal is where it triggers, and where it has been back by more than the hysteresis."""
        level, upper, far = self.level, self.upper, self.hysteresis
        if way == "rising":
            return samples >= level, samples < level - far
        if way == "falling":
            return samples <= level, samples > level + far
        if way == "leaves":
            return (samples <= level) | (samples >= upper), (samples > level + far) & (samples < upper - far)
        return (samples >= level) & (samples <= upper), (samples < level - far) | (samples > upper + far)


def crossing_time(history: TriggerSamples, index: int, tick: int, *levels: float) -> float:
    """Place a crossing of a level between two ticks, on the line between them, so that a picture does not jitter."""
    if tick - 1 < history.first_tick:
        return float(tick)
    before, after = (float(value) for value in history.read([index], tick - 1, tick + 1)[0])
    crossed = [level for level in levels if min(before, after) <= level <= max(before, after)]
    if before == after or not crossed:
        return float(tick)
    return tick - 1 + min((level - before) / (after - before) for level in crossed)
