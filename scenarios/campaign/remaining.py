"""The runs of a campaign that are still to be made: a byte for each, and more only for those handed out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from scenarios.campaign.points import Point
from scenarios.campaign.sweep import Sweep

AT_ONCE = 5000
"""Runs whose keys are looked for in the table together."""
WAITING, OUT, DONE = range(3)
Run = tuple[str, Point, int]
"""Its key, point and seed."""


class Remaining:
    """The runs that the table of results lacks.

    Parameters
    ----------
    sweep : Sweep
        The campaign. Points of the same content are the same runs, and count once.
    have : callable
        Returns which of some keys are in the table.

    Attributes
    ----------
    total : int
        Different runs of the campaign.
    waiting : int
        Runs that are to be handed out.
    """

    def __init__(self, sweep: Sweep, have: Callable[[Sequence[str]], set[str]]) -> None:
        self._sweep = sweep
        self._state = np.zeros(len(sweep), np.uint8)
        self._out: dict[str, int] = {}
        self._next = 0
        seeds, known = len(sweep.seeds), set[str]()
        for point, content in enumerate(sweep.contents):
            if content in known:
                self._state[point * seeds : (point + 1) * seeds] = DONE
            known.add(content)
        self.total = len(known) * seeds
        for first in range(0, len(sweep), AT_ONCE):
            numbers = first + np.flatnonzero(self._state[first : first + AT_ONCE] == WAITING)
            keys = {sweep.key(number): number for number in numbers.tolist()}
            for key in have(list(keys)) & keys.keys():
                self._state[keys[key]] = DONE
        self.waiting = self._left = int(np.count_nonzero(self._state == WAITING))

    def __len__(self) -> int:
        """Return how many runs are not done."""
        return self._left

    def take(self, count: int) -> list[Run]:
        """Hand out the next runs, in the order of points and seeds."""
        runs: list[Run] = []
        points: dict[int, Point] = {}
        while self.waiting and len(runs) < count:
            self._next += int(np.argmax(self._state[self._next :] == WAITING))
            number, (at, seed) = self._next, divmod(self._next, len(self._sweep.seeds))
            if at not in points:
                points[at] = self._sweep.points[at]
            key = self._sweep.key(number)
            runs.append((key, points[at], self._sweep.seeds[seed]))
            self._state[number], self._out[key] = OUT, number
            self.waiting -= 1
        return runs

    def finish(self, key: str) -> None:
        """Note that a run is in the table."""
        number = self._out.pop(key, None)
        if number is not None:
            self._state[number] = DONE
            self._left -= 1

    def take_back(self) -> None:
        """Take back what was handed out and is not done: it waits again."""
        self._state[list(self._out.values())] = WAITING
        self.waiting += len(self._out)
        self._out.clear()
        self._next = 0
