"""The runs of a campaign that are still to be made: a byte for each, and more only for those handed out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from scenarios.campaign.points import Point
from scenarios.campaign.sweep import Sweep

MOST_AT_ONCE = 5000
"""Runs whose keys are looked for in the table together."""
WAITING, OUT, DONE = range(3)
Run = tuple[str, Point, int]
"""Its key, point and seed."""


class Remaining:
    """The runs that the table of results lacks, which are looked for there when it is their turn.

    Parameters
    ----------
    sweep : Sweep
        The campaign. Points of the same content are the same runs, and count once.
    have : callable
        Returns which of some keys are in the table.

    Attributes
    ----------
    total : int
        Different runs of the campaign, as far as is known: points of the same content are found in their turn.
    waiting : int
        Runs that are to be handed out, unless the table has them.
    """

    def __init__(self, sweep: Sweep, have: Callable[[Sequence[str]], set[str]]) -> None:
        self._sweep, self._have = sweep, have
        self._state = np.zeros(len(sweep), np.uint8)
        self._out: dict[str, int] = {}
        self._next = self._reach = 0
        self._known: set[str] = set()
        self._compared = 0  # points that were compared with those before them
        self.total = self.waiting = self._left = len(sweep)

    def __len__(self) -> int:
        """Return how many runs are not done, as far as is known."""
        return self._left

    def take(self, count: int) -> list[Run]:
        """Hand out the next runs that the table lacks, in the order of points and seeds.

        At most ``count`` runs; the result may be empty although later places still have runs.
        """
        numbers = self._following(max(count, self._reach))
        keys = {self._sweep.key(number): number for number in numbers}
        there = self._have(list(keys)) if keys else set()
        for key in there & keys.keys():
            self._state[keys.pop(key)] = DONE
            self.waiting -= 1
            self._left -= 1
        self._reach = 0 if keys else min(2 * max(count, self._reach), MOST_AT_ONCE)
        points: dict[int, Point] = {}
        runs: list[Run] = []
        for key, number in list(keys.items())[:count]:
            at, seed = divmod(number, len(self._sweep.seeds))
            points[at] = points.get(at) or self._sweep.points[at]
            runs.append((key, points[at], self._sweep.seeds[seed]))
            self._state[number], self._out[key] = OUT, number
        self.waiting -= len(runs)
        return runs

    def finish(self, key: str) -> None:
        """Note that a run is in the table."""
        number = self._out.pop(key, None)
        if number is not None:
            self._state[number] = DONE
            self._left -= 1

    def take_back(self) -> None:
        """Take back the unfinished runs that were handed out: they wait again."""
        self._state[list(self._out.values())] = WAITING
        self.waiting += len(self._out)
        self._out.clear()
        self._next = 0

    def _following(self, count: int) -> list[int]:
        """Return the next waiting runs, at most ``count``."""
        while self.waiting:
            self._next += int(np.argmax(self._state[self._next :] == WAITING))
            self._compare(self._next + count)
            waiting = self._next + np.flatnonzero(self._state[self._next : self._next + count] == WAITING)
            if len(waiting):
                return [int(number) for number in waiting]
        return []

    def _compare(self, end: int) -> None:
        """Drop points of the content of one before them, as far as some run."""
        seeds = len(self._sweep.seeds)
        while self._compared * seeds < min(end, len(self._state)):
            content, first = self._sweep.contents[self._compared], self._compared * seeds
            if content in self._known:
                self._state[first : first + seeds] = DONE
                self.total -= seeds
                self.waiting -= seeds
                self._left -= seeds
            self._known.add(content)
            self._compared += 1
