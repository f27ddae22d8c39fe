"""Three filters that follow one parameter along a fixed bank."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.diagnose.filters import (
    COUNT,
    COVARIANCE,
    DEPTH,
    HALF_LOG,
    LANES,
    MEASURED,
    NIS,
    OWN,
    PROBABILITY,
    RESIDUAL,
    STARTED,
    WIDTH,
    coasts,
    driven,
    filter_step,
    hand_over,
)
from core.diagnose.hypothesis import Hypothesis
from core.diagnose.kalman import FilterParams, KalmanBank
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, weigh

FLOOR, LOG_FLOOR, MOVE_ABOVE, SPACING = range(4)
LOG, LIKELIHOOD, CENTRE = DEPTH, DEPTH + 1, DEPTH + 2
ESTIMATE = PROBABILITY + 1
RESIDUAL_TAP, NIS_TAP = PROBABILITY + 2, PROBABILITY + 3


def moving_bank_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Run the filter in the centre and its two neighbours; go where the evidence is."""
    n = int(p[COUNT])
    lane = max(n, LANE)
    centre = int(s[OWN + CENTRE * lane])
    if coasts(p, s, w, io, lane, centre - 1, centre + 2):
        return
    own = LANES + WIDTH * lane
    z = w[io[MEASURED]]
    first = s[STARTED] == 0.0
    s[STARTED] = 1.0
    seen = math.isfinite(z)
    evidence = seen and driven(p, s)
    low = centre - 1
    best = -math.inf
    for j in range(3):
        i = low + j
        if filter_step(p, s, i, lane, z, first, seen) != 0:
            s[OWN + HALF_LOG * lane + i] = 0.5 * math.log(s[OWN + COVARIANCE * lane + i])
        nis = s[OWN + NIS * lane + i]
        w[io[RESIDUAL_TAP] + j] = s[OWN + RESIDUAL * lane + i]
        w[io[NIS_TAP] + j] = nis
        log = s[OWN + LOG * lane + i]
        if evidence:
            log += -0.5 * nis - s[OWN + HALF_LOG * lane + i]
        s[OWN + LIKELIHOOD * lane + i] = log
        best = max(best, log)
    at = io[PROBABILITY]
    logs = OWN + LOG * lane + low
    weigh(s, logs, OWN + LIKELIHOOD * lane + low, w, at, 3, best, p[own + FLOOR], p[own + LOG_FLOOR])
    half = n // 2
    w[io[ESTIMATE]] = 1.0 + p[own + SPACING] * (low - half + w[at + 1] + 2.0 * w[at + 2])
    step = 1 if w[at + 2] > p[own + MOVE_ABOVE] else -1 if w[at] > p[own + MOVE_ABOVE] else 0
    if step != 0 and 1 <= centre + step <= n - 2:
        # the one that comes in starts where its neighbour is
        new = centre + 2 * step
        edge = centre + step
        hand_over(s, lane, edge, new)
        s[OWN + LOG * lane + new] = p[own + LOG_FLOOR]
        s[OWN + CENTRE * lane] = centre + step


class MovingBank(KalmanBank):
    r"""Follows a slow drift: a centre and its neighbours on either side, moved when a neighbour is the likelier.

    .. math:: \hat f=\sum_kp_kf_k,\qquad f_k=1+(k-k_0)\Delta

    Three filters see as finely as a bank of dozens, as long as the parameter does not jump over them (Maybeck and
    Hentz 1987).
    """

    sample_by_sample = False
    title = "Moving bank"
    outputs = (
        Port("probability", "1", "probability of the filter", labels=("lower", "centre", "upper")),
        Port("estimate", "1", "estimated factor on the parameter"),
    )
    taps = (
        Port("residual", "um", "measured minus predicted displacement", labels=("lower", "centre", "upper")),
        Port("nis", "1", "normalised residual squared", labels=("lower", "centre", "upper")),
    )
    equations = (Equation("estimate", r"\hat f=\sum_kp_kf_k", "Maybeck and Hentz 1987"),)

    class Params(FilterParams):
        """What is followed, and how finely."""

        follows: Literal["stiffness", "mass", "damping", "gain"] = parameter(
            "stiffness", "parameter that is followed", live=False
        )
        spacing: float = parameter(0.025, "distance of neighbours, as a share of nominal", ge=1e-3, le=0.2, live=False)
        reach: int = parameter(16, "steps to either side", ge=2, le=60, live=False)
        move_above: float = parameter(0.5, "probability above which a neighbour becomes the centre", ge=0.5, le=1)
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=1e-9, le=0.05)

        @property
        def models(self) -> list[Hypothesis]:
            """The whole bank; what is not positive is left at the smallest."""
            steps = range(-self.reach, self.reach + 1)
            return [
                Hypothesis(name=f"{self.follows}{i:+d}", **{self.follows: max(1.0 + self.spacing * i, self.spacing)})
                for i in steps
            ]

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        own = [*floored(params.probability_floor), params.move_above, params.spacing]
        return np.array(cls.filters(params, context, params.models) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, the nominal one in the centre."""
        lanes = cls.at_rest(params, context, (-math.log(3.0), 0.0), count=2 * params.reach + 1)
        return np.array([*lanes, float(params.reach)])

    step = moving_bank_step
