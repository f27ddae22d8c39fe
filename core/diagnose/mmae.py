"""Kalman bank with multiple-model adaptive estimation."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Context, Equation, FloatArray, Port, kernel, parameter
from core.diagnose.excitation import LEAST_INFORMATION, nearest_rival
from core.diagnose.filters import (
    COUNT,
    DEPTH,
    HALF_LOG,
    LANES,
    NIS,
    OWN,
    PROBABILITY,
    WIDTH,
    coasts,
    filters_step,
    informed,
    judge,
    take_logarithms,
)
from core.diagnose.kalman import KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, weigh

LINEAR, FLOOR, LOG_FLOOR = range(3)
"""Parameters of its own."""
LOG, LIKELIHOOD, SEPARATION = DEPTH, DEPTH + 1, DEPTH + 2
"""Lanes of its own; with linear arithmetic the first holds the probabilities themselves."""
RESIDUAL_TAP, NIS_TAP, INFORMATION, UNEXCITED = range(PROBABILITY + 1, PROBABILITY + 5)
TWO_PI_ROOT = math.sqrt(2.0 * math.pi)


@kernel
def multiply(s: Any, n: int, w: Any, probability: int, floor: float, evidence: bool) -> None:
    """Normalise products of densities and probabilities; where nothing is left of them, keep what was."""
    total = 0.0
    for i in range(n):
        share = s[OWN + LOG * LANE + i]
        if evidence:
            # a density times a probability, as printed: either may be too small for a number
            density = math.exp(-0.5 * s[OWN + NIS * LANE + i])
            share *= density / (TWO_PI_ROOT * math.exp(s[OWN + HALF_LOG * LANE + i]))
        s[OWN + LIKELIHOOD * LANE + i] = share
        total += share
    if total > 0.0 and math.isfinite(total):
        after = 0.0
        for i in range(n):
            share = max(s[OWN + LIKELIHOOD * LANE + i] / total, floor)
            s[OWN + LOG * LANE + i] = share
            after += share
        for i in range(n):
            s[OWN + LOG * LANE + i] /= after
    for i in range(n):
        w[probability + i] = s[OWN + LOG * LANE + i]


def mmae_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict and correct every filter, then weigh the hypotheses."""
    n = int(p[COUNT])
    if coasts(p, s, w, io, LANE, 0, n):
        return
    own = LANES + WIDTH * LANE
    evidence = informed(p, s, w, io)
    if filters_step(p, s, w, io, n, RESIDUAL_TAP):
        take_logarithms(s, n)
    at = io[PROBABILITY]
    if p[own + LINEAR] == 0.0:
        best = judge(s, OWN + LOG * LANE, OWN + LIKELIHOOD * LANE, n, evidence)
        weigh(s, OWN + LOG * LANE, OWN + LIKELIHOOD * LANE, w, at, n, best, p[own + FLOOR], p[own + LOG_FLOOR])
    else:
        multiply(s, n, w, at, p[own + FLOOR], evidence)
    information = nearest_rival(p, s, OWN + SEPARATION * LANE, n, w, at)
    w[io[INFORMATION]] = information
    w[io[UNEXCITED]] = 1.0 if information < LEAST_INFORMATION else 0.0


class Mmae(KalmanBank):
    r"""A Kalman filter for each hypothesis, weighed by how well it predicts (5.2.3).

    .. math:: x^-=\Phi x+\Gamma u,\quad P^-=\Phi P\Phi^T+\Gamma Q\Gamma^T,\quad \psi=HP^-H^T+R

    .. math:: r=z-Hx^-,\quad K=P^-H^T/\psi,\quad
        p_k\leftarrow\frac{p_k\,\psi_k^{-1/2}e^{-r_k^2/2\psi_k}}{\sum_j p_j\,\psi_j^{-1/2}e^{-r_j^2/2\psi_j}}

    Probabilities are kept as logarithms and above a floor. Without a floor the recursion as printed locks: after
    2000 healthy samples no fault of 1000 samples can repay the odds. In linear arithmetic it locks for good, since a
    probability that has become 0 stays 0; when all of them would, they stay as they were.
    """

    title = "Kalman bank (MMAE)"
    taps = (
        *KalmanBank.taps,
        Port("information", "nat", "evidence per sample against the nearest rival of the winner"),
        Port("unexcited", "1", "1 while the drive hardly tells the winner from its nearest rival"),
    )
    equations = (
        Equation(
            "filter",
            r"x^-=\Phi x+\Gamma u,\; r=z-Hx^-,\; x^+=x^-+Kr,\; K=P^-H^T\psi^{-1}",
            "5.2.3.1.1-7",
            printed=r"\hat x(t_i)\ \text{on both sides, with the gain of the predictor } \Phi P H^T\psi^{-1}",
            why="either the filter form or the predictor form, not a mixture; the residual is taken before the update",
        ),
        Equation(
            "residual covariance",
            r"\psi=HP^-H^T+R",
            "5.2.3.2.1",
            printed=r"\psi=CPC^T",
            why="without R the filter believes its residuals hundreds of times too much: 732 false switches a "
            "run instead of 1",
        ),
        Equation(
            "probabilities",
            r"\ell_k\leftarrow\ell_k-\tfrac{r_k^2}{2\psi_k}-\tfrac12\ln\psi_k,"
            r"\quad p_k=\max(\mathrm{softmax}_k\,\ell,\;p_{min})",
            "5.2.3.2.6",
            printed=r"p_k(t_i)=\frac{f_k\,p_k(t_{i-1})}{\sum_j f_j\,p_j(t_{i-1})}",
            why="as printed the probabilities of the faults sink for ever while the device is healthy, and steps "
            "2 to 6 are never found",
        ),
    )

    class Params(KalmanParams):
        """Assumptions of the bank."""

        form: Literal["recursive", "steady"] = parameter("recursive", "covariances propagated, or gains at their limit")
        residual_covariance: Literal["correct", "printed"] = parameter(
            "correct", "psi with or without R", equation="5.2.3.2.1"
        )
        probability_floor: float = parameter(
            1e-3, "smallest probability; 0 as printed", equation="5.2.3.2.6", ge=0, le=0.05
        )
        arithmetic: Literal["logarithmic", "linear"] = parameter(
            "logarithmic", "what probabilities are kept as; linear as printed", equation="5.2.3.2.6", live=False
        )

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array([*cls.filters(params, context), *cls.weighing(params)])

    @classmethod
    def weighing(cls, params: Any) -> list[float]:
        """Pack how probabilities are kept."""
        return [float(params.arithmetic == "linear"), *floored(params.probability_floor)]

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, all hypotheses alike."""
        n = len(params.hypotheses)
        log = 1.0 / n if params.arithmetic == "linear" else -math.log(n)
        return np.array(cls.at_rest(params, context, (log, 0.0, 0.0)))

    step = mmae_step
