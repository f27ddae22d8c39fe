"""Figures of weighted estimates against the true motion and the true parameters."""

from __future__ import annotations

import math

from core.board.board import Board
from core.board.instances import weighted
from core.diagnose.hypothesis import hypotheses_of
from core.loop.weighted_parameters import PARTS
from core.loop.weighted_state import WeightedState, worst_step


def estimation_metrics(board: Board) -> dict[str, float]:
    """Return the rms errors of every weighted estimate, over all samples from the first.

    ``rms_error_um`` and ``rms_error_um_ms`` are the errors of displacement and velocity, ``rms_error_<part>_pct`` the
    errors of the parameters in percent of nominal. ``worst_step_ratio`` is the rms error of the displacement over the
    error of the best false model, in the stretch with one true hypothesis in which this ratio is the largest.
    """
    figures: dict[str, float] = {}
    for name, section in board.spec.diagnosers.items():
        key, prefix = weighted(name), f"estimation.{name}"
        if key not in board.wiring.rows:
            continue
        s = board.wiring.state(key)
        if not s.samples:
            continue
        for part in PARTS:
            figures[f"{prefix}.rms_error_{part}_pct"] = 100.0 * math.sqrt(getattr(s, part) / s.samples)
        if isinstance(s, WeightedState.State):
            figures[f"{prefix}.rms_error_um"] = math.sqrt(s.displacement_square / s.samples)
            figures[f"{prefix}.rms_error_um_ms"] = math.sqrt(s.velocity_square / s.samples)
            figures[f"{prefix}.worst_step_ratio"] = worst_step(s, len(hypotheses_of(section.params)))
    return {name: float(value) for name, value in figures.items() if math.isfinite(value)}
