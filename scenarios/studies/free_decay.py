"""Free decay of a shuttle that is released at a displacement."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, FloatArray, parameter
from core.errors import InputError
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board

LEAST_SHARE = 1e-6
"""Peaks below this share of the start are rounding, and are left out."""
LEAST_PEAKS = 3


class FreeDecay(Study):
    r"""Lets the shuttle go and finds the exponential it stays under, :math:`|x(t)|\le me^{-\alpha t}|x_0|` (A.8.1).

    ``decay.rate_per_s`` is alpha, the slope of the logarithm of the peaks, and ``decay.bound`` the smallest m;
    ``decay.period_us`` is the time between two peaks on the same side and ``decay.log_decrement`` the loss between
    them; ``decay.damping_ns_m`` is the damping that follows from this loss, :math:`2m_s\alpha` with the mass of the
    device.
    """

    title = "Free decay"

    class Params(BlockParams):
        """How long."""

        duration_ms: float = parameter(5.0, "time looked at", "ms", gt=0.01, le=1e4)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the figures of the decay."""
        x = _let_go(board, params.duration_ms)
        at_ms, size = _peaks(x, board.dt_ms)
        if len(size) < LEAST_PEAKS:
            hint = "a start away from rest (plant.initial_displacement_um), a longer run, or less damping"
            raise InputError("sees no decaying swing", "study.duration_ms", hint)
        slope = float(np.polyfit(at_ms, np.log(size), 1)[0])
        half_period = float(np.mean(np.diff(at_ms)))
        time_ms = np.arange(len(x)) * board.dt_ms
        return {
            "decay.rate_per_s": -1e3 * slope,
            "decay.bound": float(np.max(np.abs(x) * np.exp(-slope * time_ms))) / abs(float(x[0])),
            "decay.period_us": 2e3 * half_period,
            "decay.log_decrement": -2.0 * slope * half_period,
            "decay.damping_ns_m": -2e3 * slope * board.spec.device.metrics()["mass_kg"],
        }

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the decay, and its peaks."""
        x = _let_go(board, params.duration_ms)
        every = max(1, len(x) // 600)
        at_ms, size = _peaks(x, board.dt_ms)
        curves = [
            ("displacement", (np.arange(0, len(x), every) * board.dt_ms).tolist(), x[::every].tolist()),
            ("peaks", at_ms.tolist(), size.tolist()),
        ]
        return StudyPicture(("time", "ms"), ("displacement", "um"), curves)


def _let_go(board: Board, duration_ms: float) -> FloatArray:
    """Run the board and return the true displacement from the release on."""
    column = board.signals.index("plant.displacement")
    left, parts = math.ceil(duration_ms / board.dt_ms), []
    while left:
        rows = board.advance(left)
        if rows.count == 0:
            raise InputError("the board tripped", "study.duration_ms")
        parts.append(rows.outputs[:, column].copy())
        left -= rows.count
    return np.concatenate(parts)


def _peaks(x: FloatArray, dt_ms: float) -> tuple[FloatArray, FloatArray]:
    """Return moment and size of every turn after the start, by a parabola through three samples."""
    size = np.abs(x)
    before, here, after = size[:-2], size[1:-1], size[2:]
    found = np.flatnonzero((here > before) & (here >= after) & (here > LEAST_SHARE * size[0]))
    a, b, c = before[found], here[found], after[found]
    shift = 0.5 * (a - c) / (a - 2.0 * b + c)
    return (found + 1 + shift) * dt_ms, b - 0.25 * (a - c) * shift
