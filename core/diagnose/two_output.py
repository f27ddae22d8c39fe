"""Kalman bank that is given displacement and velocity."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, Port, kernel, parameter
from core.diagnose.filters import (
    COUNT,
    DEPTH,
    HALF_LOG,
    LANES,
    MEASURED,
    NIS,
    OWN,
    P11,
    P12,
    P22,
    WIDTH,
    X1,
    X2,
    coasts,
    driven,
    filters_step,
    take_logarithms,
)
from core.diagnose.kalman import KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, weigh

FLOOR, LOG_FLOOR, VELOCITY_NOISE = range(3)
LOG, LIKELIHOOD = DEPTH, DEPTH + 1
VELOCITY, CHOSEN, RESIDUAL_TAP, NIS_TAP, SECOND_TAP = range(4, 9)


@kernel
def correct_velocity(p: Any, s: Any, i: int, residual: float, psi: float) -> None:
    """Correct one filter by the velocity, after the displacement."""
    b = OWN + i
    c12 = s[b + P12 * LANE]
    c22 = s[b + P22 * LANE]
    k1 = c12 / psi
    k2 = c22 / psi
    s[b + X1 * LANE] += k1 * residual
    s[b + X2 * LANE] += k2 * residual
    s[b + P11 * LANE] -= k1 * c12
    s[b + P12 * LANE] = c12 - k1 * c22
    s[b + P22 * LANE] = c22 - k2 * c22


def two_output_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, correct by one output and then by the other, weigh."""
    n = int(p[COUNT])
    if coasts(p, s, w, io, LANE, 0, n):
        return
    own = LANES + WIDTH * LANE
    zv = w[io[VELOCITY]]
    seen = math.isfinite(w[io[MEASURED]])
    seen_too = math.isfinite(zv)
    drive = driven(p, s)
    if filters_step(p, s, w, io, n, RESIDUAL_TAP):
        take_logarithms(s, n)
    best = -math.inf
    for i in range(n):
        nis = s[OWN + NIS * LANE + i]
        log = s[OWN + LOG * LANE + i]
        if seen and drive:
            log += -0.5 * nis - s[OWN + HALF_LOG * LANE + i]
        residual = 0.0
        if seen_too:
            psi = s[OWN + P22 * LANE + i] + p[own + VELOCITY_NOISE]
            residual = zv - s[OWN + X2 * LANE + i]
            more = residual * residual / psi
            correct_velocity(p, s, i, residual, psi)
            if drive:
                log += -0.5 * more - 0.5 * math.log(psi)
            nis = 0.5 * (nis + more) if seen else more
        w[io[SECOND_TAP] + i] = residual
        w[io[NIS_TAP] + i] = nis
        s[OWN + LIKELIHOOD * LANE + i] = log
        best = max(best, log)
    at = io[CHOSEN]
    weigh(s, OWN + LOG * LANE, OWN + LIKELIHOOD * LANE, w, at, n, best, p[own + FLOOR], p[own + LOG_FLOOR])


class TwoOutput(KalmanBank):
    r"""The bank of 5.2.4, where both states are measured.

    .. math:: z=\begin{bmatrix}y\\ \dot y\end{bmatrix}+v,\quad \psi=P^-+R,\quad
        p_k\leftarrow p_k\,\frac{e^{-r_k^T\psi_k^{-1}r_k/2}}{|\psi_k|^{1/2}}

    The noises of the two outputs are independent, so correcting by one after the other is the same as by both at
    once, likelihood included.
    """

    sample_by_sample = False
    title = "Kalman bank, displacement and velocity"
    inputs = (
        *KalmanBank.inputs,
        Port("velocity", "um/ms", "measured velocity", source="velocimeter.velocity"),
    )
    taps = (
        *KalmanBank.taps,
        Port("velocity_residual", "um/ms", "measured velocity minus that expected by then", each="hypotheses"),
    )
    equations = (
        Equation(
            "likelihood",
            r"f_k=\frac{e^{-r_k^T\psi_k^{-1}r_k/2}}{2\pi|\psi_k|^{1/2}}",
            "5.2.3.2.3",
            printed=r"\beta_k=(2\pi)^{-l/2}|\psi_k|^{-l/2}",
            why="the determinant is to the power one half, whatever the number of outputs; the same only for one",
        ),
    )

    class Params(KalmanParams):
        """Assumptions of the bank."""

        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        velocity_noise_um_ms: float | None = parameter(
            None, "assumed noise of the velocity; what the velocimeter has unless given", "um/ms", gt=0, le=1e4
        )

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        known = getattr(context.sensors.get("velocimeter"), "noise_um_ms", 0.0)
        velocity = max(params.velocity_noise_um_ms or known, 1e-3)
        own = [*floored(params.probability_floor), velocity**2 * params.assumed_noise_scale]
        return np.array(cls.filters(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, all hypotheses alike."""
        n = len(params.hypotheses)
        return np.array(cls.at_rest(params, context, (-math.log(n), 0.0)))

    step = two_output_step
