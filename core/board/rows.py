"""Rows: the outputs and taps of the ticks of a call of ``advance``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import BoolArray, FloatArray, IntArray
from core.kernel import kernel


@kernel
def _singles(outputs: FloatArray, taps: FloatArray, columns: IntArray, first: int, found: Any) -> None:
    width = outputs.shape[1]
    for k in range(found.shape[0]):
        column = columns[k]
        for i in range(found.shape[1]):
            found[k, i] = outputs[first + i, column] if column < width else taps[first + i, column - width]


@dataclass(frozen=True)
class Rows:
    """Ticks that were run: views that hold until the next ``advance``; idle taps are 0 throughout."""

    first_tick: int
    count: int
    outputs: FloatArray
    taps: FloatArray
    idle: BoolArray

    @staticmethod
    def of(first_tick: int, samples: NDArray[Any], outputs: int) -> Rows:
        """Return rows from samples (ticks by signals, outputs first), none of them known to be idle."""
        own, taps = (np.ascontiguousarray(part, np.float64) for part in np.split(samples, [outputs], axis=1))
        return Rows(first_tick, len(samples), own, taps, np.zeros(taps.shape[1], dtype=np.bool_))

    def singles(self, columns: IntArray, first: int, end: int) -> NDArray[np.float32]:
        """Return signals from a tick to before another of these, in single precision, shape (signals, ticks)."""
        found = np.empty((len(columns), end - first), dtype=np.float32)
        _singles(self.outputs, self.taps, columns, first, found)
        return found
