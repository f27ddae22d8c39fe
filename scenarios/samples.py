"""The samples of a run, a column for each signal: in memory, or, when they are many, in a temporary file."""

from __future__ import annotations

import os
import tempfile
from typing import Protocol, Self

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.board.rows import Rows
from core.signals import Signal

IN_MEMORY = 8_000_000
"""Numbers that stay in memory."""
LARGE = "/var/tmp"
PIECE = 4096
"""Samples of each column that are written at once."""


class TraceSink(Protocol):
    """Receives the samples of a run during the run."""

    def begin(self, board: Board, signals: list[Signal]) -> None:
        """Make room for these signals of a board that is at its first tick."""

    def add(self, rows: Rows) -> None:
        """Take rows of all signals of the board."""


def temporary_folder() -> str:
    """Return TMPDIR, or the folder for large temporary files: the usual one may be a part of memory."""
    return LARGE if "TMPDIR" not in os.environ and os.access(LARGE, os.W_OK) else tempfile.gettempdir()


class Samples:
    """Columns that grow together, in a context in which they are added and read.

    Parameters
    ----------
    columns : int
        How many.
    samples : int
        How long they may become.

    Raises
    ------
    OSError
        When they have no room in the folder of temporary files, here and in `add`.
    """

    def __init__(self, columns: int, samples: int) -> None:
        self._shape, self._count, self._pending = (columns, samples), 0, 0
        is_long = columns * samples > IN_MEMORY
        self._file = tempfile.TemporaryFile(dir=temporary_folder()) if is_long else None
        self._array = np.empty(self._shape if self._file is None else (columns, PIECE))
        if self._file is not None:
            self._file.truncate(8 * columns * samples)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._file is not None:
            self._file.close()  # samples that were returned stay until they are unused

    def add(self, rows: FloatArray) -> None:
        """Add rows, each with a number for every column."""
        at = self._pending if self._file is not None else self._count
        if at + len(rows) > self._array.shape[1]:
            self._write()
            at = 0
        self._array[:, at : at + len(rows)] = rows.T
        self._pending, self._count = at + len(rows), self._count + len(rows)

    def _write(self) -> None:
        """Write the waiting samples to their place after the rest of each column."""
        assert self._file is not None
        for number, column in enumerate(self._array[:, : self._pending]):
            self._file.seek(8 * (number * self._shape[1] + self._count - self._pending))
            self._file.write(column.tobytes())
        self._pending = 0

    def columns(self) -> FloatArray:
        """Return all columns, shape (columns, samples)."""
        if self._file is None:
            return self._array[:, : self._count]
        self._write()
        self._file.flush()
        return np.memmap(self._file, np.float64, "r", shape=self._shape)[:, : self._count]
