"""A recording in the place of a board: it reads the same ticks and signals from its file and computes nothing."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from core.board.board import Board
from core.board.document import Document
from core.board.pending import PendingQueue
from core.board.rows import Rows
from core.board.spec import Section, Spec
from core.errors import InputError
from core.signals import Signal, SignalTable
from scenarios.arrow import pq
from server.store.recording import first_tick

REFUSAL = "this bench plays a recording"


class Tape:
    """Takes the place of a board and advances by reading a recording.

    Parameters
    ----------
    board : Board
        Built from the scenario of the recording; gives its signals and blocks.
    path : Path
        The file of the recording.
    only : collection of str, optional
        Reads these signals alone.
    """

    def __init__(self, board: Board, path: Path, only: Collection[str] | None = None) -> None:
        self._board = board
        self._file = pq.ParquetFile(path)
        recorded = set(self._file.schema_arrow.names)
        names = [signal.name for signal in board.signals]
        self._columns = [(at, name) for at, name in enumerate(names) if name in recorded]
        if only is not None:
            self._columns = [(at, name) for at, name in self._columns if name in only]
        if not self._columns:
            raise InputError("has no signal this version knows", "recording")
        self._width, self._outputs = len(names), board.signals.outputs
        self.first = self.tick = first_tick(path)
        self.end = self.first + self._file.metadata.num_rows
        sizes = [self._file.metadata.row_group(i).num_rows for i in range(self._file.num_row_groups)]
        self._edges = self.first + np.concatenate([[0], np.cumsum(sizes)])
        self._group: tuple[int, NDArray[np.float32]] | None = None
        self.log = board.log
        self.trip = None
        self.pending = PendingQueue()
        self.faults: dict[str, Any] = {}

    @property
    def recorded(self) -> list[Signal]:
        """The signals of the board that were recorded."""
        return [self._board.signals[at] for at, _ in self._columns]

    @property
    def recorded_board(self) -> Board:
        """The board the recording was made with, at its first tick."""
        return self._board

    @property
    def chunk(self) -> int:
        """Most ticks of one call of ``advance``."""
        return self._board.chunk

    @property
    def dt_ms(self) -> float:
        """Sample interval, ms."""
        return self._board.dt_ms

    @property
    def spec(self) -> Spec:
        """The blocks and their parameters."""
        return self._board.spec

    @property
    def base(self) -> Document:
        """The document the board was made from."""
        return self._board.base

    @property
    def signals(self) -> SignalTable:
        """Table of traced signals."""
        return self._board.signals

    @property
    def diagnosers(self) -> dict[str, Section]:
        """Every diagnoser by its id."""
        return self._board.diagnosers

    def advance(self, n: int) -> Rows:
        """Read up to ``n`` ticks, to the end of the recording or of a piece of its file."""
        count = min(n, self._board.chunk, self.end - self.tick)
        if count <= 0:
            return self._rows(np.zeros((0, self._width), np.float32))
        number = int(np.searchsorted(self._edges, self.tick, "right")) - 1
        samples = self._read(number)
        start = self.tick - int(self._edges[number])
        rows = self._rows(samples[start : start + count])
        self.tick += rows.count
        return rows

    def seek(self, tick: int) -> None:
        """Go to a tick of the recording."""
        if not self.first <= tick < self.end:
            raise InputError(f"the recording has ticks {self.first} to {self.end - 1}", "tick")
        self.tick = tick

    def scores(self) -> dict[str, Any]:
        """Return nothing: scores are among the signals."""
        return {}

    def digest(self) -> str:
        """Return nothing: the recorded values are rounded."""
        return ""

    def apply(self, *_: Any) -> NoReturn:
        """Refuse: a recording cannot be changed."""
        raise InputError(REFUSAL, "command", "run its scenario to change something", "conflict")

    def checkpoint(self) -> NoReturn:
        """Refuse: a recording has no state of a board."""
        raise InputError(REFUSAL, "bench", "run its scenario to branch off", "conflict")

    save = checkpoint

    def _read(self, number: int) -> NDArray[np.float32]:
        """Return a row group as ``(ticks, signals)``; signals that were not recorded are NaN."""
        if self._group is None or self._group[0] != number:
            table = self._file.read_row_group(number, columns=[name for _, name in self._columns])
            samples = np.full((table.num_rows, self._width), np.nan, np.float32)
            for at, name in self._columns:
                samples[:, at] = table.column(name).to_numpy()
            self._group = number, samples
        return self._group[1]

    def _rows(self, samples: NDArray[np.float32]) -> Rows:
        return Rows.of(self.tick, samples, self._outputs)


TickSource = Board | Tape
"""A live bench advances one of these: a board computes its ticks, a tape reads them from a recording."""
