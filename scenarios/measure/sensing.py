"""Figures of the sensor in use: its error, and whether it lost the direction."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray
from core.board.board import Board
from core.board.commands import Set
from scenarios.measure.stretch import Stretch


def lost_samples(error: FloatArray, ambiguity_um: float) -> tuple[NDArray[np.bool_], int]:
    """Return the samples whose error exceeds half of the sensor's ambiguity, and the offset of its count of periods.

    A grating does not show in which of its periods the motion began: the whole number of periods with the fewest bad
    samples is taken off the error first. An absolute sensor loses only samples that are not numbers.
    """
    if ambiguity_um == 0.0:
        return ~np.isfinite(error), 0
    finite = error[np.isfinite(error)]
    turns, counts = np.unique(np.floor(finite / ambiguity_um + 0.5), return_counts=True)
    # the smallest of equally good numbers
    order = np.lexsort((np.abs(turns), -counts))
    whole = int(turns[order[0]]) if len(turns) else 0
    bad = ~(np.abs(error - whole * ambiguity_um) <= 0.5 * ambiguity_um)
    return bad, whole


def sensing_metrics(board: Board, trace: dict[str, FloatArray], stretch: Stretch) -> dict[str, float]:
    """Return the errors of the sensor in use, from ``metrics.since_ms`` and from its choice on.

    ``sensing.direction_lost_fraction`` is the share of samples whose error exceeds half of the distance that the sensor
    cannot tell apart, the pitch of a grating. The period in which the count began is left open, and with it a bias of
    whole periods. A run counts as lost above 2 %; an absolute sensor loses nothing. ``sensing.rms_error_nm`` is the
    root mean square over the other samples: the first figure counts errors of whole periods, which would drown the
    second.
    """
    samples = len(trace["plant.displacement"])
    start = max(stretch.start(samples, board.dt_ms), min(_chosen_at(board), samples - 1))
    error = (trace["sensor.displacement"] - trace["plant.displacement"])[start:]
    ambiguity = _ambiguity_um(board)
    bad, whole = lost_samples(error, ambiguity)
    figures = {"sensing.direction_lost_fraction": float(np.mean(bad))}
    good = error[~bad] - whole * ambiguity
    if len(good):
        figures["sensing.rms_error_nm"] = 1e3 * float(np.sqrt(np.mean(good * good)))
    return figures


def _ambiguity_um(board: Board) -> float:
    """Return the distance of displacements that the sensor in use cannot tell apart, as it states itself."""
    spec = board.spec
    sensor = spec.sensors[spec.measuring]
    block: Any = sensor.block
    return float(block.ambiguity_um(sensor.params, spec.context(sensor.every)))


def _chosen_at(board: Board) -> int:
    """Return the tick at which the sensor in use was chosen; before it, another sensor fed the loop."""
    chosen = [tick for tick, command in board.done if isinstance(command, Set) and "sensor.kind" in command.set]
    return chosen[-1] if chosen else 0
