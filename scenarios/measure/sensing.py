"""Figures of the sensor in use: its error, and whether it lost the direction."""

from __future__ import annotations

import math
import sys
from collections import Counter
from collections.abc import Iterable
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.board.commands import SetValues
from core.kernel import kernel
from scenarios.measure.blocks import blocks
from scenarios.measure.stretch import Stretch


def good_squares(measured: FloatArray, true: FloatArray, ambiguity_um: float, whole: int) -> FloatArray:
    """Return the squares of the errors, less whole periods, of the samples that are not lost.

    A sample is lost if its error exceeds half of the sensor's ambiguity. An absolute sensor loses only samples that are
    not numbers.
    """
    squares = np.empty(len(true))
    most = 0.5 * ambiguity_um or sys.float_info.max
    return squares[: _take_squares(measured, true, whole * ambiguity_um, most, squares)]


@kernel
def _take_squares(measured: FloatArray, true: FloatArray, offset: float, most: float, squares: FloatArray) -> int:
    count = 0
    for i in range(len(true)):
        error = measured[i] - true[i] - offset
        if abs(error) <= most:
            squares[count] = error * error
            count += 1
    return count


def whole_periods(errors: Iterable[FloatArray], ambiguity_um: float) -> int:
    """Return the offset of a sensor's count of periods, that with the fewest bad samples.

    A grating does not show in which of its periods the motion began.
    """
    if ambiguity_um == 0.0:
        return 0
    counted = Counter[float]()
    for error in errors:
        turns, counts = np.unique(np.floor(error[np.isfinite(error)] / ambiguity_um + 0.5), return_counts=True)
        counted.update(dict(zip(turns.tolist(), counts.tolist(), strict=True)))
    # the smallest of equally good numbers
    return int(min(counted, key=lambda turn: (-counted[turn], abs(turn), turn), default=0.0))


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
    columns = trace["sensor.displacement"][start:], trace["plant.displacement"][start:]
    ambiguity = _ambiguity_um(board)
    whole = whole_periods((measured - true for measured, true in blocks(*columns)), ambiguity)
    good, squares = 0, 0.0
    for measured, true in blocks(*columns):
        found = good_squares(measured, true, ambiguity, whole)
        good, squares = good + len(found), squares + float(np.sum(found))
    figures = {"sensing.direction_lost_fraction": (samples - start - good) / (samples - start)}
    if good:
        figures["sensing.rms_error_nm"] = 1e3 * math.sqrt(squares / good)
    return figures


def _ambiguity_um(board: Board) -> float:
    """Return the distance between displacements that look alike to the sensor in use, by its own statement."""
    spec = board.spec
    sensor = spec.sensors[spec.measuring]
    block: Any = sensor.block
    return float(block.ambiguity_um(sensor.params, spec.context(sensor.every)))


def _chosen_at(board: Board) -> int:
    """Return the tick at which the sensor in use was chosen; before it, another sensor fed the loop."""
    chosen = [tick for tick, command in board.done if isinstance(command, SetValues) and "sensor.kind" in command.set]
    return chosen[-1] if chosen else 0
