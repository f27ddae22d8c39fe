"""Boards abreast: up to ``WIDTH`` boards of one structure, a tick of all of them at a time.

The boards share blocks, wiring, intervals and choices. Each number of a board is next to the same number of the next
board, and ``core.compile`` compiles the steps for all of them at once. Each board gets the bits it gets alone. A board
that trips, or whose commands change which blocks run, cannot stay: it runs alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from core.block import FloatArray, IntArray
from core.board import lost, program
from core.board.course import CourseStep
from core.board.facts import has_same_blocks
from core.board.filling import fill
from core.board.fold import NONE, SHIFTS, A, B, Words
from core.board.instances import instances
from core.board.lane import Lane
from core.board.lane_traces import LaneTraces, at_a_line
from core.board.pattern import Pattern, Uneven, is_same_structure
from core.board.pending import PendingQueue
from core.board.program import EVERY, P_OFFSET, walk
from core.board.spec import Spec
from core.board.wiring import Wiring
from core.compile.folding import folding
from core.compile.instructions import address_of, call
from core.compile.keeping import SLICE
from core.compile.machine import WIDTH
from core.kernel import kernel
from core.ports import RESERVED, TICK, TIME_MS


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
    look: int,
) -> int:
    """Run up to ``n`` ticks of all boards; return how many ran.

    They are fewer when a board trips at the last of them, and when a state is not finite at a tick at which all states
    are examined.

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
    look : int
        Ticks between two looks at all states.
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
        stopped = False
        for k in range(WIDTH):
            stopped = stopped or w[trip, k] != 0.0
        if (tick + 1) % look == 0:
            for number in range(s.shape[0]):
                for k in range(WIDTH):
                    stopped = stopped or not math.isfinite(s[number, k])
        if stopped:
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
        The commands that wait, of each; boards may share a queue.
    traces : LaneTraces
        The signals to keep.

    Raises
    ------
    Uneven
        When they are not of one structure.
    """

    def __init__(
        self, pattern: Pattern, specs: Sequence[Spec], pending: Sequence[PendingQueue], traces: LaneTraces
    ) -> None:
        self._pattern, self._traces = pattern, traces
        wiring = pattern.board.wiring
        self._p, self._s, self._w = (lanes_of(array, WIDTH)[0] for array in (wiring.p, wiring.s, wiring.w))
        self._folds = np.repeat(pattern.board.folds[:, :, None], WIDTH, axis=2)
        self._folded = pattern.folded + RESERVED
        self._sizes = np.array([len(self._folded), self._folds.shape[1]], dtype=np.int64)
        self._fold = folding((A, B), SHIFTS, NONE, RESERVED)
        self._trip = wiring.trip
        self.boards: list[Lane] = []
        self._leaders: dict[int, Lane] = {}
        self._read = {**pattern.read}
        for spec, queue in zip(specs, pending, strict=True):
            self.boards.append(self._board(len(self.boards), spec, queue.copy()))
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
        if lane:
            p[:], s[:] = self._p[:, lane - 1], self._s[:, lane - 1]
        order = before.wiring.instances
        if spec.faults is not before.spec.faults or not has_same_blocks(spec, before.spec):
            order = instances(spec)
            if not is_same_structure(pattern.board, spec, order):
                raise Uneven("another structure")
        course = pattern.courses.of(queue)
        leader = self._leaders.get(id(course))
        wiring = apart(pattern.board.wiring) if leader is None else leader.wiring
        wiring = wiring.beside(order, p, s, w)
        fill(wiring, spec, before.wiring.instances, before.spec, pattern, self._read)
        board = Lane(spec, wiring, self._folds[:, :, lane], queue, course, leader)
        self._leaders.setdefault(id(course), board)
        return board

    def run(self, samples: int) -> list[bool]:
        """Run all boards to the end; return for each board whether it reached the end without a trip.

        Raises
        ------
        Uneven
            When commands have made their structures different.
        """
        tripped = [False] * len(self.boards)
        leaders = self._leaders.values()
        for board in leaders:
            board.use()
        while self.tick < samples and not all(tripped):
            if any(board.pending.next_tick == self.tick for board in leaders):
                self._carry_out_due()
            moments = [board.pending.next_tick for board in leaders]
            end = min([samples, *(moment for moment in moments if moment is not None)])
            self.tick += self._run(end - self.tick)
            for board in self.boards:
                board.tick = self.tick
            stopped = self._w[self._trip, : len(self.boards)] != 0.0
            if self.tick % lost.EVERY == 0 and not np.isfinite(self._s).all():
                stopped |= [bool(lost.lost(board.wiring, board.spec)) for board in self.boards]
            tripped = [before or now for before, now in zip(tripped, stopped.tolist(), strict=True)]
            self._silence(tripped)
        for board in leaders:
            board.tell_faults()
        self._traces.end(self.tick)
        return [not gone for gone in tripped]

    def trace(self, lane: int) -> dict[str, FloatArray]:
        """Return the signals and sums kept of a board, by name."""
        return self._traces.columns(lane, self.tick)

    def _run(self, n: int) -> int:
        arrays = (self._table, self._p, self._s, self._w, self._io, self._fold, self._folds, self._folded, self._sizes)
        rest: Any = *arrays, *self._traces.arguments, self._trip, lost.EVERY
        return int(run(n, self.tick, self.boards[0].dt_ms, *rest))

    def _silence(self, tripped: list[bool]) -> None:
        """Let the lane of a tripped board follow the lane of a board that has not tripped."""
        if True not in tripped or False not in tripped:
            return
        going = tripped.index(False)
        for lane in [*(i for i, gone in enumerate(tripped) if gone), *range(len(tripped), WIDTH)]:
            for array in (self._p, self._s, self._w):
                array[:, lane] = array[:, going]

    def _carry_out_due(self) -> None:
        """Carry out the commands that are due at this tick on any board."""
        is_known = len(self._leaders) == 1
        for board in self._leaders.values():
            step, lanes = board.carry_out_due()
            is_known = self._take(step, lanes) and step.running is not None and is_known
            board.use()
        self._link(is_known=is_known)

    def _take(self, step: CourseStep, lanes: Sequence[Lane]) -> bool:
        """Let lanes take over changed rows: the same numbers, unless the facts that they are made of differ.

        Return whether all lanes have the same numbers.
        """
        are_same = True
        for row in step.rows:
            is_shared = row.read <= self._pattern.facts and row.read.isdisjoint(self._pattern.varied)
            apart = [] if is_shared else [one for one in lanes if not one.shares(row)]
            start = int(self._pattern.board.wiring.table[row.number, P_OFFSET])
            if len(lanes) == len(self.boards):
                self._p[start : start + len(row.numbers)] = row.numbers[:, None]
            for lane in lanes:
                lane.wiring.instances[row.number] = row.instance
                if len(lanes) < len(self.boards):
                    lane.wiring.p[start : start + len(row.numbers)] = row.numbers
            for lane in apart:
                lane.pack(row)
            are_same = are_same and not apart
        return are_same

    def _link(self, *, is_known: bool = False) -> None:
        """Work out which rows run now, the same for all boards; of a known step nothing needs to be compared."""
        leaders = [*self._leaders.values()]
        first, rows = leaders[0].wiring, leaders[0].rest()
        if not is_known:
            for board in leaders:
                wiring = board.wiring
                if not np.shares_memory(wiring.p, self._p):
                    raise Uneven("a block was exchanged")
                if wiring is not first and (board.rest() != rows or not np.array_equal(wiring.io, first.io)):
                    raise Uneven("other blocks run")
                if not np.array_equal(wiring.table[:, EVERY], first.table[:, EVERY]):
                    raise Uneven("other intervals")
            shared = self._p[self._pattern.choices, : len(self.boards)].view(np.uint64)
            if not (shared == shared[:, :1]).all():
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
    found = at_a_line((groups, array.size, width))
    found[:] = array[:, None]
    return found
