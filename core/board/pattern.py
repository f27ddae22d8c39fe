"""Pattern: the blocks, wiring, intervals and choices that boards abreast share, worked out once."""

from __future__ import annotations

from dataclasses import fields
from operator import attrgetter
from typing import Any

import numpy as np

from core.block import BlockParams, Context, FloatArray, IntArray, Oscillator
from core.board import steps
from core.board.board import Board
from core.board.commands import SetValues
from core.board.course import Courses
from core.board.idle import leave_out_idle
from core.board.instances import Instance
from core.board.program import P_OFFSET
from core.board.spec import Spec
from core.compile.machine import WIDTH
from core.record import RecordLayout

FACTS = [fact.name for fact in fields(Context)]
"""The facts that blocks may know of a bench."""
ALL_FACTS = attrgetter(*FACTS)


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
        self._addresses: dict[int, int] = {}
        self.courses = Courses()
        """What the commands of boards change, worked out once."""

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


class _Fact:
    """A fact of a bench, which is put among the attributes of the object that it is first read from."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, noting: Any, _: type) -> Any:
        if noting is None:  # asked of the class, as units of a document are looked at
            return self
        value = vars(noting)[self._name] = getattr(vars(noting)[""], self._name)
        return value


_Noting = type("_Noting", (Context,), {fact: _Fact(fact) for fact in FACTS})
"""The facts of a bench, whose attributes are the facts read; a unit of a document accepts only a `Context`."""


def numbers(instance: Instance, spec: Spec) -> tuple[FloatArray, FloatArray, set[str]]:
    """Return the parameters and the first state of a block, and which facts of the bench they are made of."""
    noting: Any = object.__new__(_Noting)
    read = vars(noting)
    read[""] = spec.context(instance.every, instance.axis)
    made = instance.packed(noting), instance.block.initial(instance.params, noting)
    return *made, read.keys() - {""}


def unlike(one: Context, other: Context) -> set[str]:
    """Return the facts in which two benches differ."""
    facts = zip(FACTS, ALL_FACTS(one), ALL_FACTS(other), strict=True)
    return {fact for fact, own, another in facts if own is not another and not is_alike(own, another)}


def is_alike(one: Any, other: Any) -> bool:
    """Say whether two values are the same, to the sign of a zero."""
    if one is other:
        return True
    if type(one) is float and one != 0.0:
        return bool(one == other)
    if isinstance(one, BlockParams | Oscillator):
        return type(one) is type(other) and is_alike(vars(one), vars(other))
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(is_alike(value, other[name]) for name, value in one.items())
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(is_alike, one, other))
    return bool(one == other) and repr(one) == repr(other)


def has_same_blocks(spec: Spec, other: Spec) -> bool:
    """Say whether two benches have the very same sections, and so the same blocks in the same order."""
    if (spec.dt_ms, spec.driving, spec.measuring) != (other.dt_ms, other.driving, other.measuring):
        return False
    return spec.has_sections_of(other)


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
