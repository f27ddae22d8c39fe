"""Boards that a program drives: it gives each a voltage, all of them run some ticks, and it reads the signals kept.

A tick is cut before the controller from outside: the steps up to there, then the voltage, then the rest. Each board has
ticks of its own. Boards at the same tick whose blocks run alike go abreast, the others by themselves, with the same
bits.
"""

from __future__ import annotations

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from core.block import FloatArray, IntArray
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
        self.width, self.fold = width, folding((A, B), SHIFTS, NONE, RESERVED) if width > 1 else 0
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


class BoardCourse(NamedTuple):
    """How a board runs until its next command: the number of its way, its rows, and the tick of the command."""

    way: int
    rows: tuple[int, ...]
    moment: int


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
    boards : list of Lane
        The boards; each is at its first tick until it has begun.
    counts : ndarray, shape (boards,)
        Ticks of the last frame that each has ended: fewer than all of them once it has tripped, in the last of these.
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
        self.counts = np.zeros(count, dtype=np.int64)
        self._has_begun = [False] * count
        self._ways: dict[Any, int] = {}
        self._tables: dict[Any, tuple[IntArray, int]] = {}
        self.boards = [self._board(place, pattern.board.spec, PendingQueue()) for place in range(count)]
        self._courses = [BoardCourse(-1, (), 0)] * count
        self._groups = [range(first, min(first + width, count)) for first in range(0, count, width)]

    @property
    def rows(self) -> FloatArray:
        """The signals kept at the ticks of the last frame, shape (ticks, signals, boards)."""
        rows = self._all.rows.transpose(1, 2, 0, 3)
        return rows.reshape(*rows.shape[:2], -1)[:, :, : len(self.boards)]

    def begin(self, place: int, spec: Spec, pending: PendingQueue) -> FloatArray:
        """Put a new board at a place, begin its first tick, and return the signals kept.

        Raises
        ------
        Uneven
            When it is not of the same structure.
        """
        self.boards[place] = self._board(place, spec, pending)
        self.counts[place], self._courses[place] = 0, BoardCourse(-1, (), 0)
        self._settle(place)
        self._alone(place)
        found: FloatArray = self.boards[place].wiring.w[self._columns]
        return found

    def _board(self, place: int, spec: Spec, pending: PendingQueue) -> Lane:
        first = self._pattern.board
        p, s, w, folds, _ = self._all.of(place)
        p[:], s[:], w[:], folds[:] = first.wiring.p, first.wiring.s, first.wiring.w, first.folds
        wiring = replace(apart(first.wiring), instances=instances(spec), p=p, s=s, w=w)
        if not is_same_structure(first, spec, wiring.instances):
            raise Uneven("another structure")
        fill(wiring, spec, first.wiring, first.spec, {**self._pattern.read}, set())
        return Lane(spec, wiring, folds, pending, Course())

    def advance(self, places: Sequence[int], voltages: FloatArray) -> None:
        """Hold a voltage at each of some boards for a frame of ticks, or until it trips.

        Raises
        ------
        InputError
            When an event exchanges a block.
        """
        for place, voltage in zip(places, voltages.tolist(), strict=True):
            self._all.s[place // self._all.width, self._asked, place % self._all.width] = voltage
        self.counts[places] = 0
        for parts in self._whole(places):
            self._run(self._all, [part[0] // self._all.width for part in parts], parts)
            self._end([place for part in parts for place in part])
        while rest := [place for place in places if self._goes_on(place)]:
            groups: dict[Any, list[int]] = defaultdict(list)
            for place in rest:
                moment = self.boards[place].tick, self.counts[place], self._has_begun[place]
                groups[*moment, self._courses[place].way, place // self._all.width].append(place)
            for part in groups.values():
                self._advance(part)

    def _whole(self, places: Sequence[int]) -> Iterable[list[list[int]]]:
        """Return groups without a command in this frame, those together that are at the same tick."""
        wanted, found = {*places}, defaultdict(list)
        for group in self._groups:
            ticks = {self.boards[place].tick for place in group}
            ways = {self._courses[place].way for place in group}
            moment = min([self._courses[place].moment for place in group])
            is_alike = len(ticks) == len(ways) == 1 and len(group) >= min(FEWEST, self._all.width)
            if is_alike and min(ticks) + self._frame < moment and wanted.issuperset(group):
                found[ticks.pop(), ways.pop(), len(group)].append(group)
        return found.values()

    def _goes_on(self, place: int) -> bool:
        is_whole = self.counts[place] == self._frame and self._has_begun[place]
        return not is_whole and self.boards[place].trip is None

    def _advance(self, part: list[int]) -> None:
        """Run boards of one group that are at the same tick; the columns of the others stay as they are."""
        if len(part) < FEWEST:
            for place in part:
                self._alone(place)
            return
        number = part[0] // self._all.width
        others = [place for place in self._groups[number] if place not in part]
        for i, place in enumerate(others):
            self._all.copy(place, self._saved, i)
        choices = self._pattern.choices  # read from the first column for all
        self._all.p[number, choices, 0] = self._all.of(part[0])[0][choices]
        self._run(self._all, [number], [part])
        for i, place in enumerate(others):
            self._saved.copy(i, self._all, place)
        self._end(part)

    def _alone(self, place: int) -> None:
        """Run a board by itself."""
        if self._all.width == 1:
            self._run(self._all, [place], [[place]])
        else:
            self._all.copy(place, self._one, 0)
            self._run(self._one, [0], [[place]])
            self._one.copy(0, self._all, place)
        self._end([place])

    def _run(self, numbers: SideBySide, groups: list[int], parts: list[list[int]]) -> None:
        """Run boards at the same tick to the end of the frame, to the next command, or to a trip; or begin a tick.

        ``parts`` has the boards of each group.
        """
        one = parts[0][0]
        first, at = self.boards[one], int(self.counts[one])
        table, cut = self._table(numbers.width, parts)
        of_groups = np.array(groups, dtype=np.int64)
        arrays = table, cut, numbers.p, numbers.s, numbers.w, first.wiring.io, numbers.rows, self._columns
        if not self._has_begun[one]:
            begin(of_groups, first.tick, first.dt_ms, *arrays, max(0, at - 1))
            for place in parts[0]:
                self._has_begun[place] = True
            return
        halt = min([self._courses[place].moment for part in parts for place in part])
        n = min(self._frame - at, halt - first.tick)
        halts = first.tick + n == halt
        columns = np.array([place % numbers.width for place in parts[0]], dtype=np.int64)
        ran = np.empty(len(groups), dtype=np.int64)
        folds = numbers.fold, numbers.folds, self._folded, self._sizes
        go(of_groups, n, halts, first.tick, first.dt_ms, *arrays, at, *folds, columns, self._trip, ran)
        trips = numbers.w[of_groups[:, None], self._trip, columns].any(axis=1).tolist()
        for part, own, trip in zip(parts, ran.tolist(), trips, strict=True):
            self.counts[part] += own
            for place in part:
                self.boards[place].tick += own
                self._has_begun[place] = not (halts or trip)

    def _end(self, places: list[int]) -> None:
        """Let boards between two ticks trip, or carry out their commands."""
        for place in places:
            if self._has_begun[place]:
                continue
            board = self.boards[place]
            if board.wiring.w[self._trip] != 0.0:
                self._stop(board, *changes.cause(board))
            elif board.tick == lost.next_look(board.tick - 1) and (block := lost.lost(board.wiring, board.spec)):
                self._stop(board, f"the state of {block} is not finite")
            else:
                self._settle(place)

    @staticmethod
    def _stop(board: Lane, text: str, signal: str = "") -> None:
        reason, time_ms = text.format(signal=signal), board.tick * board.dt_ms
        board.trip = Trip(tick=board.tick, time_ms=time_ms, reason=reason, signal=signal, value=None)

    def _settle(self, place: int) -> None:
        """Carry out the commands of a tick that is about to begin, and note how the board runs until the next ones."""
        board = self.boards[place]
        try:
            if board.pending.next_tick == board.tick:
                board.carry_out_due()
            if not np.shares_memory(board.wiring.p, self._all.p):
                raise Uneven("a block was exchanged")
        except Uneven:
            raise InputError("an event exchanges a block, which no program can drive through", "events") from None
        board.use()
        wiring, course = board.wiring, self._courses[place]
        way, rows = course.way, course.rows
        if way < 0 or wiring.is_changed:
            rows = tuple(board.rest())
            needed = tuple(row for row in rows if row not in self._optional)
            every, choices = wiring.table[:, program.EVERY], wiring.p[self._pattern.choices]
            way = self._number((needed, wiring.io.tobytes(), every.tobytes(), choices.tobytes()))
        moment = lost.next_look(board.tick)
        if board.pending.next_tick is not None:
            moment = min(moment, board.pending.next_tick)
        self._courses[place] = BoardCourse(way, rows, moment)
        self._has_begun[place] = False

    def _number(self, way: Any) -> int:
        return self._ways.setdefault(way, len(self._ways))

    def _table(self, width: int, parts: list[list[int]]) -> tuple[IntArray, int]:
        """Return the rows that run on any of some boards; a fault without severity changes no bit of the others."""
        courses = {self._courses[place][:2] for part in parts for place in part}
        key = width, frozenset(courses)
        if key not in self._tables:
            rows = sorted({row for _, own in courses for row in own})
            table = self.boards[parts[0][0]].wiring.table[rows]
            first = self._pattern.board.wiring
            table[:, program.ADDRESS] = [steps.address(first, row, width) for row in rows]
            self._tables[key] = table, bisect_left(rows, self._cut)
        return self._tables[key]
