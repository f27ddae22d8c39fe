"""A board and its twin in C on the same ticks: the cost of each, and the parts in which they differ."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator, Mapping

import numpy as np

from core.board import fold, program
from core.board.board import CHUNK, Board
from core.board.history import History
from core.board.observer import follow
from scenarios.speed.anchor.difference import differences, same
from scenarios.speed.anchor.twin import ROOM, Twin
from scenarios.speed.boards import HISTORY_MB
from scenarios.speed.timing import cpu_ns, must_run

TICKS = 40 * CHUNK
"""Ticks of one measurement."""
OURS, C = "ours", "c"
Costs = Mapping[str, Callable[[], float]]


class TwinPair:
    """A board and its twin, both from the same tick on.

    Parameters
    ----------
    board : Board
        A board that is copied, and does not change.
    library : ctypes.CDLL, optional
        The C of the board; without it only the board is measured.
    """

    part = "steps"
    goal = 1.10
    """How many times the C the board may take."""

    def __init__(self, board: Board, library: ctypes.CDLL | None) -> None:
        self.board = Board.restore(board.checkpoint())
        self.twin = Twin(library, board) if library else None

    def costs(self) -> Costs:
        """Return the measurements of a tick, ns: of the board, and of its twin."""
        found = {OURS: lambda: self._cost(self._run_board)}
        return {**found, C: lambda: cpu_ns(self._run_twin, TICKS)} if self.twin else found

    def _cost(self, run: Callable[[], None]) -> float:
        cost = cpu_ns(run, TICKS)
        must_run(self.board)
        return cost

    def _run_board(self) -> None:
        raise NotImplementedError

    def _run_twin(self) -> None:
        raise NotImplementedError

    def differences(self) -> Iterator[str]:
        """Name the parts in which the board and its twin differ now."""
        if self.twin is not None:
            yield from self._differences(self.twin)

    def _differences(self, twin: Twin) -> Iterator[str]:
        yield from differences(self.board, twin)


class StepsPair(TwinPair):
    """The steps alone, by the table that the board walks."""

    def _run_board(self) -> None:
        board, wiring, nothing = self.board, self.board.wiring, np.zeros((TICKS, 0))
        arrays = board.walk.table, wiring.p, wiring.s, wiring.w, wiring.io
        watches = np.zeros((0, 3))
        program.run(TICKS, 1, board.dt_ms, *arrays, nothing, nothing, fold.begin(0), wiring.trip, watches)

    def _run_twin(self) -> None:
        assert self.twin is not None
        self.twin.steps(TICKS, 1)


class AdvancePair(TwinPair):
    """Steps, rows, digest, and the comparisons of the observer."""

    part = "advance"
    goal = 1.15

    def _run_board(self) -> None:
        for _ in range(TICKS // CHUNK):
            self.board.advance(CHUNK)

    def _run_twin(self) -> None:
        assert self.twin is not None
        for _ in range(TICKS // CHUNK):
            self.twin.advance(CHUNK)

    def _differences(self, twin: Twin) -> Iterator[str]:
        """Run a chunk more, whose rows are compared too."""
        observer, changes = self.board.observer, np.zeros((ROOM, 2), dtype=np.int64)
        last, first = observer.seen()[0], self.board.tick
        twin.changes()
        twin.advance(CHUNK)
        rows = self.board.advance(CHUNK)
        yield from [] if same(rows.outputs, twin.outputs) and same(rows.taps, twin.taps) else ["rows"]
        found = follow(rows.outputs, rows.taps, observer._columns, last, changes)
        seen = [(first + row, column) for column, row in changes[:found].tolist()]
        yield from [] if seen == twin.changes() else ["changes that the observer sees"]
        yield from differences(self.board, twin)


class LivePair(AdvancePair):
    """The same with the history, which is full: before, the system hands out its memory page by page."""

    part = "live tick"

    def __init__(self, board: Board, library: ctypes.CDLL | None) -> None:
        super().__init__(board, library)
        outputs, taps = board.signals.outputs, len(board.signals.taps)
        capacity = History.ticks_within(HISTORY_MB, outputs, taps)
        self.history, of_twin = (History(outputs, taps, capacity) for _ in range(2))
        self.twin = Twin(library, board, of_twin) if library else None
        while self.board.tick < board.tick + self.history.capacity:
            self._run_board()
            if self.twin is not None:
                self._run_twin()

    def _run_board(self) -> None:
        for _ in range(TICKS // CHUNK):
            self.board.advance_into(self.history, CHUNK)

    def _run_twin(self) -> None:
        assert self.twin is not None
        for _ in range(TICKS // CHUNK):
            self.twin.live(CHUNK)

    def _differences(self, twin: Twin) -> Iterator[str]:
        yield from differences(self.board, twin)
        for name, part in {"ring": "history", "low": "minima", "high": "maxima", "steady": "idle groups"}.items():
            yield from [] if same(getattr(self.history, f"_{name}"), twin.arrays[name]) else [part]
