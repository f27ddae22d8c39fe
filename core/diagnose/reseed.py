"""Multiple-model estimation whose hopeless filters start again from the winner's state."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from core.block import Context, Equation, Stage, parameter
from core.diagnose.filters import between_updates, filters_step, hand_over, informed, judge, take_logarithms
from core.diagnose.kalman import FILTERS, KalmanBank, KalmanParams
from core.diagnose.lanes import LANE, Filters
from core.diagnose.weights import floored, take_floored_softmax, winner_of
from core.elementary import log
from core.kernel import kernel, whole
from core.record import Vector, vector


@kernel
def reseed(s: Filters, probability: Vector, n: int, sure: float, hopeless: float) -> None:
    """Copy the state of a sure winner into the filters of hopeless hypotheses."""
    winner = winner_of(probability, n)
    if probability[winner] <= sure:
        return
    for i in range(n):
        if probability[i] < hopeless:
            hand_over(s, winner, i)


class Reseed(KalmanBank):
    r"""A bank with the true, small noise, whose hopeless filters are given the winner's state now and then.

    .. math:: p_j>p_{sure},\;p_k<p_{hopeless}\;\Rightarrow\;x_k\leftarrow x_j,\;P_k\leftarrow P_j\quad
        \text{every } M \text{ samples}

    A filter with little noise is almost a simulator: after a jump, the filter of the true hypothesis still carries the
    motion of a device that did not exist. Seeding cures that without pseudo-noise.
    """

    title = "Re-seeding bank"
    equations = (Equation("seeding", r"p_j>p_{sure},\;p_k<p_{hopeless}\Rightarrow(x_k,P_k)\leftarrow(x_j,P_j)"),)
    structure = (
        replace(FILTERS, takes="measured applied x1 x2"),
        Stage("Likelihoods", "log nis covariance", "likelihood"),
        Stage("Weights", "likelihood", "log probability"),
        Stage("Seeding", "probability", "x1 x2", ("seeding",)),
    )

    class Params(KalmanParams):
        """Assumptions of the Kalman filters, and parameters of this bank."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        interval: int = parameter(100, "samples between two seedings", ge=1, le=100_000)
        sure: float = parameter(0.9, "probability above which a winner passes on its state", ge=0.5, le=1)
        hopeless: float = parameter(0.01, "probability below which a filter is given it", ge=0, le=0.5)

    class Packed(KalmanBank.Packed):
        """Parameters of the filters; floor under probabilities and its logarithm, period and limits of a seeding."""

        probability_floor: float
        log_floor: float
        interval: float
        sure: float
        hopeless: float

    class State(KalmanBank.State):
        """The filters; logarithms of probabilities, logarithms of this sample, samples since the last seeding."""

        log: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)
        counter: float

    @classmethod
    def floor(cls, params: Any) -> float:
        """Return the smallest probability."""
        return float(params.probability_floor)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.filters(cls.Packed.blank(), params, context)
        p.probability_floor, p.log_floor = floored(params.probability_floor)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, all hypotheses alike; the samples since the last seeding."""
        s = cls.at_rest(cls.State.zeros(), params, context)
        s.log[:] = -log(len(params.hypotheses))
        return s

    @staticmethod
    def step(p: Packed, s: State, x: KalmanBank.Ports) -> None:
        """Predict, correct, weigh; now and then seed anew."""
        n = int(p.count)
        if between_updates(p, s, x, 0, whole(n)):
            return
        evidence = informed(p, s, x)
        if filters_step(p, s, x, n):
            take_logarithms(s, n)
        best = judge(s, s.log, s.likelihood, n, evidence)
        take_floored_softmax(s.log, s.likelihood, x.probability, n, best, p.probability_floor, p.log_floor)
        s.counter += 1.0
        if s.counter >= p.interval:
            s.counter = 0.0
            reseed(s, x.probability, n, p.sure, p.hopeless)
