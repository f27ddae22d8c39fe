"""Boards abreast: up to ``WIDTH`` boards of one structure, a tick of all of them at a time.

The boards share blocks, wiring, intervals and choices. Each number of a board is next to the same number of the next
board, and ``core.compile`` compiles the steps for all of them at once. Each board gets the bits it gets alone. A board
that trips, or whose commands change which blocks run, cannot stay: it runs alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from core.block import FloatArray, IntArray
from core.board import lost, program
from core.board.facts import has_same_blocks
from core.board.filling import fill
from core.board.fold import NONE, SHIFTS, A, B, Words
from core.board.instances import instances
from core.board.lane import Lane
from core.board.pattern import Pattern, Uneven, is_same_structure
from core.board.pending import PendingQueue
from core.board.program import EVERY, walk
from core.board.spec import Spec
from core.board.wiring import Wiring
from core.compile.folding import folding
from core.compile.instructions import address_of, call
from core.compile.keeping import SLICE, keeping, sorting
from core.compile.machine import WIDTH
from core.kernel import kernel
from core.ports import RESERVED, TICK, TIME_MS

NOTHING: Mapping[str, Sequence[str]] = {}
ALIGNMENT = 8
"""Numbers of a cache line, at which rows of lanes begin."""


@kernel
def run(
    n: int,
    first_tick: int,
    dt_ms: float,
    table: IntArray,
    p: FloatArray,
    s: FloatArray,
    w: FloatArray,
    io: IntArray,
    fold: int,
    folds: Words,
    folded: IntArray,
    sizes: IntArray,
    keep: int,
    sort: int,
    rows: FloatArray,
    columns: IntArray,
    trace: FloatArray,
    ends: IntArray,
    shape: IntArray,
    trip: int,
) -> int:
    """Run up to ``n`` ticks of all boards; return how many ran, fewer when a board trips at the last of them.

    Parameters
    ----------
    p, s, w : ndarray, shape (numbers, WIDTH)
        Parameters, states and signals, a column for each board.
    fold : int
        Address of the code that folds a tick (``core.compile.folding``).
    folds, folded, sizes : ndarray
        The folds, the places of the outputs that count, and how many these are and all outputs.
    keep, sort : int
        Addresses of the code that keeps signals of a tick, and sorts a slice of them (``core.compile.keeping``).
    rows, columns, ends : ndarray
        Where signals and sums are kept, shape (SLICE, kept, WIDTH), the places of the signals, and the number of rows
        followed by where the places of each begin and end.
    trace : ndarray, shape (kept, WIDTH, ticks)
        Where they go, sorted by board, a slice of ticks at a time; the ticks after the last slice stay in ``rows``.
    shape : ndarray
        How many are kept, and the ticks of the trace.
    """
    p_address, s_address, w_address, io_address = address_of(p), address_of(s), address_of(w), address_of(io)
    fold_address, folded_address, size_address = address_of(folds), address_of(folded), address_of(sizes)
    row_address, column_address, trace_address = address_of(rows), address_of(columns), address_of(trace)
    end_address, shape_address, row_size = address_of(ends), address_of(shape), 8 * WIDTH * rows.shape[1]
    for i in range(n):
        tick = first_tick + i
        for k in range(WIDTH):
            w[TICK, k] = tick
            w[TIME_MS, k] = tick * dt_ms
        walk(table, tick, WIDTH, p_address, s_address, w_address, io_address)
        call(fold, w_address, fold_address, folded_address, size_address)
        row = tick % SLICE
        call(keep, w_address, row_address + row * row_size, column_address, end_address)
        if row == SLICE - 1:
            call(sort, row_address, trace_address + 8 * (tick - row), column_address, shape_address)
        tripped = False
        for k in range(WIDTH):
            tripped = tripped or w[trip, k] != 0.0
        if tripped:
            return i + 1
    return n


class Abreast:
    """Boards of one structure, run together.

    Parameters
    ----------
    pattern : Pattern
        Their blocks, wiring and intervals.
    specs : sequence of Spec
        The bench of each, at most ``WIDTH``.
    pending : sequence of Queue
        The commands that wait, of each.
    columns : sequence of str
        The signals to keep.
    samples : int
        Ticks of the longest run.
    sums : mapping
        The sums of signals to keep in addition, by name.

    Raises
    ------
    Uneven
        When they are not of one structure.
    """

    def __init__(
        self,
        pattern: Pattern,
        specs: Sequence[Spec],
        pending: Sequence[PendingQueue],
        columns: Sequence[str],
        samples: int,
        sums: Mapping[str, Sequence[str]] = NOTHING,
    ) -> None:
        self._pattern = pattern
        wiring = pattern.board.wiring
        self._p, self._s, self._w = (lanes_of(array, WIDTH)[0] for array in (wiring.p, wiring.s, wiring.w))
        self._folds = np.repeat(pattern.board.folds[:, :, None], WIDTH, axis=2)
        parts: dict[str, Sequence[str]] = {**{name: (name,) for name in columns}, **sums}
        self._columns = np.array([wiring.index[name] for own in parts.values() for name in own], dtype=np.int64)
        self._ends = np.array([len(parts), *np.cumsum([0, *map(len, parts.values())])], dtype=np.int64)
        self._trace = np.empty((len(parts), WIDTH, samples))
        self._rows = np.empty((SLICE, len(parts), WIDTH))
        self._shape = np.array([len(parts), samples], dtype=np.int64)
        self._folded = pattern.folded + RESERVED
        self._sizes = np.array([len(self._folded), self._folds.shape[1]], dtype=np.int64)
        self._fold = folding((A, B), SHIFTS, NONE, RESERVED)
        self._names, self._trip = list(parts), wiring.trip
        self.boards: list[Lane] = []
        self._leaders: list[Lane] = []
        self._read, self._packed = {**pattern.read}, set[int]()
        for lane, (spec, queue) in enumerate(zip(specs, pending, strict=True)):
            self.boards.append(self._board(lane, spec, queue))
        for lane in range(len(self.boards), WIDTH):  # lanes without a board follow the first
            for array in (self._p, self._s, self._w):
                array[:, lane] = array[:, 0]
        self.tick = 0
        self._table: IntArray = np.empty(0, dtype=np.int64)
        self._io = self.boards[0].wiring.io
        self._link()

    def _board(self, lane: int, spec: Spec, queue: PendingQueue) -> Lane:
        """Return the board of a lane; it takes the numbers that are alike from the board of the lane before."""
        pattern, before = self._pattern, self.boards[-1] if self.boards else self._pattern.board
        p, s, w = self._p[:, lane], self._s[:, lane], self._w[:, lane]
        order = before.wiring.instances
        if spec.faults is not before.spec.faults or not has_same_blocks(spec, before.spec):
            order = instances(spec)
            if not is_same_structure(pattern.board, spec, order):
                raise Uneven("another structure")
        course = pattern.courses.of(queue)
        leader = next((one for one in self._leaders if one.course is course), None)
        wiring = apart(pattern.board.wiring) if leader is None else leader.wiring
        wiring = replace(wiring, instances=[*order], p=p, s=s, w=w)
        fill(wiring, spec, before.wiring, before.spec, self._read, self._packed)
        board = Lane(spec, wiring, self._folds[:, :, lane], queue, course, leader)
        if leader is None:
            self._leaders.append(board)
        return board

    def run(self, samples: int) -> list[bool]:
        """Run all boards to the end; return for each board whether it reached the end without a trip.

        Raises
        ------
        Uneven
            When commands have made their structures different.
        """
        tripped = [False] * len(self.boards)
        for board in self._leaders:
            board.use()
        while self.tick < samples and not all(tripped):
            moments = [board.pending.next_tick for board in self._leaders]
            if self.tick in moments:
                for board in self._leaders:
                    board.carry_out_due()
                    board.use()
                self._link()
                moments = [board.pending.next_tick for board in self._leaders]
            look = lost.next_look(self.tick)
            end = min([samples, look, *(moment for moment in moments if moment is not None)])
            ran = self._run(end - self.tick)
            self.tick += ran
            for board in self.boards:
                board.tick = self.tick
            stopped = self._w[self._trip, : len(self.boards)] != 0.0
            if self.tick == look and not np.isfinite(self._s).all():
                stopped |= [bool(lost.lost(board.wiring, board.spec)) for board in self.boards]
            tripped = [before or now for before, now in zip(tripped, stopped.tolist(), strict=True)]
            self._silence(tripped)
        for board in self._leaders:
            board.tell_faults()
        rest = self.tick % SLICE
        self._trace[:, :, self.tick - rest : self.tick] = self._rows[:rest].transpose(1, 2, 0)
        return [not gone for gone in tripped]

    def trace(self, lane: int) -> dict[str, FloatArray]:
        """Return the signals and sums kept of a board, by name."""
        return {name: self._trace[column, lane, : self.tick] for column, name in enumerate(self._names)}

    def _run(self, n: int) -> int:
        arrays = (self._table, self._p, self._s, self._w, self._io, self._fold, self._folds, self._folded, self._sizes)
        kept = keeping(), sorting(), self._rows, self._columns, self._trace, self._ends, self._shape
        return int(run(n, self.tick, self.boards[0].dt_ms, *arrays, *kept, self._trip))

    def _silence(self, tripped: list[bool]) -> None:
        """Let the lane of a tripped board follow the lane of a board that has not tripped."""
        if True not in tripped or False not in tripped:
            return
        going = tripped.index(False)
        for lane in [*(i for i, gone in enumerate(tripped) if gone), *range(len(tripped), WIDTH)]:
            for array in (self._p, self._s, self._w):
                array[:, lane] = array[:, going]

    def _link(self) -> None:
        """Work out which rows run now, the same for all boards."""
        first = self._leaders[0].wiring
        for board in self._leaders:
            wiring = board.wiring
            if not np.shares_memory(wiring.p, self._p):
                raise Uneven("a block was exchanged")
            running = board.rest()
            if wiring is first:
                rows = running
            elif running != rows or not np.array_equal(wiring.io, first.io):
                raise Uneven("other blocks run")
            elif not np.array_equal(wiring.table[:, EVERY], first.table[:, EVERY]):
                raise Uneven("other intervals")
        shared = self._p[self._pattern.choices, : len(self.boards)]
        if not np.array_equal(shared.view(np.uint64), np.repeat(shared[:, :1], shared.shape[1], 1).view(np.uint64)):
            raise Uneven("other choices")
        self._io = first.io
        self._table = first.table[rows]
        self._table[:, program.ADDRESS] = [self._pattern.address(row) for row in rows]


def apart(wiring: Wiring) -> Wiring:
    """Return a wiring that a board may change."""
    return replace(
        wiring,
        io=wiring.io.copy(),
        table=wiring.table.copy(),
        unread=[*wiring.unread],
        absent=[*wiring.absent],
        resting={*wiring.resting},
    )


def lanes_of(array: FloatArray, width: int, groups: int = 1) -> FloatArray:
    """Return for each group an array with a column for each board, its rows at the beginning of a cache line."""
    size = array.size * width * groups
    room = np.empty(size + ALIGNMENT)
    start = -(room.ctypes.data // 8) % ALIGNMENT
    found = room[start : start + size].reshape(groups, -1, width)
    found[:] = array[:, None]
    return found
