"""The segments of a board: rows of its table that run as one function, between rows that run by themselves.

A fault comes and goes while a board runs, and a unit that a document carries may be behind the wall: such a row stays
by itself, and a segment ends before it whether it runs or not. So no fault makes another segment. Ports that a switch
changes are read from memory, so that no switch does either.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, groupby
from typing import NamedTuple
from weakref import WeakValueDictionary

import numpy as np

from core.block import Block, IntArray
from core.board.program import ADDRESS, COLUMNS, EVERY
from core.board.wiring import Wiring
from core.compile.machine import LoadedCode
from core.compile.segment import Segment, SegmentStep
from core.faults.fault import Fault


class SharedSegment:
    """A segment, which all boards of this process with the same rows share.

    Parameters
    ----------
    steps : tuple
        Its steps.
    """

    def __init__(self, steps: Segment) -> None:
        self.steps, self.address = steps, 0
        """Its steps, and where its function is: 0 as long as its code is not loaded."""
        self._codes: list[LoadedCode] = []  # all of them: a board may run any

    def load(self, code: bytes) -> None:
        """Load its machine code; every board takes it at a tick edge."""
        self._codes.append(LoadedCode(code))
        self.address = self._codes[-1].address


class TablePart(NamedTuple):
    """Rows that follow one another in the table of a board, and the segment that they are, if they are one."""

    rows: slice
    segment: SharedSegment | None


_shared: WeakValueDictionary[Segment, SharedSegment] = WeakValueDictionary()


def parts(wiring: Wiring, running: Sequence[int]) -> list[TablePart]:
    """Return the parts of the table of a board on which these rows run."""
    alone = [_is_alone(instance.block) for instance in wiring.instances]
    before = [*accumulate(alone)]
    found, first = list[TablePart](), 0
    for (_, by_themselves), group in groupby(running, lambda row: (before[row], alone[row])):
        rows = [*group]
        is_segment = len(rows) > 1 and not by_themselves
        found.append(TablePart(slice(first, first + len(rows)), _segment(wiring, rows) if is_segment else None))
        first += len(rows)
    return found


def joined(table: IntArray, parts: Sequence[TablePart]) -> IntArray:
    """Return a table with one row in place of the rows of each segment whose code is loaded."""
    return np.concatenate([table[:0], *(_joined(table[part.rows], part.segment) for part in parts)])


def _joined(rows: IntArray, segment: SharedSegment | None) -> IntArray:
    if segment is None or not segment.address:
        return rows
    row = np.zeros((1, COLUMNS), dtype=np.int64)
    row[0, ADDRESS], row[0, EVERY] = segment.address, 1
    return row


def _is_alone(block: type[Block]) -> bool:
    return issubclass(block, Fault) or bool(block.text)


def _segment(wiring: Wiring, rows: Sequence[int]) -> SharedSegment:
    steps = tuple(_step(wiring, row) for row in rows)
    found = _shared.get(steps)
    if found is None:
        found = _shared[steps] = SharedSegment(steps)
    return found


def _step(wiring: Wiring, row: int) -> SegmentStep:
    block, (_, p, s, io, every) = wiring.instances[row].block, wiring.table[row].tolist()
    ports = enumerate(zip(block.Ports.declared, wiring.ports(row).tolist(), strict=True))
    # a switch rewires the ports whose sources begin with @
    known = tuple((number, place) for number, (port, place) in ports if not port.source.startswith("@"))
    return SegmentStep(block, every, p, s, io, known)
