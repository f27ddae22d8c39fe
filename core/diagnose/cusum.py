"""Cumulative sums of the log-likelihood ratio of each fault against the healthy device."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
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
    take_logarithms,
)
from core.diagnose.kalman import KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import share_out

THRESHOLD = 0
SUM, LIKELIHOOD = DEPTH, DEPTH + 1
ALARM = PROBABILITY + 1
RESIDUAL_TAP, NIS_TAP, SUM_TAP = range(PROBABILITY + 2, PROBABILITY + 5)


def cusum_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, correct, add up, compare with the threshold."""
    n = int(p[COUNT])
    if coasts(p, s, w, io, LANE, 0, n):
        return
    threshold = p[LANES + WIDTH * LANE + THRESHOLD]
    evidence = informed(p, s, w, io)
    if filters_step(p, s, w, io, n, RESIDUAL_TAP):
        take_logarithms(s, n)
    healthy = 0.0
    most = 0.0
    for i in range(n):
        log = -0.5 * s[OWN + NIS * LANE + i] - s[OWN + HALF_LOG * LANE + i]
        if i == 0:
            healthy = log
        elif evidence:
            s[OWN + SUM * LANE + i] = max(s[OWN + SUM * LANE + i] + log - healthy, 0.0)
            most = max(most, s[OWN + SUM * LANE + i])
    # a sum far beyond the threshold would not let go when the fault is gone
    over = most - 2.0 * threshold
    best = threshold
    s[OWN + LIKELIHOOD * LANE] = threshold
    for i in range(1, n):
        total = s[OWN + SUM * LANE + i]
        if over > 0.0:
            total = max(total - over, 0.0)
            s[OWN + SUM * LANE + i] = total
        s[OWN + LIKELIHOOD * LANE + i] = total
        best = max(best, total)
    for i in range(n):
        w[io[SUM_TAP] + i] = s[OWN + SUM * LANE + i]
    w[io[ALARM]] = 1.0 if most > threshold else 0.0
    share_out(s, OWN + LIKELIHOOD * LANE, w, io[PROBABILITY], n, best)


class Cusum(KalmanBank):
    r"""Page's test of each fault against the healthy device, the first hypothesis.

    .. math:: g_k\leftarrow\max\Bigl(0,\;g_k+\ln\frac{f_k(r_k)}{f_0(r_0)}\Bigr),\qquad \text{alarm when }\max_kg_k>h

    The quickest there is for the fault it was built for, blind to others (Page 1954; Basseville and Nikiforov 1993).
    The probability is that of the sums as log-odds, the threshold standing for the healthy device; no sum grows
    beyond twice the threshold.
    """

    sample_by_sample = False
    title = "Cumulative sums (CUSUM)"
    outputs = (*KalmanBank.outputs, Port("alarm", "1", "1 while a sum is beyond the threshold"))
    taps = (*KalmanBank.taps, Port("sum", "nat", "cumulative sum against the healthy device", each="hypotheses"))
    equations = (Equation("sum", r"g_k\leftarrow\max(0,\;g_k+\ln f_k-\ln f_0)", "Page 1954"),)

    class Params(KalmanParams):
        """Assumptions of the test."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        threshold: float = parameter(10.0, "sum at which there is an alarm", "nat", gt=0, le=1000)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array([*cls.filters(params, context), params.threshold])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, all sums 0."""
        return np.array(cls.at_rest(params, context, (0.0, 0.0)))

    step = cusum_step
