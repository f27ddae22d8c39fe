"""Rows: the outputs and taps of the ticks of a call of ``advance``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import BoolArray, FloatArray


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
