"""Other benches behind the picture of a panel: the same signals over the same ticks, or shifted ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from server.bench.bench import Seen


class Behind:
    """A bench behind a picture.

    Parameters
    ----------
    names : sequence of str
        The signals of the picture.
    shift : int
        Ticks between the two: tick ``t`` of the picture is above tick ``t + shift`` of the other bench.
    find : callable
        Returns the other bench as the person sees it now; none if it is gone.
    """

    def __init__(self, names: Sequence[str], shift: int, find: Callable[[], Seen | None]) -> None:
        self._names, self._shift, self._find = names, shift, find
        self._seen: Seen | None = None
        self._rows: list[int] = []
        self._columns: list[int] = []

    @property
    def state(self) -> tuple[int, int]:
        """Dependencies of its picture: the history, and its end."""
        seen = self._look()
        return (id(seen.history), seen.history.end_tick) if seen is not None else (0, 0)

    def columns(self, start: int, end: int, columns: int) -> NDArray[np.float32]:
        """Return minima and maxima, shape (signals, 2, columns); NaN where the other bench has nothing."""
        found = np.full((len(self._names), 2, columns), np.nan, np.float32)
        seen = self._look()
        if seen is not None and self._rows:
            shift = self._shift
            found[self._rows] = seen.history.columns(self._columns, start + shift, end + shift, columns)
        return found

    def _look(self) -> Seen | None:
        """Return the bench; its signals are looked up again when another bench takes its place."""
        seen = self._find()
        if seen is not self._seen:
            self._seen = seen
            known = {signal.name: signal.index for signal in seen.signals} if seen is not None else {}
            self._rows = [row for row, name in enumerate(self._names) if name in known]
            self._columns = [known[self._names[row]] for row in self._rows]
        return seen
