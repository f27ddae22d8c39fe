"""Errors of a weighted estimate in each stretch with one true hypothesis, beside the best false model."""

from __future__ import annotations

import math

from core.diagnose.lanes import LANE
from core.kernel import kernel
from core.record import Record, Vector, vector


class StepErrors(Record):
    """The truth of this step, the summed squares of the estimate and of each model, the largest ratio of all before."""

    truth: float
    step_square: float
    worst: float
    step_squares: Vector = vector(LANE)


@kernel
def begin_step(s: StepErrors, truth: float, n: int) -> None:
    """Begin a new step where the truth changes."""
    if truth != s.truth:
        s.worst = max(s.worst, over_best_false(s, n))
        s.truth = truth
        s.step_square = 0.0
        for i in range(n):
            s.step_squares[i] = 0.0


@kernel
def over_best_false(s: StepErrors, n: int) -> float:
    """Return the rms error of the weighted estimate in this step over the error of the best false model."""
    least = math.inf
    for i in range(n):
        if i != s.truth:
            least = min(least, s.step_squares[i])
    return math.sqrt(s.step_square / least) if least > 0.0 else 0.0


def worst_step(s: StepErrors, n: int) -> float:
    """Return the largest of these ratios over all steps so far."""
    return float(max(s.worst, over_best_false(s, n)))
