"""Figures of a loop whose faults come and go: the error in each step, the time to recover, and acts."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from scenarios.measure.errors import rms
from scenarios.measure.stretch import Stretch
from scenarios.measure.verdicts import edges

WINDOW_MS = 1.0
"""Time over which an error is averaged to judge whether it has recovered: two periods of 2 kHz."""
RECOVERED = 2.5
"""Error, over the error of the first step, up to which the loop counts as recovered."""


def supervision_metrics(board: Board, trace: dict[str, FloatArray], stretch: Stretch) -> dict[str, float]:
    """Return the error in the second half of each step, the time until it has recovered, and the number of acts.

    A step lasts from one fault or healing to the next. It has recovered after the last window whose error is more than
    2.5 times the error of the first step; a step without recovery counts with its whole length.
    """
    figures = {"supervisor.acts": float(len(board.consequences))} if board.spec.supervisors else {}
    if not stretch.steps or board.spec.axes:
        return figures
    error = trace["plant.displacement"] - trace["model.displacement"]
    size = max(1, round(WINDOW_MS / board.dt_ms))
    usual = 0.0
    for step, (start, end) in enumerate(pairwise(edges(board)), 1):
        level = rms(error[(start + end) // 2 : end])
        usual = usual or level
        figures[f"control.step_error_um.{step}"] = level
        if step == 1:
            continue
        windows = [slice(at, min(at + size, end)) for at in range(start, end, size)]
        above = np.flatnonzero([rms(error[window]) > RECOVERED * usual for window in windows])
        last = windows[above[-1]].stop if len(above) else start
        figures[f"control.recovery_ms.{step}"] = (last - start) * board.dt_ms
    return figures
