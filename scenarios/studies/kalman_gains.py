"""Steady gains of Kalman banks, against the Riccati equation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.linalg import solve_discrete_are

from core.block import BlockParams, FloatArray, parameter
from core.diagnose.hypothesis import hypotheses_of
from core.diagnose.kalman import KalmanBank
from core.diagnose.two_output import TwoOutput
from core.errors import InputError
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board

NAMES = (("displacement", "displacement_by_velocity_ms"), ("velocity_per_ms", "velocity_by_velocity"))
"""Names of the gains: a row for each state, a column for each measurement."""


class KalmanGains(Study):
    r"""Runs every bank of Kalman filters until its gains rest and holds them to the Riccati equation.

    .. math:: P=\Phi P\Phi^T+W-\Phi PH^T(HPH^T+R)^{-1}HP\Phi^T,\qquad K=PH^T(HPH^T+R)^{-1}

    ``gains.<id>.displacement.<hypothesis>`` and ``.velocity_per_ms.<hypothesis>`` are the gains by the measured
    displacement; a bank that is given the velocity too has ``.displacement_by_velocity_ms`` and
    ``.velocity_by_velocity``. ``.spread`` is the largest ratio of one such gain between two hypotheses, ``.negative``
    the number of gains below zero, ``.riccati_error_pct`` the largest error of a gain against the equation.
    """

    title = "Kalman gains"

    class Params(BlockParams):
        """How long the filters run."""

        samples: int = parameter(2000, "samples until the gains rest", ge=2, le=10_000_000)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the gains of every bank."""
        banks = {name: one for name, one in board.spec.diagnosers.items() if issubclass(one.block, KalmanBank)}
        if not banks:
            raise InputError("needs a bank of Kalman filters", "diagnosers")
        while board.tick < params.samples and board.advance(params.samples - board.tick).count:
            pass
        results: dict[str, float] = {}
        for name, section in banks.items():
            hypotheses = [one.name for one in hypotheses_of(section.params)]
            outputs = 2 if issubclass(section.block, TwoOutput) else 1
            found = np.array([_gain(board, name, one, outputs) for one in hypotheses])
            block: Any = section.block
            packed = block.pack(section.params, board.spec.context(section.every))
            limits = np.array([_riccati(packed, i, outputs) for i in range(len(hypotheses))])
            for one, gain in zip(hypotheses, found, strict=True):
                results |= {
                    f"gains.{name}.{NAMES[state][output]}.{one}": float(gain[state, output])
                    for state in range(2)
                    for output in range(outputs)
                }
            sizes = np.abs(found)
            results[f"gains.{name}.spread"] = float(np.max(sizes.max(axis=0) / sizes.min(axis=0)))
            results[f"gains.{name}.negative"] = float(np.sum(found < 0.0))
            results[f"gains.{name}.riccati_error_pct"] = 100.0 * float(np.max(np.abs(found / limits - 1.0)))
        return results


def _gain(board: Board, name: str, hypothesis: str, outputs: int) -> FloatArray:
    """Return the gain there is now, as if both outputs had been taken in at once."""
    by = [("gain_displacement", "gain_velocity"), ("velocity_gain_displacement", "velocity_gain_velocity")][:outputs]
    gain = np.array([[board.value(f"{name}.{port}.{hypothesis}") for port in ports] for ports in by]).T
    if outputs == 2:  # the filter corrects by the velocity after the displacement
        gain[:, 0] -= gain[:, 1] * gain[1, 0]
    return gain


def _riccati(p: Any, i: int, outputs: int) -> FloatArray:
    """Return the gain of one filter in the limit, in units of its own noise: at high rates the numbers are tiny."""
    noise = np.array([[p.noise11[i], p.noise12[i]], [p.noise12[i], p.noise22[i]]])
    unit = np.sqrt(np.diag(noise))
    phi = np.array([[p.phi11[i], p.phi12[i]], [p.phi21[i], p.phi22[i]]]) * (unit / unit[:, None])
    seen = np.diag(unit)[:outputs]
    r = np.diag([p.sensor, p.velocity_noise] if outputs == 2 else [p.sensor])
    # the noise of a voltage moves both states as one; the equation wants a little on each
    prior = solve_discrete_are(phi.T, seen.T, noise / np.outer(unit, unit) + 1e-12 * np.eye(2), r)
    gain: FloatArray = unit[:, None] * np.linalg.solve(seen @ prior @ seen.T + r, seen @ prior).T
    return gain
