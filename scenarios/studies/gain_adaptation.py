"""Stability of a gain-adaptation rule, simulated and by theory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import Field

from core.block import BlockParams, FloatArray, parameter
from core.errors import InputError
from core.theory.gain_adaptation import RULES, GainLoop, critical_gain, growth
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board

NAME = "gain_adaptation"


class GainAdaptationStudy(Study):
    """Runs the loop of the bench, and finds where its rule becomes unstable.

    ``adaptation.growth_per_s`` is the growth of the error from the second to the last quarter of the run,
    ``growth_theory_per_s`` the largest real part of the eigenvalues; ``period_s`` the period of its swing;
    ``critical_gain`` and ``critical_gain_<frequency>`` the first adaptation gain that is unstable under a constant and
    under a sine of that frequency (rad/s), on a plant whose damping coefficient is ``sine_b1``.
    """

    title = "Gain adaptation"

    class Params(BlockParams):
        """How long, and which sines."""

        duration_s: float = parameter(60.0, "time simulated", "s", gt=1, le=10_000)
        frequencies: list[float] = Field([], max_length=20, description="frequencies of the sines, rad/s")
        sine_b1: float = parameter(0.2, "coefficient b1 of the plant under a sine", "s", gt=0, le=100)
        most: float = parameter(10.0, "largest adaptation gain looked at", gt=0, le=1e4)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the figures."""
        if board.spec.active != NAME:
            raise InputError(f"must be {NAME} for this study", "controller.kind")
        law: Any = board.spec.controllers[NAME].params
        rule = rule_of(law.rule, law.form)
        loop = loop_of(board)
        results = _simulated(board, params.duration_s)
        if rule is not None and loop.b2 > 0.0:
            results["adaptation.growth_theory_per_s"] = growth(loop, rule, law.adaptation_gain, 0.0)
            results["adaptation.critical_gain"] = critical_gain(loop, rule, 0.0, params.most)
            sine = loop_of(board, params.sine_b1)
            for w in params.frequencies:
                name = f"{w:g}".replace(".", "_")
                results[f"adaptation.critical_gain_{name}"] = critical_gain(sine, rule, w, params.most)
        return results

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the error over the run."""
        error = _error(board, params.duration_s)
        every = max(1, len(error) // 600)
        time_ms = np.arange(0, len(error), every) * board.dt_ms
        return StudyPicture(("time", "ms"), ("error", "um"), [("error", time_ms.tolist(), error[::every].tolist())])


def rule_of(rule: str, form: str) -> int | None:
    """Return the rule of the theory, or None for a law that does not adapt."""
    if form != "corrected" and rule in ("mit", "lyapunov"):
        named = {("lyapunov", "derived"): "parks", ("lyapunov", "printed"): "dressler", ("mit", "derived"): "mit"}
        name = named.get((rule, form))
        return None if name is None else RULES[name]
    return RULES[rule]


def loop_of(board: Board, b1: float | None = None) -> GainLoop:
    """Return the loop of a bench, with another damping if given; the rules' gains scale with their stability limits."""
    context = board.spec.context()
    plant, unit = context.device, 1.0 / context.device.natural_frequency
    law: Any = board.spec.controllers[NAME].params
    true_b1 = plant.damping / plant.stiffness / unit
    chosen = true_b1 if b1 is None else b1
    return GainLoop(
        b1=chosen,
        b2=plant.mass / plant.stiffness / unit**2,
        gain=plant.static_gain,
        model_gain=context.model.static_gain,
        amplitude=getattr(board.spec.reference.params, "amplitude_v", None) or 1.0,
        error_weight=law.error_weight * chosen / true_b1,
        proportional=law.proportional * true_b1 / chosen,
        filter_time=law.filter_time * true_b1 / chosen,
    )


def _error(board: Board, duration_s: float) -> FloatArray:
    """Run the bench, and return the model's displacement less the true one."""
    model, plant = (board.signals.index(f"{name}.displacement") for name in ("model", "plant"))
    parts: list[FloatArray] = []
    ticks = round(duration_s * 1e3 / board.dt_ms)
    while board.tick < ticks:
        rows = board.advance(ticks - board.tick)
        if rows.count == 0:
            break
        parts.append(rows.outputs[:, model] - rows.outputs[:, plant])  # the true displacement, not the measured one
    return np.concatenate(parts)


def _simulated(board: Board, duration_s: float) -> dict[str, float]:
    error = _error(board, duration_s)
    quarter = len(error) // 4
    dt_s = board.dt_ms * 1e-3
    early, late = (float(np.max(np.abs(part))) for part in (error[quarter : 2 * quarter], error[-quarter:]))
    results = {
        "adaptation.final_error_um": float(error[-1]),
        "adaptation.peak_error_um": float(np.max(np.abs(error))),
        "adaptation.ratio": late / early if early > 0.0 else 0.0,
        "adaptation.tripped": float(board.trip is not None),
    }
    if early > 0.0 and late > 0.0:
        results["adaptation.growth_per_s"] = float(np.log(late / early) / (2 * quarter * dt_s))
    rising = np.flatnonzero((error[:-1] < 0.0) & (error[1:] >= 0.0))
    if len(rising) > 2:
        results["adaptation.period_s"] = float(rising[-1] - rising[0]) / (len(rising) - 1) * dt_s
    return results
