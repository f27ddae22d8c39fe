"""Figures of weighted estimates against the true motion and the true parameters."""

from __future__ import annotations

import math
from typing import cast

from core.board.board import Board
from core.board.instances import weighted
from core.diagnose.hypothesis import ModelList
from core.loop.mixture import MotionErrors
from core.loop.step_errors import StepErrors, worst_step
from core.loop.weighted_axes import WeightedAxes
from core.loop.weighted_parameters import PARTS


def estimation_metrics(board: Board) -> dict[str, float]:
    """Return the rms errors of every weighted estimate, over all samples from the first.

    ``rms_error_um`` and ``rms_error_um_ms`` are the errors of displacement and velocity, ``rms_error_<part>_pct`` the
    errors of the parameters in percent of nominal. Of two axes ``rms_error_x_um`` and ``rms_error_y_um`` are the errors
    of the displacements, ``rms_error_rate_dps`` and ``rms_error_quadrature_dps`` the errors of the rate and of the
    stiffness between the axes. ``worst_step_ratio`` is the rms error of the displacement over the error of the best
    false model, in the stretch with one true hypothesis in which this ratio is the largest.
    """
    figures: dict[str, float] = {}
    for name, section in board.spec.diagnosers.items():
        key, prefix = weighted(name), f"estimation.{name}"
        if key not in board.wiring.rows:
            continue
        s = board.wiring.state(key)
        if not s.samples:
            continue
        percent = {part: getattr(s, part) for part in PARTS}
        squares: dict[str, float] = {}
        if isinstance(s, MotionErrors):
            squares |= {"um": s.displacement_square, "um_ms": s.velocity_square}
        if isinstance(s, WeightedAxes.State):
            squares |= {"x_um": s.x_square, "y_um": s.y_square, "rate_dps": s.rate_square}
            squares["quadrature_dps"] = s.quadrature
            percent["second_stiffness"] = s.second_stiffness
        figures |= {
            f"{prefix}.rms_error_{part}_pct": 100.0 * math.sqrt(square / s.samples) for part, square in percent.items()
        }
        figures |= {f"{prefix}.rms_error_{end}": math.sqrt(square / s.samples) for end, square in squares.items()}
        if isinstance(s, StepErrors):
            figures[f"{prefix}.worst_step_ratio"] = worst_step(s, len(cast(ModelList, section.params).hypotheses))
    return {name: float(value) for name, value in figures.items() if math.isfinite(value)}
