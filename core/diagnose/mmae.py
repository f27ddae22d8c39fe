"""Kalman bank with multiple-model adaptive estimation."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Context, Equation, Stage, parameter
from core.diagnose.excitation import EVIDENCE, LEAST_INFORMATION, nearest_rival
from core.diagnose.filters import between_updates, filters_step, informed, judge, take_logarithms
from core.diagnose.kalman import FILTERS, KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, take_floored_softmax
from core.elementary import exp, log
from core.kernel import kernel, whole
from core.ports import tap
from core.record import Choice, Vector, vector

TWO_PI_ROOT = math.sqrt(2.0 * math.pi)


@kernel
def multiply(s: Mmae.State, probability: Vector, n: int, floor: float, evidence: bool) -> None:
    """Normalise products of densities and probabilities; if all of them are 0, keep the last probabilities."""
    total = 0.0
    for i in range(n):
        share = s.weight[i]
        if evidence:
            # a density times a probability, as printed: either may underflow
            density = exp(-0.5 * s.nis[i])
            share *= density / (TWO_PI_ROOT * exp(s.half_log[i]))
        s.likelihood[i] = share
        total += share
    if total > 0.0 and math.isfinite(total):
        after = 0.0
        for i in range(n):
            share = max(s.likelihood[i] / total, floor)
            s.weight[i] = share
            after += share
        for i in range(n):
            s.weight[i] /= after
    for i in range(n):
        probability[i] = s.weight[i]


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
    equations = (
        *KalmanBank.equations,
        Equation(
            "probabilities",
            r"\ell_k\leftarrow\ell_k-\tfrac{r_k^2}{2\psi_k}-\tfrac12\ln\psi_k,"
            r"\quad p_k=\max(\mathrm{softmax}_k\,\ell,\;p_{min})",
            "5.2.3.2.6",
            printed=r"p_k(t_i)=\frac{f_k\,p_k(t_{i-1})}{\sum_j f_j\,p_j(t_{i-1})}",
            why="as printed the probabilities of the faults sink without limit while the device is healthy, and steps "
            "2 to 6 are never found",
        ),
    )
    structure = (
        FILTERS,
        Stage("Likelihoods", "weight nis covariance", "likelihood", ("probabilities",)),
        Stage("Weights", "likelihood", "weight probability", ("probabilities",)),
        EVIDENCE,
    )

    class Params(KalmanParams):
        """Assumptions of the Kalman filters, and parameters of this bank."""

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

    class Packed(KalmanBank.Packed):
        """Parameters of the filters; whether probabilities are stored as such, their floor and its logarithm."""

        linear: Choice
        probability_floor: float
        log_floor: float

    class State(KalmanBank.State):
        """The filters; logarithms of probabilities (linear: probabilities); probabilities of a sample; separations."""

        weight: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)
        separation: Vector = vector(LANE)

    class Ports(KalmanBank.Ports):
        """Ports of every bank, and the evidence per sample."""

        information: float = tap("nat", "evidence per sample against the nearest rival of the winner")
        unexcited: float = tap("1", "1 while the drive hardly tells the winner from its nearest rival")

    @classmethod
    def floor(cls, params: Any) -> float:
        """Return the smallest probability."""
        return float(params.probability_floor)

    @classmethod
    def takes_steady_gains(cls, params: Any) -> bool:
        """Return whether the gains are the steady gains."""
        return bool(params.form == "steady")

    @classmethod
    def leaves_sensor_noise_out(cls, params: Any) -> bool:
        """Return whether the residual covariance is the formula of the text, without R."""
        return bool(params.residual_covariance == "printed")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.filters(cls.Packed.blank(), params, context)
        p.linear = params.arithmetic == "linear"
        p.probability_floor, p.log_floor = floored(params.probability_floor)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, all hypotheses alike."""
        s = cls.at_rest(cls.State.zeros(), params, context)
        n = len(params.hypotheses)
        s.weight[:] = 1.0 / n if params.arithmetic == "linear" else -log(n)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict and correct every filter, then weigh the hypotheses."""
        n = int(p.count)
        if between_updates(p, s, x, 0, whole(n)):
            return
        evidence = informed(p, s, x)
        if filters_step(p, s, x, n):
            take_logarithms(s, n)
        if p.linear == 0.0:
            best = judge(s, s.weight, s.likelihood, n, evidence)
            take_floored_softmax(s.weight, s.likelihood, x.probability, n, best, p.probability_floor, p.log_floor)
        else:
            multiply(s, x.probability, n, p.probability_floor, evidence)
        information = nearest_rival(p, s, s.separation, x.probability, n)
        x.information = information
        x.unexcited = 1.0 if information < LEAST_INFORMATION else 0.0
