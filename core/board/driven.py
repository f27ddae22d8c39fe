"""Boards that a program drives: it gives each a voltage, all of them run some ticks, and it reads the signals kept.

A tick is cut before the controller from outside: the steps up to there, then the voltage, then the rest. Each board has
ticks of its own. Boards at the same tick whose blocks run alike go abreast, the others by themselves, with the same
bits.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Sequence
from typing import Any

import numpy as np

from core.block import BoolArray, FloatArray, IntArray
from core.board import changes, lost, program, steps
from core.board.abreast import apart, lanes_of
from core.board.board import Board
from core.board.commands import Trip
from core.board.course import Course
from core.board.document import Document
from core.board.driven_loop import begin, go
from core.board.filling import fill
from core.board.fold import NONE, SHIFTS, A, B
from core.board.instances import instances
from core.board.lane import Lane
from core.board.pattern import Pattern, Uneven, is_same_structure
from core.board.pending import PendingQueue
from core.board.spec import Spec
from core.compile.folding import folding
from core.compile.machine import WIDTH
from core.control.external import ExternalController
from core.errors import InputError
from core.faults.fault import Fault
from core.ports import RESERVED

FEWEST = 3
"""Boards that are worth the steps of many."""
KEY = ExternalController.name
DRIVEN: Document = {"controller.kind": KEY, f"controllers.{KEY}": {}}
"""Values of a bench that a program drives."""


class SideBySide:
    """Numbers of boards in groups, a column for each.

    Parameters
    ----------
    board : Board
        The board from which each column begins.
    groups, width : int
        Groups, and columns of each: 1 or ``WIDTH``.
    frame, kept : int
        Ticks and signals whose values have room.
    """

    def __init__(self, board: Board, groups: int, width: int, frame: int, kept: int) -> None:
        wiring = board.wiring
        self.groups, self.width = groups, width
        self.fold = folding((A, B), SHIFTS, NONE, RESERVED) if width > 1 else 0
        self.p, self.s, self.w = (lanes_of(array, width, groups) for array in (wiring.p, wiring.s, wiring.w))
        self.folds = np.tile(board.folds[:, :, None], (groups, 1, 1, width))
        self.rows = np.zeros((groups, frame, kept, width))

    def of(self, place: int) -> list[Any]:
        """Return the numbers of a board: parameters, state, signals, folds, kept signals."""
        group, column = divmod(place, self.width)
        return [array[group, ..., column] for array in (self.p, self.s, self.w, self.folds, self.rows)]

    def copy(self, place: int, to: SideBySide, other: int) -> None:
        """Copy the numbers of a board to a place among others."""
        for one, another in zip(self.of(place), to.of(other), strict=True):
            another[...] = one


class DrivenBoards:
    """Boards of one structure, which a program drives.

    Parameters
    ----------
    pattern : Pattern
        Their blocks, wiring and intervals, of a bench with the values `DRIVEN`.
    count : int
        Boards.
    frame : int
        Ticks for which a voltage is held.
    columns : sequence of str
        The signals to keep at the cut of each tick.

    Attributes
    ----------
    counts : ndarray, shape (boards,)
        Ticks of the last frame that each has ended: fewer than all of them once it has tripped, in the last of these.
    ticks : ndarray, shape (boards,)
        Where each is.
    gone : ndarray, shape (boards,)
        Whether it has tripped.
    """

    def __init__(self, pattern: Pattern, count: int, frame: int, columns: Sequence[str]) -> None:
        self._pattern, self._frame, wiring = pattern, frame, pattern.board.wiring
        width = WIDTH if count >= FEWEST else 1
        shape = width, frame, len(columns)
        self._all = SideBySide(pattern.board, -(-count // width), *shape)
        self._one = SideBySide(pattern.board, 1, 1, *shape[1:])
        self._saved = SideBySide(pattern.board, width, 1, *shape[1:])
        self._columns = np.array([wiring.index[name] for name in columns], dtype=np.int64)
        self._folded = pattern.folded + RESERVED
        self._sizes = np.array([len(self._folded), self._all.folds.shape[2]], dtype=np.int64)
        self._cut, self._trip = wiring.row(KEY), wiring.trip
        self._asked = int(wiring.table[self._cut, program.S_OFFSET])
        self._optional = {
            row
            for row, one in enumerate(wiring.instances)
            if issubclass(one.block, Fault) and not len(wiring.state_of(one.key))
        }
        self.counts, self.ticks = (np.zeros(count, dtype=np.int64) for _ in range(2))
        self.gone, self._has_begun = (np.zeros(count, dtype=np.bool_) for _ in range(2))
        self._ways, self._moments = (np.zeros(count, dtype=np.int64) for _ in range(2))
        self._runs = np.zeros(count, dtype=np.int64)
        self._known_runs: dict[tuple[int, ...], int] = {}
        self._known_ways: dict[Any, int] = {}
        self._tables: dict[Any, tuple[IntArray, int]] = {}
        self._boards = [self._board(place, pattern.board.spec, PendingQueue()) for place in range(count)]
        self._place_of = np.divmod(np.arange(count), width)
        members = np.arange(self._all.groups * width).reshape(-1, width)
        self._sizes_of_groups = np.minimum(members, count - 1)[:, -1] - members[:, 0] + 1
        self._members = np.minimum(members, count - 1)

    @property
    def boards(self) -> list[Lane]:
        """The boards; each is at its first tick until it has begun."""
        for board, tick in zip(self._boards, self.ticks.tolist(), strict=True):
            board.tick = tick
        return self._boards

    @property
    def rows(self) -> FloatArray:
        """The signals kept at the ticks of the last frame, shape (groups, ticks, signals, boards of a group)."""
        return self._all.rows

    def kept(self, places: IntArray) -> FloatArray:
        """Return the signals kept of some boards, shape (ticks, signals, boards)."""
        groups, columns = self._place_of
        found: FloatArray = self._all.rows[groups[places], :, :, columns[places]].transpose(1, 2, 0)
        return found

    def begin(self, place: int, spec: Spec, pending: PendingQueue) -> FloatArray:
        """Put a new board at a place, begin its first tick, and return the signals kept.

        Raises
        ------
        Uneven
            When it is not of the same structure.
        """
        self._boards[place] = self._board(place, spec, pending)
        self.counts[place] = self.ticks[place] = 0
        self._ways[place], self.gone[place] = -1, False
        self._settle(place)
        self._alone(place)
        found: FloatArray = self._boards[place].wiring.w[self._columns]
        return found

    def _board(self, place: int, spec: Spec, pending: PendingQueue) -> Lane:
        first = self._pattern.board
        p, s, w, folds, _ = self._all.of(place)
        p[:], s[:], w[:], folds[:] = first.wiring.p, first.wiring.s, first.wiring.w, first.folds
        wiring = apart(first.wiring).beside(instances(spec), p, s, w)
        if not is_same_structure(first, spec, wiring.instances):
            raise Uneven("another structure")
        fill(wiring, spec, first.wiring.instances, first.spec, self._pattern, {**self._pattern.read})
        return Lane(spec, wiring, folds, pending, Course())

    def advance(self, places: IntArray, voltages: FloatArray) -> None:
        """Hold a voltage at each of some boards for a frame of ticks, or until it trips.

        Raises
        ------
        InputError
            When an event exchanges a block.
        """
        groups, columns = self._place_of
        self._all.s[groups[places], self._asked, columns[places]] = voltages
        self.counts[places] = 0
        if len(places) == 1:
            place = int(places[0])
            while not (self.gone[place] or (self.counts[place] == self._frame and self._has_begun[place])):
                self._alone(place)
            return
        for numbers in self._whole(places):
            size = self._sizes_of_groups[numbers[0]]
            members = self._members[numbers, :size]
            self._run(self._all, numbers, members)
            self._end(members.ravel())
        while len(rest := places[~self._is_done(places)]):
            parts: dict[Any, list[int]] = defaultdict(list)
            for place in rest.tolist():
                moment = self.ticks[place], self.counts[place], self._has_begun[place]
                parts[*moment, self._ways[place], place // self._all.width].append(place)
            for part in parts.values():
                self._advance(part)

    def _is_done(self, places: IntArray) -> BoolArray:
        found: BoolArray = self.gone[places] | (self.counts[places] == self._frame) & self._has_begun[places]
        return found

    def _whole(self, places: IntArray) -> list[IntArray]:
        """Return the groups that have no command in this frame, those together that are at the same tick."""
        members = self._members
        wanted = np.zeros(len(self.counts), dtype=np.bool_)
        wanted[places] = True
        ticks, ways = self.ticks[members], self._ways[members]
        is_alike = ((ticks == ticks[:, :1]) & (ways == ways[:, :1]) & wanted[members]).all(axis=1)
        is_free = (ticks[:, 0] + self._frame < self._moments[members].min(axis=1)) & self._has_begun[members].all(
            axis=1
        )
        is_many = self._sizes_of_groups >= min(FEWEST, self._all.width)
        numbers = np.flatnonzero(is_alike & is_free & is_many)
        found: dict[Any, list[int]] = defaultdict(list)
        keys = zip(ticks[numbers, 0], ways[numbers, 0], self._sizes_of_groups[numbers], numbers, strict=True)
        for *key, number in keys:
            found[tuple(key)].append(int(number))
        return [np.array(one) for one in found.values()]

    def _advance(self, part: list[int]) -> None:
        """Run boards of one group that are at the same tick; the columns of the others stay as they are."""
        if len(part) < FEWEST:
            for place in part:
                self._alone(place)
            return
        number, width = part[0] // self._all.width, self._all.width
        size = self._sizes_of_groups[number]
        others = [place for place in self._members[number, :size].tolist() if place not in part]
        for i, place in enumerate(others):
            self._all.copy(place, self._saved, i)
        choices = self._pattern.choices  # read from the first column for all
        self._all.p[number, choices, 0] = self._all.p[number, choices, part[0] % width]
        self._run(self._all, np.array([number]), np.array([part]))
        for i, place in enumerate(others):
            self._saved.copy(i, self._all, place)
        self._end(np.array(part))

    def _alone(self, place: int) -> None:
        """Run a board by itself."""
        alone = np.array([[place]])
        if self._all.width == 1:
            self._run(self._all, alone[0], alone)
        else:
            self._all.copy(place, self._one, 0)
            self._run(self._one, np.zeros(1, dtype=np.int64), alone)
            self._one.copy(0, self._all, place)
        self._end(alone[0])

    def _run(self, numbers: SideBySide, groups: IntArray, parts: IntArray) -> None:
        """Run boards at the same tick to the end of the frame, to the next command, or to a trip; or begin a tick.

        ``parts`` has a row for each group, with boards of this group.
        """
        one = int(parts[0, 0])
        first, at, tick = self._boards[one], int(self.counts[one]), int(self.ticks[one])
        table, cut = self._table(numbers.width, parts)
        arrays = table, cut, numbers.p, numbers.s, numbers.w, first.wiring.io, numbers.rows, self._columns
        if not self._has_begun[one]:
            begin(groups, tick, first.dt_ms, *arrays, max(0, at - 1))
            self._has_begun[parts] = True
            return
        halt = int(self._moments[parts].min())
        n = min(self._frame - at, halt - tick)
        halts = tick + n == halt
        columns = parts[0] % numbers.width
        ran = np.empty(len(groups), dtype=np.int64)
        folds = numbers.fold, numbers.folds, self._folded, self._sizes
        go(groups, n, halts, tick, first.dt_ms, *arrays, at, *folds, columns, self._trip, ran)
        self.counts[parts] += ran[:, None]
        self.ticks[parts] += ran[:, None]
        if halts:
            self._has_begun[parts] = False
        else:
            trips = numbers.w[groups[:, None], self._trip, columns].any(axis=1)
            self._has_begun[parts] = ~trips[:, None]

    def _end(self, places: IntArray) -> None:
        """Let boards between two ticks trip, or carry out their commands."""
        for place in places[~self._has_begun[places]].tolist():
            board, tick = self._boards[place], int(self.ticks[place])
            board.tick = tick
            if board.wiring.w[self._trip] != 0.0:
                self._stop(place, *changes.cause(board))
            elif tick == lost.next_look(tick - 1) and (block := lost.lost(board.wiring, board.spec)):
                self._stop(place, f"the state of {block} is not finite")
            else:
                self._settle(place)

    def _stop(self, place: int, text: str, signal: str = "") -> None:
        board, reason = self._boards[place], text.format(signal=signal)
        board.trip = Trip(tick=board.tick, time_ms=board.tick * board.dt_ms, reason=reason, signal=signal, value=None)
        self.gone[place] = True

    def _settle(self, place: int) -> None:
        """Carry out the commands of a tick that is about to begin, and note how the board runs until the next ones."""
        board = self._boards[place]
        try:
            if board.pending.next_tick == board.tick:
                board.carry_out_due()
            if not np.shares_memory(board.wiring.p, self._all.p):
                raise Uneven("a block was exchanged")
        except Uneven:
            raise InputError("an event exchanges a block, which no program can drive through", "events") from None
        board.use()
        wiring = board.wiring
        if self._ways[place] < 0 or wiring.is_changed:
            running = tuple(board.rest())
            self._runs[place] = self._known_runs.setdefault(running, len(self._known_runs))
            needed = tuple(row for row in running if row not in self._optional)
            every, choices = wiring.table[:, program.EVERY], wiring.p[self._pattern.choices]
            way = needed, wiring.io.tobytes(), every.tobytes(), choices.tobytes()
            self._ways[place] = self._known_ways.setdefault(way, len(self._known_ways))
        moment = lost.next_look(board.tick)
        if board.pending.next_tick is not None:
            moment = min(moment, board.pending.next_tick)
        self._moments[place], self._has_begun[place] = moment, False

    def _table(self, width: int, parts: IntArray) -> tuple[IntArray, int]:
        """Return the rows that run on any of some boards; a fault without severity changes no bit of the others."""
        way = int(self._ways[parts[0, 0]])
        key = width, way, frozenset(self._runs[parts].ravel().tolist())
        if key not in self._tables:
            rows = sorted({row for running, number in self._known_runs.items() if number in key[2] for row in running})
            table = self._boards[parts[0, 0]].wiring.table[rows]
            first = self._pattern.board.wiring
            table[:, program.ADDRESS] = [steps.address(first, row, width) for row in rows]
            self._tables[key] = table, bisect_left(rows, self._cut)
        return self._tables[key]
