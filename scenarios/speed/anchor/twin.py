"""A board in C: numbers of its own in the same places as the numbers of the board that it begins like."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray
from core.board.board import CHUNK, Board
from core.board.history import History
from core.board.pyramid import LANES
from scenarios.speed.anchor.text import BoardMoment

Array = NDArray[Any]
ROOM = 4096
"""Changes of watched columns that are written down at most between two looks."""


class _BoardInC(ctypes.Structure):
    """The same as in ``board.c``."""

    _fields_ = (
        ("dt_ms", ctypes.c_double),
        *((name, ctypes.c_void_p) for name in ("p", "s", "w", "io", "on", "endless", "folds")),
        *((name, ctypes.c_int64) for name in ("watched", "room", "found")),
        *((name, ctypes.c_void_p) for name in ("columns", "last", "changes", "ring", "low", "high", "steady")),
        ("places", ctypes.c_int64),
        *((name, ctypes.c_void_p) for name in ("idle", "offsets", "sizes")),
    )


class Twin:
    """A board in C.

    Parameters
    ----------
    library : ctypes.CDLL
        The C of this board.
    board : Board
        The board at this moment; it does not change.
    history : History, optional
        An empty history, which the C fills.
    """

    def __init__(self, library: ctypes.CDLL, board: Board, history: History | None = None) -> None:
        self._library, self.tick = library, board.tick
        self.has_stopped = False
        """Whether it ran fewer ticks than it was asked for, because it tripped or lost a state."""
        for function in (library.steps, library.advance, library.live):
            function.restype = ctypes.c_int64
        moment, observer = BoardMoment.of(board), board.checkpoint().parts["observer"]
        wiring, outputs, taps = moment.wiring, board.signals.outputs, len(board.signals.taps)
        history = history or History(outputs, taps, 0)
        self._groups = -(-outputs // LANES)
        idle = [False] * self._groups
        idle += [bool(part.all()) for part in np.split(wiring.idle([*moment.running]), range(LANES, taps, LANES))]
        self._shift = (observer._columns >= outputs) * (self._groups * LANES - outputs)
        self.arrays: dict[str, Array] = {
            **{name: getattr(wiring, name) for name in ("p", "s", "w", "io", "endless")},
            **{name: getattr(history, f"_{name}") for name in ("ring", "low", "high", "steady", "offsets", "sizes")},
            "on": moment.on,
            "idle": np.array(idle),
            "folds": board.folds.copy(),
            "columns": observer._columns + self._shift,
            "last": observer._last,
            "changes": np.zeros((ROOM, 2), dtype=np.int64),
        }
        self._board = _BoardInC(
            dt_ms=board.dt_ms, watched=len(self._shift), room=ROOM, found=0, places=history.capacity
        )
        for name, array in self.arrays.items():
            setattr(self._board, name, array.ctypes.data)
        self._rows = np.zeros((CHUNK, len(idle) * LANES))
        self.outputs: FloatArray = self._rows[:, :outputs]
        self.taps: FloatArray = self._rows[:, self._groups * LANES :][:, :taps]

    def steps(self, ticks: int, first: int) -> None:
        """Run the steps alone."""
        self._ran(ticks, self._library.steps(self._at, ctypes.c_int64(ticks), ctypes.c_int64(first)))

    def advance(self, ticks: int) -> None:
        """Run up to `CHUNK` ticks with all that ``Board.advance`` does; ``outputs`` and ``taps`` have their rows."""
        rows = ctypes.c_void_p(self._rows.ctypes.data)
        self._ran(ticks, self._library.advance(self._at, ctypes.c_int64(ticks), ctypes.c_int64(self.tick), rows))

    def live(self, ticks: int) -> None:
        """Run whole chunks with their history, as a live bench does."""
        self._ran(ticks, self._library.live(self._at, ctypes.c_int64(ticks), ctypes.c_int64(self.tick)))

    @property
    def _at(self) -> Any:
        return ctypes.byref(self._board)

    def _ran(self, asked: int, ran: int) -> None:
        self.has_stopped |= ran != asked
        self.tick += asked

    def changes(self) -> list[tuple[int, int]]:
        """Return the ticks at which watched signals changed, with the signals, since it was asked last."""
        found, self._board.found = self._board.found, 0
        shift = dict(zip(self.arrays["columns"].tolist(), self._shift.tolist(), strict=True))
        return [(tick, column - shift[column]) for column, tick in self.arrays["changes"][:found].tolist()]
