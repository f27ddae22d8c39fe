"""The changes that the commands of boards abreast make at each of their ticks, worked out once."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest
from typing import NamedTuple

from core.block import BlockParams, Context, FloatArray
from core.board.commands import Command, HealFaults, Inject
from core.board.instances import Instance
from core.board.pending import PendingQueue


class ChangedRow(NamedTuple):
    """A row of the table after commands, with its numbers and the facts of the bench behind these."""

    number: int
    instance: Instance
    context: Context
    numbers: FloatArray
    read: set[str]
    every: int
    is_absent: bool


@dataclass(slots=True)
class CourseStep:
    """The changes of the commands of one tick: the faults that act from now on, and the rows.

    ``running`` and ``resting`` are the rows that run from now on and all others, once they are known.
    """

    faults: dict[str, BlockParams]
    commands: list[tuple[int, Command]]
    rows: list[ChangedRow]
    running: list[int] | None = None
    resting: set[int] | None = None


Course = dict[int, CourseStep]
"""The changes at each tick, as far as boards have come."""


def has_same_faults(one: PendingQueue, other: PendingQueue) -> bool:
    """Say whether the same commands wait in two queues, all of them for faults."""
    return all(
        own is not None
        and another is not None
        and (own is another or (own.tick, own.command) == (another.tick, another.command))
        and isinstance(own.command, Inject | HealFaults)
        for own, another in zip_longest(one, other)
    )


class Courses:
    """The courses known so far, by the commands that wait at the first tick."""

    def __init__(self) -> None:
        self._known: list[tuple[PendingQueue, Course]] = []

    def of(self, queue: PendingQueue) -> Course:
        """Return the course of some waiting commands; always a new one if they are not all for faults."""
        for waiting, course in self._known:
            if has_same_faults(waiting, queue):
                return course
        course = Course()
        if has_same_faults(queue, queue):
            self._known.append((queue.copy(), course))
        return course
