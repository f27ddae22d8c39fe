"""What several pages look at is cut from the history once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from server.bench.session import Session

Columns = NDArray[np.float32]


class SharedCuts:
    """The history of one bench as all its pages see it at one moment.

    Parameters
    ----------
    session : Session
        The bench; its history may be replaced by a reset.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._columns: dict[tuple[object, ...], Columns] = {}
        self._samples: dict[tuple[object, ...], Columns] = {}
        self._history = session.history
        self.end_tick = self._history.end_tick

    def refresh(self) -> int:
        """Take the present moment; returns its tick."""
        history = self._session.history
        if history is not self._history or history.end_tick != self.end_tick:
            self._history, self.end_tick = history, history.end_tick
            self._columns.clear()
            self._samples.clear()
        return self.end_tick

    @property
    def first_tick(self) -> int:
        """Oldest tick kept."""
        return self._history.first_tick

    def read(self, signals: list[int], start: int, stop: int) -> Columns:
        """Return ``(n, ticks)`` samples."""
        key = (*signals, start, stop)
        if key not in self._samples:
            self._samples[key] = self._history.read(signals, start, stop)
        return self._samples[key]

    def columns(self, signals: list[int], start: int, stop: int, columns: int) -> Columns:
        """Return ``(n, 2, columns)`` minima and maxima."""
        key = (*signals, start, stop, columns)
        if key not in self._columns:
            self._columns[key] = self._history.columns(signals, start, stop, columns)
        return self._columns[key]
