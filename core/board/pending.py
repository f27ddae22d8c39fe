"""Commands that wait for their moment."""

from __future__ import annotations

import math
from bisect import bisect_right, insort
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import takewhile

import numpy as np

from core.block import FloatArray
from core.board.commands import Command
from core.board.condition import Condition
from core.board.document import Document


@dataclass(eq=False)
class PendingCommand:
    """A command that waits for its moment: a tick, or a condition watched from a tick on.

    ``number`` grows in the order in which commands have begun to wait.
    """

    command: Command
    actor: str
    tick: int | None
    condition: Condition | None = None
    since: int = 0
    number: int = 0

    def event(self) -> Document:
        """Return it as an event of a scenario; a condition that has been met is no part of it."""
        when = self.command.when if self.condition is not None else None
        return self.command.at(self.since if self.tick is None else self.tick, when).document()


class PendingQueue:
    """The waiting commands in the order of their ticks; commands with a watched condition come last."""

    def __init__(self) -> None:
        self._entries: list[PendingCommand] = []
        self._asked = 0

    def __len__(self) -> int:
        return len(self._entries)

    def __iter__(self) -> Iterator[PendingCommand]:
        return iter(self._entries)

    @property
    def next_tick(self) -> int | None:
        """The first tick at which a command takes effect, if one waits for a tick."""
        return self._entries[0].tick if self._entries else None

    @property
    def as_asked(self) -> list[PendingCommand]:
        """The entries in the order in which they began to wait; entries of one tick take effect in this order."""
        return _as_asked(self._entries)

    @property
    def asked(self) -> int:
        """How many have begun to wait so far."""
        return self._asked

    @classmethod
    def of(cls, entries: Iterable[PendingCommand], asked: int) -> PendingQueue:
        """Return a queue in which these wait, as they did in another."""
        queue = cls()
        queue._entries, queue._asked = sorted(entries, key=_moment), asked
        return queue

    def copy(self) -> PendingQueue:
        """Return a queue in which the same commands wait for the same ticks, for another board."""
        queue = PendingQueue()
        queue._entries, queue._asked = [*self._entries], self._asked  # only an entry with a condition ever changes
        return queue

    def add(self, entry: PendingCommand) -> None:
        """Let a command wait."""
        self._asked += 1
        entry.number = self._asked
        insort(self._entries, entry, key=_moment)

    def remove(self, entry: PendingCommand) -> None:
        """Let a command wait no more."""
        self._entries.remove(entry)

    def take_due(self, tick: int) -> list[PendingCommand]:
        """Take out the entries due at a tick; an entry with a condition stays, and is watched from then on."""
        count = bisect_right(self._entries, (float(tick), math.inf), key=_moment)
        due, self._entries = _as_asked(self._entries[:count]), self._entries[count:]
        for entry in due:
            if entry.condition is not None:
                entry.tick, entry.since = None, tick
                self.add(entry)
        return [entry for entry in due if entry.condition is None]

    def meet(self, value: Callable[[str], float], tick: int) -> None:
        """Let every command whose condition holds take effect at this tick."""
        for entry in self._watched():
            if entry.condition is not None and entry.condition.holds(value(entry.condition.signal)):
                entry.condition, entry.tick = None, tick
        self._entries.sort(key=_moment)

    def watches(self, index: dict[str, int]) -> FloatArray:
        """Return the conditions that are watched as rows for the loop."""
        conditions = [entry.condition for entry in self._watched() if entry.condition is not None]
        rows = [[index[one.signal], one.sign, one.threshold] for one in conditions]
        return np.array(rows, dtype=np.float64).reshape(-1, 3)

    def at_once(self) -> None:
        """Let all of them wait for tick 0."""
        for entry in self._entries:
            entry.tick = 0
        self._entries.sort(key=_moment)

    def clear(self) -> None:
        """Remove all entries."""
        self._entries.clear()

    def _watched(self) -> list[PendingCommand]:
        return list(takewhile(lambda entry: entry.tick is None, reversed(self._entries)))[::-1]


def _moment(entry: PendingCommand) -> tuple[float, float]:
    """Return the sort key of an entry in the queue."""
    return (math.inf if entry.tick is None else entry.tick), entry.number


def _as_asked(entries: Iterable[PendingCommand]) -> list[PendingCommand]:
    return sorted(entries, key=lambda entry: entry.number)
