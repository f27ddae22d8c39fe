"""The signals that boards abreast keep at each tick."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.wiring import Wiring
from core.compile.keeping import EDGE, SLICE, keeping, sorting
from core.compile.machine import WIDTH

NOTHING: Mapping[str, Sequence[str]] = {}


class LaneTraces:
    """Signals of boards abreast, and sums of signals; the boards after them use the same room.

    Parameters
    ----------
    wiring : Wiring
        Of one of the boards.
    columns : sequence of str
        The signals to keep.
    samples : int
        Ticks of the longest run.
    sums : mapping
        The sums of signals to keep in addition, by name.
    """

    def __init__(
        self, wiring: Wiring, columns: Sequence[str], samples: int, sums: Mapping[str, Sequence[str]] = NOTHING
    ) -> None:
        parts: dict[str, Sequence[str]] = {**{name: (name,) for name in columns}, **sums}
        places = np.array([wiring.index[name] for own in parts.values() for name in own], dtype=np.int64)
        ends = np.array([len(parts), *np.cumsum([0, *map(len, parts.values())])], dtype=np.int64)
        ticks = -(-samples // EDGE) * EDGE
        shape = np.array([len(parts), ticks], dtype=np.int64)
        self.names, self.samples = list(parts), samples
        self._trace = at_a_line((len(parts), WIDTH, ticks))
        self._rows = np.empty((SLICE, len(parts), WIDTH))
        self.arguments: tuple[Any, ...] = keeping(), sorting(), self._rows, places, self._trace, ends, shape
        """The arguments of the loop that keeps them."""

    def end(self, tick: int) -> None:
        """Sort the ticks after the last slice."""
        rest = tick % SLICE
        self._trace[:, :, tick - rest : tick] = self._rows[:rest].transpose(1, 2, 0)

    def columns(self, lane: int, tick: int) -> dict[str, FloatArray]:
        """Return the signals and sums of a board up to a tick, by name."""
        return {name: self._trace[column, lane, :tick] for column, name in enumerate(self.names)}


def at_a_line(shape: tuple[int, ...]) -> FloatArray:
    """Return an array whose first number begins a line of the cache."""
    size = math.prod(shape)
    room = np.empty(size + EDGE)
    start = -(room.ctypes.data // 8) % EDGE
    return room[start : start + size].reshape(shape)
