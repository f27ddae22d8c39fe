"""The trigger of a scope: it finds every crossing in the full-rate history once."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from core.board.crossing import crossings

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
        self._ways = ways(self.edge, self.level, self.upper, self.hysteresis)
        self._ready = np.zeros(len(self._ways), dtype=np.int64)

    def restart(self, tick: int) -> None:
        """Forget the past; scan from ``tick``."""
        self.next_tick = tick
        self._ready[:] = 0

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
        places = np.empty(1 if first_only else len(samples), dtype=np.int64)
        is_outside = int(self.edge == "leaves")
        count = crossings(np.ascontiguousarray(samples), self._ways, is_outside, self._ready, places)
        ticks = [self.next_tick + place for place in places[:count].tolist()]
        if ticks and first_only:
            self.next_tick = ticks[0] + 1
        return ticks


def ways(edge: Edge, level: float, upper: float, hysteresis: float) -> NDArray[np.float32]:
    """Return for each way of crossing its target, and the numbers beyond which the signal has been back.

    In single precision, as the samples are.
    """
    up = (level, math.inf, level - hysteresis, math.inf)
    down = (-math.inf, level, -math.inf, level + hysteresis)
    if edge in ("enters", "leaves"):
        far = hysteresis if edge == "enters" else -hysteresis
        return np.array([(level, upper, level - far, upper + far)], dtype=np.float32)
    found = {"rising": [up], "falling": [down], "either": [up, down]}
    return np.array(found[edge], dtype=np.float32)


def crossing_time(history: TriggerSamples, index: int, tick: int, *levels: float) -> float:
    """Place a crossing of a level between two ticks, on the line between them, so that a picture does not jitter."""
    if tick - 1 < history.first_tick:
        return float(tick)
    before, after = (float(value) for value in history.read([index], tick - 1, tick + 1)[0])
    crossed = [level for level in levels if min(before, after) <= level <= max(before, after)]
    if before == after or not crossed:
        return float(tick)
    return tick - 1 + min((level - before) / (after - before) for level in crossed)
