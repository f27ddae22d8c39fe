"""What boards abreast share: blocks, wiring, intervals and choices, worked out once."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from core.block import FloatArray, IntArray
from core.board.board import Board
from core.board.commands import Set
from core.board.idle import leave_out_idle
from core.board.instances import Instance
from core.board.program import P_OFFSET
from core.board.spec import Spec
from core.record import Layout

PARTS = [part.name for part in fields(Spec) if part.name not in ("document", "frame")]
"""Parts of a bench that no seed changes."""


class Uneven(Exception):
    """Boards that cannot run abreast, or no longer."""


class Pattern:
    """What boards of one structure share, made from the first of them.

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
        leave_out_idle(board)
        self.board = board
        wiring = board.wiring
        may_set = any(isinstance(entry.command, Set) for entry in board.pending)
        self.used = [
            row
            for row in range(len(wiring.instances))
            if row not in wiring.left_out and (may_set or not wiring.unread[row])
        ]
        counted = {entry.key for row, entry in enumerate(wiring.instances) if row not in wiring.left_out}
        outputs = [signal for signal in wiring.signals if signal.kind == "output" and signal.block in counted]
        self.folded = np.array([signal.index for signal in outputs], dtype=np.int64)
        self.choices = self._choices()
        self.seeded = self._seeded()

    def _choices(self) -> IntArray:
        """Return the places of the numbers that boards abreast must share."""
        wiring = self.board.wiring
        found = []
        for row in self.used:
            start = int(wiring.table[row, P_OFFSET])
            found += [start + at for at in _choices_of(wiring.instances[row].block.Packed.layout)]
        return np.array(found, dtype=np.int64)

    def _seeded(self) -> list[int]:
        """Return the rows whose parameters or first state the seed has a say in, found by trying three."""
        spec, wiring = self.board.spec, self.board.wiring
        others = [spec.with_seed(seed) for seed in (spec.seed + 1, spec.seed + 2, 3 * spec.seed + 5)]
        found = []
        for row in self.used:
            instance = wiring.instances[row]
            now = numbers(instance, spec)
            if any(not _alike(now, numbers(instance, other)) for other in others):
                found.append(row)
        return found


def _choices_of(layout: Layout) -> list[int]:
    """Return the places of the choices in a record, those of records in it too."""
    found = [field.offset for field in layout.fields if field.is_choice]
    for field in layout.fields:
        if field.inner is not None and not field.tail:
            inner = _choices_of(field.inner)
            found += [field.offset + i * field.inner.size + at for i in range(field.count) for at in inner]
    return found


def numbers(instance: Instance, spec: Spec) -> tuple[FloatArray, FloatArray]:
    """Return the parameters and the first state of a block."""
    context = spec.context(instance.every, instance.axis)
    return instance.packed(spec), instance.block.initial(instance.params, context)


def _alike(one: tuple[FloatArray, FloatArray], other: tuple[FloatArray, FloatArray]) -> bool:
    return all(a.tobytes() == b.tobytes() for a, b in zip(one, other, strict=True))


def is_same_but_seed(spec: Spec, other: Spec) -> bool:
    """Say whether two benches share all parts but the seed."""
    return spec.dt_ms == other.dt_ms and all(getattr(spec, name) is getattr(other, name) for name in PARTS)


def is_same_structure(board: Board, spec: Spec, order: list[Instance]) -> bool:
    """Say whether a bench has the blocks of a board, wired alike."""
    before = board.wiring.instances
    if spec.dt_ms != board.spec.dt_ms or (spec.driving, spec.measuring) != (board.spec.driving, board.spec.measuring):
        return False
    if len(order) != len(before):
        return False
    return all(
        (one.key, one.block, one.every, one.axis) == (other.key, other.block, other.every, other.axis)
        and one.block.rests(one.params) == other.block.rests(other.params)
        for one, other in zip(order, before, strict=True)
    )
