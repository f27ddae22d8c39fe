"""Pattern: the blocks, wiring, intervals and choices that boards abreast share, worked out once."""

from __future__ import annotations

import numpy as np

from core.block import IntArray
from core.board import steps
from core.board.board import Board
from core.board.commands import SetValues
from core.board.course import Courses
from core.board.facts import FACTS, numbers, streams
from core.board.idle import leave_out_idle
from core.board.instances import Instance
from core.board.program import P_OFFSET
from core.board.spec import Spec
from core.compile.machine import WIDTH
from core.record import RecordLayout


class Uneven(Exception):
    """Boards that cannot run abreast, or no longer."""


class Pattern:
    """The parts that boards of one structure share, made from the first of them.

    Parameters
    ----------
    board : Board
        At its first tick, its commands waiting.

    Raises
    ------
    Uneven
        When the course of the board depends on its samples.
    """

    def __init__(self, board: Board) -> None:
        if any(entry.condition is not None or entry.tick is None for entry in board.pending) or board.tick:
            raise Uneven("a command waits for a condition")
        if board.spec.supervisors:
            raise Uneven("a supervisor acts on the samples")
        leave_out_idle(board)
        self.board = board
        wiring = board.wiring
        may_set = any(isinstance(entry.command, SetValues) for entry in board.pending)
        self.used = [
            row
            for row in range(len(wiring.instances))
            if row not in wiring.left_out and (may_set or not wiring.unread[row])
        ]
        counted = {entry.key for row, entry in enumerate(wiring.instances) if row not in wiring.left_out}
        outputs = [signal for signal in wiring.signals if signal.kind == "output" and signal.block in counted]
        self.folded = np.array([signal.index for signal in outputs], dtype=np.int64)
        self.choices = self._choices()
        # a block that rests is packed when it starts to run
        packed = [row for row in self.used if not wiring.absent[row] or len(wiring.state_of(wiring.instances[row].key))]
        self.read = {row: numbers(wiring.instances[row], board.spec)[2] for row in packed}
        self.streams = [one for row in packed for one in streams(wiring.instances[row], wiring.table[row, P_OFFSET])]
        """The noise streams of the rows that are packed, each with the place of its key."""
        self.places = {(one.every, one.axis) for row, one in enumerate(wiring.instances) if row in self.used}
        """The intervals and axes of the rows that may run."""
        self.facts = set[str]().union(*self.read.values())
        """The facts that the numbers of these rows are made of."""
        self.varied: set[str] = set()
        """The facts in which benches have differed so far."""
        self._addresses: dict[int, int] = {}
        self.courses = Courses()
        """The changes that the commands of boards make, worked out once."""

    def follow(self, read: set[str]) -> None:
        """Compare all facts of benches from now on if numbers are made of others than before."""
        if not read <= self.facts:
            self.varied |= {*FACTS} - self.facts  # not compared so far
            self.facts = {*FACTS}

    def address(self, row: int) -> int:
        """Return the address of the step of a row, for all boards."""
        if row not in self._addresses:
            self._addresses[row] = steps.address(self.board.wiring, row, WIDTH)
        return self._addresses[row]

    def _choices(self) -> IntArray:
        """Return the places of the numbers that boards abreast must share."""
        wiring = self.board.wiring
        found = []
        for row in self.used:
            start = int(wiring.table[row, P_OFFSET])
            found += [start + at for at in _choices_of(wiring.instances[row].block.Packed.layout)]
        return np.array(found, dtype=np.int64)


def _choices_of(layout: RecordLayout) -> list[int]:
    """Return the places of the choices in a record, also in its inner records."""
    found = [field.offset for field in layout.fields if field.is_choice]
    for field in layout.fields:
        if field.inner is not None and not field.tail:
            inner = _choices_of(field.inner)
            found += [field.offset + i * field.inner.size + at for i in range(field.count) for at in inner]
    return found


def is_same_structure(board: Board, spec: Spec, order: list[Instance]) -> bool:
    """Say whether a bench has the blocks of a board, wired alike."""
    before = board.wiring.instances
    if spec.dt_ms != board.spec.dt_ms or (spec.driving, spec.measuring) != (board.spec.driving, board.spec.measuring):
        return False
    if len(order) != len(before):
        return False
    return all(
        one is other
        or (
            (one.key == other.key and one.block is other.block and one.every == other.every and one.axis == other.axis)
            and (one.params is other.params or one.block.rests(one.params) == other.block.rests(other.params))
        )
        for one, other in zip(order, before, strict=True)
    )
