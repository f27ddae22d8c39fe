"""The last samples of a few signals, as a recording would have them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.block import FloatArray
from core.board.rows import Rows


class LastSamples:
    """Keeps the rows of one look and as many before them as sentences speak of.

    Values are rounded to single precision, as recordings and the history keep them, so that a replay tells the same.

    Parameters
    ----------
    names : sequence of str
        The signals.
    columns : sequence of int
        Their columns in the rows, outputs first.
    outputs : int
        How many of the columns of a board are outputs.
    before : int
        Rows kept before those of the last look.
    """

    def __init__(self, names: Sequence[str], columns: Sequence[int], outputs: int, before: int) -> None:
        order = sorted(range(len(names)), key=lambda at: columns[at])
        self._place = {names[at]: place for place, at in enumerate(order)}
        chosen = np.array([columns[at] for at in order], dtype=np.int64)
        self._outputs, self._taps = chosen[chosen < outputs], chosen[chosen >= outputs] - outputs
        self._before = before
        self._kept = np.empty((0, len(names)), np.float32)
        self.began: int | None = None
        """The first tick that was ever added."""
        self.end = 0
        """The tick behind the last row."""

    def __contains__(self, name: object) -> bool:
        return name in self._place

    @property
    def names(self) -> list[str]:
        """The signals that are kept."""
        return list(self._place)

    def add(self, rows: Rows) -> None:
        """Add rows that follow the last."""
        if self.began is None:
            self.began = rows.first_tick
        new = np.hstack([rows.outputs[:, self._outputs], rows.taps[:, self._taps]]).astype(np.float32)
        self._kept = np.vstack([self._kept[-self._before :], new])
        self.end = rows.first_tick + rows.count

    def values(self, name: str, first: int, end: int, every: int = 1) -> FloatArray:
        """Return a signal from a tick to before another, as far as it is kept."""
        start = self.end - len(self._kept)
        kept = self._kept[max(0, first - start) : max(0, end - start) : every, self._place[name]]
        return kept.astype(np.float64)

    def at(self, name: str, tick: int) -> float:
        """Return the value at a tick that is kept."""
        return float(self.values(name, tick, tick + 1)[0])


def rms(values: FloatArray) -> float:
    """Return the root mean square, 0 of nothing."""
    return float(np.sqrt(np.mean(values * values))) if len(values) else 0.0
