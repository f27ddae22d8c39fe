"""The samples a narrator looks at: all signals of the rows it is shown, and of a few the last ticks before them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.kept import Ticks
from core.kernel import kernel

PLACES = 128
"""Ticks before the rows that are kept."""


@kernel
def _keep(ring: Any, values: Any, first: int) -> None:
    """Write ticks into a ring."""
    places = ring.shape[1]
    for k in range(values.shape[0]):
        for i in range(values.shape[1]):
            ring[k, (first + i) % places] = values[k, i]


class NarratorSignals:
    """Gives signals by their names, rounded to single precision as recordings and the history keep them.

    So a replay has the same sentences as the bench.

    Parameters
    ----------
    columns : dict
        Column of each signal in the rows, outputs first.
    kept : sequence of str
        The signals that are kept beyond the rows.
    """

    def __init__(self, columns: dict[str, int], kept: Sequence[str]) -> None:
        self._columns = columns
        self._places = {name: place for place, name in enumerate(kept)}
        self._kept = np.array([columns[name] for name in kept], dtype=np.int64)
        self._ring = np.zeros((len(kept), PLACES), np.float32)
        self._rows: Ticks | None = None
        self.began: int | None = None
        """The first tick that was ever shown."""
        self.first = self.end = 0
        """The ticks of the rows of now: from the first to before the end."""

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    def show(self, rows: Ticks) -> None:
        """Look at rows that follow the last."""
        self._rows, self.first, self.end = rows, rows.first_tick, rows.first_tick + rows.count
        self.began = self.first if self.began is None else self.began

    def hide(self) -> None:
        """Let the rows go; the last of them are kept."""
        if (rows := self._rows) is not None:
            first = max(0, rows.count - PLACES)
            _keep(self._ring, rows.singles(self._kept, first, rows.count), rows.first_tick + first)
        self._rows, self.first = None, self.end

    def copy(self) -> NarratorSignals:
        """Return an independent copy."""
        twin = NarratorSignals(self._columns, list(self._places))
        twin._ring, twin.began, twin.first, twin.end = self._ring.copy(), self.began, self.end, self.end
        return twin

    def values(self, name: str, first: int, end: int, every: int = 1) -> FloatArray:
        """Return a signal from a tick to before another: of the rows of now, or of a kept one."""
        parts = []
        if first < self.first:
            ticks = np.arange(first, min(end, self.first))
            parts.append(self._ring[self._places[name], ticks % PLACES])
        if end > self.first and self._rows is not None:
            column, last = np.array([self._columns[name]]), min(end, self.end) - self.first
            parts.append(self._rows.singles(column, max(first - self.first, 0), last)[0])
        return np.concatenate(parts)[::every].astype(np.float64) if parts else np.empty(0)

    def at(self, name: str, tick: int) -> float:
        """Return the value at a tick."""
        return float(self.values(name, tick, tick + 1)[0])


def rms(values: FloatArray) -> float:
    """Return the root mean square, 0 of nothing."""
    return float(np.sqrt(np.mean(values * values))) if len(values) else 0.0
