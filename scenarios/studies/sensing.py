"""A sensor over many seeds: how often it loses the direction, and its error when it does not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, parameter
from scenarios.measure.sensing import sensing_metrics
from scenarios.measure.stretch import Stretch
from scenarios.studies.monte_carlo import again
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.block import FloatArray
    from core.board.board import Board

TRACED = ("plant.displacement", "sensor.displacement")
LOST = 0.02
"""Share of samples with a wrong period above which a run has lost the direction."""


class Sensing(Study):
    """Runs the bench once for each seed: noise, and the place of the grating under the beam, are others.

    ``sensing.lost_share`` is the share of runs in which the sensor in use lost the direction,
    ``sensing.kept_rms_error_nm`` the mean of its error over the others.
    """

    title = "Sensor over seeds"

    class Params(BlockParams):
        """The number of runs and their length."""

        runs: int = parameter(60, "seeds, starting at the seed of the bench", ge=1, le=10_000)
        duration_ms: float = parameter(20.0, "length of a run", "ms", gt=0, le=10_000)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the share of runs that lost the direction, and the error of the other runs."""
        runs = [_run(board, board.spec.seed + i, params.duration_ms) for i in range(params.runs)]
        kept = [rms for lost, rms in runs if lost <= LOST]
        figures = {"sensing.lost_share": 1.0 - len(kept) / len(runs)}
        if kept:
            figures["sensing.kept_rms_error_nm"] = float(np.mean(kept))
        return figures

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the motion and the output of the sensor, over four periods of the first run."""
        trace = _trace(board, params.duration_ms)
        shown = slice(0, min(len(trace[TRACED[0]]), round(2.0 / board.dt_ms)))
        time_ms = (np.arange(len(trace[TRACED[0]]))[shown] * board.dt_ms).tolist()
        curves = [(name.replace(".", " "), time_ms, trace[name][shown].tolist()) for name in TRACED]
        return StudyPicture(("time", "ms"), ("displacement", "um"), curves)


def _trace(board: Board, duration_ms: float) -> dict[str, FloatArray]:
    ticks = max(1, round(duration_ms / board.dt_ms))
    columns = [board.signals.index(name) for name in TRACED]
    parts = []
    while board.tick < ticks and (rows := board.advance(ticks - board.tick)).count:
        parts.append(rows.outputs[:, columns].copy())
    return dict(zip(TRACED, np.concatenate(parts).T, strict=True))


def _run(board: Board, seed: int, duration_ms: float) -> tuple[float, float]:
    """Return the share of lost samples of one run, and the error over the others."""
    fresh = again(board, seed)
    found = sensing_metrics(fresh, _trace(fresh, duration_ms), Stretch())
    return found["sensing.direction_lost_fraction"], found.get("sensing.rms_error_nm", 0.0)
