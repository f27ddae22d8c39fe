"""Figures of the sensor in use: how near it is to the shuttle, and whether it lost the direction."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray
from core.board.board import Board
from scenarios.measure.stretch import Stretch


def lost_samples(error: FloatArray, ambiguity_um: float) -> tuple[NDArray[np.bool_], int]:
    """Return which samples are off by more than half of what a sensor cannot tell apart, and where its count began.

    A grating does not say in which of its periods the motion began; the whole number of them with the fewest bad
    samples is taken off the error first. A sensor that is absolute loses nothing but what is not a number.
    """
    if ambiguity_um == 0.0:
        return ~np.isfinite(error), 0
    finite = error[np.isfinite(error)]
    turns, counts = np.unique(np.floor(finite / ambiguity_um + 0.5), return_counts=True)
    # of equally good ones the smallest
    order = np.lexsort((np.abs(turns), -counts))
    whole = int(turns[order[0]]) if len(turns) else 0
    bad = ~(np.abs(error - whole * ambiguity_um) <= 0.5 * ambiguity_um)
    return bad, whole


def sensing_metrics(board: Board, trace: dict[str, FloatArray], stretch: Stretch) -> dict[str, float]:
    """Return how well the sensor in use told the displacement, from ``metrics.since_ms`` and from its choice on.

    ``sensing.direction_lost_fraction`` is the share of samples off by more than half of what the sensor cannot tell
    apart, the pitch of a grating; the period the count began on is left open, and with it a bias of whole periods. A
    run counts as lost above 2 %; an absolute sensor loses nothing. ``sensing.rms_error_nm`` is the root mean square
    over the other samples: an error of whole periods is counted by the first figure and would drown the second.
    """
    samples = len(trace["plant.displacement"])
    start = max(stretch.start(samples, board.dt_ms), min(_chosen_at(board), samples - 1))
    error = (trace["sensor.displacement"] - trace["plant.displacement"])[start:]
    ambiguity = _ambiguity_um(board)
    bad, whole = lost_samples(error, ambiguity)
    found = {"sensing.direction_lost_fraction": float(np.mean(bad))}
    good = error[~bad] - whole * ambiguity
    if len(good):
        found["sensing.rms_error_nm"] = 1e3 * float(np.sqrt(np.mean(good * good)))
    return found


def _ambiguity_um(board: Board) -> float:
    """Return the period the sensor in use cannot tell displacements apart by; it knows."""
    spec = board.spec
    sensor = spec.sensors[spec.measuring]
    block: Any = sensor.block
    return float(block.ambiguity_um(sensor.params, spec.context(sensor.every)))


def _chosen_at(board: Board) -> int:
    """Return the tick at which the sensor in use was chosen: another one fed the loop before."""
    return max((entry.tick for entry in board.log if entry.kind == "set" and "sensor.kind" in entry.new), default=0)
