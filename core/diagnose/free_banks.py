"""Self-tuning banks that all learn from the device: a lesson in what not to do."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core import estimation
from core.block import Context, Equation, FloatArray, parameter
from core.diagnose.arx import (
    COUNT,
    LANES,
    OWN,
    PROBABILITY,
    RESIDUAL_TAP,
    SIZE,
    WIDTH,
    ArxBank,
    ArxParams,
    gathers,
    judge,
    regress,
    unexplained,
)
from core.diagnose.weights import floored, likeliest, weigh

FORGETTING, WINNER_ONLY, LIMIT, FLOOR, LOG_FLOOR = range(5)
H, PRODUCT, LOG = OWN, OWN + 4, OWN + 8
"""State: regressor, scratch; then two lanes of logarithms, and an estimator for each bank."""
DEPTH = 14
"""Numbers of one estimator: four coefficients, half a covariance."""


def free_banks_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Weigh every bank by what it predicts, and let it learn."""
    if gathers(p, s, w, io):
        return
    n = int(p[COUNT])
    own = LANES + WIDTH * n
    z = regress(p, s, w, io, H)
    first = LOG + 2 * n
    best = -math.inf
    for i in range(n):
        theta = first + DEPTH * i
        best = max(best, judge(p, s, w, io, LOG, i, n, unexplained(s, z, H, theta)))
    at = io[PROBABILITY]
    weigh(s, LOG, LOG + n, w, at, n, best, p[own + FLOOR], p[own + LOG_FLOOR])
    winner = likeliest(w, at, n)
    forgetting = p[own + FORGETTING]
    for i in range(n):
        if p[own + WINNER_ONLY] == 0.0 or i == winner:
            theta = first + DEPTH * i
            error = w[io[RESIDUAL_TAP] + i]
            estimation.least_squares(
                s, theta, theta + SIZE, H, PRODUCT, SIZE, error, forgetting, forgetting, p[own + LIMIT]
            )


class FreeBanks(ArxBank):
    r"""Each bank starts at its hypothesis and then learns from the device: all of them become the device.

    .. math:: \hat\theta_k(0)=\theta_k,\qquad \hat\theta_k\leftarrow\hat\theta_k+\frac{\eta h}{\lambda+h^T\eta h}r_k

    With one input and one output to learn from, the residuals of all banks are the same within a hundred samples and
    nothing is left to choose by. When only the winner learns, it learns the fault it should have reported.
    """

    title = "Free self-tuning banks"
    weaknesses = (
        "It does not tell the devices of 5.2.4 apart at any frequency from 200 Hz to 2 kHz: it is right for 11 % of "
        "the samples, as often as damping is the fault.",
    )
    equations = (
        Equation(
            "free estimates",
            r"\hat\theta_k\to\hat\theta\ \text{for all}\ k",
            "5.3.3.8 in each bank",
            printed=r"\text{each bank tunes itself to the measured output}",
            why="banks that follow the device are no hypotheses any more",
        ),
    )

    class Params(ArxParams):
        """Who learns, and how fast."""

        adapting: Literal["all", "winner"] = parameter("all", "banks that learn")
        forgetting: float = parameter(0.86, "forgetting factor", equation="5.3.3.8", ge=0.5, le=1)
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        initial_covariance: float = parameter(
            1e8, "covariance at the start, over unit matrix", equation="5.3.4.1", gt=0, le=1e12, live=False
        )
        trace_limit: float = parameter(1e10, "trace beyond which the covariance stays as it is", gt=0, le=1e100)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        own = [params.forgetting, float(params.adapting == "winner"), params.trace_limit]
        return np.array([*cls.equations_of(params, context), *own, *floored(params.probability_floor)])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Every bank at its hypothesis, all alike."""
        n = len(params.hypotheses)
        lanes = np.array(cls.equations_of(params, context)[LANES:]).reshape(WIDTH, n)
        covariance = estimation.diagonal(SIZE, params.initial_covariance)
        banks = [value for i in range(n) for value in (*lanes[:SIZE, i], *covariance)]
        return np.array([0.0] * LOG + [-math.log(n)] * n + [0.0] * n + banks)

    step = free_banks_step
