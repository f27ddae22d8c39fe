"""Figures of the sensor in use: how near it is to the shuttle, and whether it lost the direction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray
from core.board.board import Board
from scenarios.stretch import Stretch


def lost_samples(error: FloatArray, pitch_um: float) -> tuple[NDArray[np.bool_], int]:
    """Return which samples are off by more than half a pitch, and by how many pitches the count began wrong.

    A grating does not say in which of its periods the motion began; the whole number of pitches with the fewest bad
    samples is taken off the error first.
    """
    finite = error[np.isfinite(error)]
    turns, counts = np.unique(np.floor(finite / pitch_um + 0.5), return_counts=True)
    # of equally good ones the smallest
    order = np.lexsort((np.abs(turns), -counts))
    whole = int(turns[order[0]]) if len(turns) else 0
    bad = ~(np.abs(error - whole * pitch_um) <= 0.5 * pitch_um)
    return bad, whole


def sensing_metrics(board: Board, trace: dict[str, FloatArray], stretch: Stretch) -> dict[str, float]:
    """Return how well the sensor in use told the displacement, from ``metrics.since_ms`` on.

    ``sensing.direction_lost_fraction`` is the share of samples off by more than half a pitch of the grating, the
    fringe the count began on left open. A run counts as lost above 2 %. ``sensing.rms_error_nm`` is the root mean
    square over the other samples: an error of whole fringes is counted by the first figure and would drown the
    second.
    """
    start = stretch.start(len(trace["plant.displacement"]), board.dt_ms)
    error = (trace["sensor.displacement"] - trace["plant.displacement"])[start:]
    pitch = _pitch_um(board)
    bad, whole = lost_samples(error, pitch)
    found = {"sensing.direction_lost_fraction": float(np.mean(bad))}
    good = error[~bad] - whole * pitch
    if len(good):
        found["sensing.rms_error_nm"] = 1e3 * float(np.sqrt(np.mean(good * good)))
    return found


def _pitch_um(board: Board) -> float:
    """Return the pitch of the grating the sensor in use looks at; that of the through-wafer one if at none."""
    sensors = board.spec.sensors
    light = getattr(sensors[board.spec.measuring].params, "light", "through_wafer")
    source = "dual_beam" if board.spec.measuring.startswith("quadrature") else light
    return float(sensors[source].params.pitch_um)  # type: ignore[attr-defined]
