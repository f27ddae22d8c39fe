"""Multiple-model estimation whose hopeless filters start again from the winner's state."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, kernel, parameter
from core.diagnose.filters import (
    COUNT,
    DEPTH,
    LANES,
    OWN,
    PROBABILITY,
    WIDTH,
    coasts,
    filters_step,
    hand_over,
    informed,
    judge,
    take_logarithms,
)
from core.diagnose.kalman import KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, likeliest, weigh

FLOOR, LOG_FLOOR, INTERVAL, SURE, HOPELESS = range(5)
LOG, LIKELIHOOD, COUNTER = DEPTH, DEPTH + 1, DEPTH + 2
RESIDUAL_TAP, NIS_TAP = PROBABILITY + 1, PROBABILITY + 2


@kernel
def reseed(s: Any, n: int, w: Any, probability: int, sure: float, hopeless: float) -> None:
    """Copy the state of a sure winner into the filters of those without hope."""
    winner = likeliest(w, probability, n)
    if w[probability + winner] <= sure:
        return
    for i in range(n):
        if w[probability + i] < hopeless:
            hand_over(s, LANE, winner, i)


def reseed_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, correct, weigh; now and then seed anew."""
    n = int(p[COUNT])
    if coasts(p, s, w, io, LANE, 0, n):
        return
    own = LANES + WIDTH * LANE
    evidence = informed(p, s, w, io)
    if filters_step(p, s, w, io, n, RESIDUAL_TAP):
        take_logarithms(s, n)
    best = judge(s, OWN + LOG * LANE, OWN + LIKELIHOOD * LANE, n, evidence)
    at = io[PROBABILITY]
    weigh(s, OWN + LOG * LANE, OWN + LIKELIHOOD * LANE, w, at, n, best, p[own + FLOOR], p[own + LOG_FLOOR])
    counter = OWN + COUNTER * LANE
    s[counter] += 1.0
    if s[counter] >= p[own + INTERVAL]:
        s[counter] = 0.0
        reseed(s, n, w, at, p[own + SURE], p[own + HOPELESS])


class Reseed(KalmanBank):
    r"""A bank with the true, small noise, whose hopeless filters are given the winner's state now and then.

    .. math:: p_j>p_{sure},\;p_k<p_{hopeless}\;\Rightarrow\;x_k\leftarrow x_j,\;P_k\leftarrow P_j\quad
        \text{every } M \text{ samples}

    A filter with little noise is a simulator: after a jump the right one still carries the motion of a device that
    was not there. Seeding cures that without pseudo-noise.
    """

    title = "Re-seeding bank"
    equations = (Equation("seeding", r"p_j>p_{sure},\;p_k<p_{hopeless}\Rightarrow(x_k,P_k)\leftarrow(x_j,P_j)"),)

    class Params(KalmanParams):
        """Assumptions of the bank."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        interval: int = parameter(100, "samples between two seedings", ge=1, le=100_000)
        sure: float = parameter(0.9, "probability above which a winner passes on its state", ge=0.5, le=1)
        hopeless: float = parameter(0.01, "probability below which a filter is given it", ge=0, le=0.5)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        own = [*floored(params.probability_floor), float(params.interval), params.sure, params.hopeless]
        return np.array(cls.filters(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, all hypotheses alike; the samples since the last seeding."""
        n = len(params.hypotheses)
        return np.array([*cls.at_rest(params, context, (-math.log(n), 0.0)), 0.0])

    step = reseed_step
