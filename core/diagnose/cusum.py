"""Cumulative sums of the log-likelihood ratio of each fault against the healthy device."""

from __future__ import annotations

from core.block import Equation, Stage, parameter
from core.diagnose.filters import between_updates, filters_step, informed, take_logarithms
from core.diagnose.kalman import FILTERS, KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import take_softmax
from core.kernel import whole
from core.ports import output, tap
from core.record import Vector, vector


class Cusum(KalmanBank):
    r"""Page's test of each fault against the healthy device, the first hypothesis.

    .. math:: g_k\leftarrow\max\Bigl(0,\;g_k+\ln\frac{f_k(r_k)}{f_0(r_0)}\Bigr),\qquad \text{alarm when }\max_kg_k>h

    No test detects the fault it was built for more quickly, and it is blind to others (Page 1954; Basseville and
    Nikiforov 1993). The probability takes the sums as log-odds, with the threshold standing for the healthy device; no
    sum grows beyond twice the threshold.
    """

    sample_by_sample = False
    title = "Cumulative sums (CUSUM)"
    equations = (Equation("sum", r"g_k\leftarrow\max(0,\;g_k+\ln f_k-\ln f_0)", "Page 1954"),)
    structure = (
        FILTERS,
        Stage("Cumulative sums", "nis covariance", "sum", ("sum",)),
        Stage("Threshold", "sum", "alarm"),
        Stage("Weights", "sum", "probability"),
    )

    class Params(KalmanParams):
        """Assumptions of the test."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        threshold: float = parameter(10.0, "sum at which there is an alarm", "nat", gt=0, le=1000)

    class Packed(KalmanBank.Packed):
        """Parameters of the filters; sum that raises the alarm."""

        threshold: float

    class State(KalmanBank.State):
        """The filters; cumulative sums, and these as log-odds."""

        sum: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)

    class Ports(KalmanBank.Ports):
        """Ports of every bank; alarm and sums."""

        alarm: float = output("1", "1 while a sum is beyond the threshold")
        sum: Vector = tap("nat", "cumulative sum against the healthy device", each="hypotheses")

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict, correct, add up, compare with the threshold."""
        n = int(p.count)
        if between_updates(p, s, x, 0, whole(n)):
            return
        threshold = p.threshold
        evidence = informed(p, s, x)
        if filters_step(p, s, x, n):
            take_logarithms(s, n)
        healthy = 0.0
        most = 0.0
        for i in range(n):
            log = -0.5 * s.nis[i] - s.half_log[i]
            if i == 0:
                healthy = log
            elif evidence:
                s.sum[i] = max(s.sum[i] + log - healthy, 0.0)
                most = max(most, s.sum[i])
        # a sum far beyond the threshold would keep the alarm after the fault is gone
        over = most - 2.0 * threshold
        best = threshold
        s.likelihood[0] = threshold
        for i in range(1, n):
            total = s.sum[i]
            if over > 0.0:
                total = max(total - over, 0.0)
                s.sum[i] = total
            s.likelihood[i] = total
            best = max(best, total)
        sums = x.sum
        for i in range(n):
            sums[i] = s.sum[i]
        x.alarm = 1.0 if most > threshold else 0.0
        take_softmax(s.likelihood, x.probability, n, best)
