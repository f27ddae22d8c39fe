"""Three filters that follow one parameter along a fixed bank."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Literal

from core.block import Context, Equation, Stage, parameter
from core.diagnose.filters import BankPorts, between_updates, driven, filter_step, hand_over
from core.diagnose.hypothesis import Hypothesis
from core.diagnose.kalman import FILTERS, FilterParams, KalmanBank
from core.diagnose.lanes import LANE
from core.diagnose.weights import floored, take_floored_softmax
from core.elementary import log
from core.ports import output, tap
from core.record import Vector, tail, vector
from core.voltage import observed

THREE = ("lower", "centre", "upper")
"""The filters that run."""


class MovingBank(KalmanBank):
    r"""Follows a slow drift: a centre and its neighbours on either side, moved when a neighbour is the likelier.

    .. math:: \hat f=\sum_kp_kf_k,\qquad f_k=1+(k-k_0)\Delta

    Three filters see as finely as a bank of dozens, as long as the parameter does not jump over them (Maybeck and
    Hentz 1987).
    """

    sample_by_sample = False
    title = "Moving bank"
    lengths = ("reach",)
    equations = (Equation("estimate", r"\hat f=\sum_kp_kf_k", "Maybeck and Hentz 1987"),)
    structure = (
        replace(FILTERS, takes="measured applied centre"),
        Stage("Likelihoods", "log nis covariance", "likelihood"),
        Stage("Weights", "likelihood", "log probability"),
        Stage("Estimate", "probability centre", "estimate", ("estimate",)),
        Stage("Move", "probability", "centre"),
    )

    class Params(FilterParams):
        """The parameter to follow, and the step of the grid."""

        follows: Literal["stiffness", "mass", "damping", "gain"] = parameter(
            "stiffness", "parameter that is followed", live=False
        )
        spacing: float = parameter(0.025, "distance of neighbours, as a share of nominal", ge=1e-3, le=0.2, live=False)
        reach: int = parameter(16, "steps to either side", ge=2, le=60, live=False)
        move_above: float = parameter(0.5, "probability above which a neighbour becomes the centre", ge=0.5, le=1)
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=1e-9, le=0.05)

        @property
        def models(self) -> list[Hypothesis]:
            """The whole bank; factors that would not be positive are set to the smallest one."""
            return [
                Hypothesis(name=f"{self.follows}{i:+d}", **{self.follows: max(1.0 + self.spacing * i, self.spacing)})
                for i in range(-self.reach, self.reach + 1)
            ]

    class Packed(KalmanBank.Packed):
        """Parameters of the filters for any number of models, which run one by one and need no common lane.

        Then the floor under probabilities and its logarithm, the probability that moves the centre, the spacing of the
        bank.
        """

        probability_floor: float
        log_floor: float
        move_above: float
        spacing: float
        phi11: Vector = tail()
        phi12: Vector = tail()
        phi21: Vector = tail()
        phi22: Vector = tail()
        noise11: Vector = tail()
        noise12: Vector = tail()
        noise22: Vector = tail()
        gain1: Vector = tail()
        gain2: Vector = tail()
        psi: Vector = tail()
        inverse_psi: Vector = tail()
        tick11: Vector = tail()
        tick12: Vector = tail()
        tick21: Vector = tail()
        tick22: Vector = tail()
        push1: Vector = tail()
        push2: Vector = tail()
        middle1: Vector = tail()
        middle2: Vector = tail()
        end1: Vector = tail()
        end2: Vector = tail()

    class State(KalmanBank.State):
        """All filters; the centre filter; logarithms of probabilities of the three that run, and of this sample."""

        centre: float
        log: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)
        x1: Vector = tail()
        x2: Vector = tail()
        p11: Vector = tail()
        p12: Vector = tail()
        p22: Vector = tail()
        residual: Vector = tail()
        nis: Vector = tail()
        covariance: Vector = tail()
        inverse: Vector = tail()
        gain1: Vector = tail()
        gain2: Vector = tail()
        half_log: Vector = tail()
        pushed1: Vector = tail()
        pushed2: Vector = tail()

    class Ports(BankPorts):
        """Measurement and voltage; the three filters, and the estimate."""

        probability: Vector = output("1", "probability of the filter", labels=THREE)
        estimate: float = output("1", "estimated factor on the parameter")
        residual: Vector = tap("um", "measured minus predicted displacement", labels=THREE)
        nis: Vector = tap("1", "normalised residual squared", labels=THREE)
        gain_displacement: Vector = tap("1", "Kalman gain of the displacement", labels=THREE)
        gain_velocity: Vector = tap("1/ms", "Kalman gain of the velocity", labels=THREE)
        state_displacement: Vector = tap("um", "displacement under the filter", labels=THREE)
        state_velocity: Vector = tap("um/ms", "velocity under the filter", labels=THREE)
        variance_displacement: Vector = tap("um^2", "variance of this displacement", labels=THREE, hidden=True)
        covariance: Vector = tap("um^2/ms", "covariance of displacement and velocity", labels=THREE, hidden=True)
        variance_velocity: Vector = tap("um^2/ms^2", "variance of this velocity", labels=THREE, hidden=True)

    @classmethod
    def floor(cls, params: Any) -> float:
        """Return the smallest probability."""
        return float(params.probability_floor)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        models = params.models
        p = cls.filters(cls.Packed.blank(len(models)), params, context, models)
        p.probability_floor, p.log_floor = floored(params.probability_floor)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, the nominal filter in the centre."""
        s = cls.at_rest(cls.State.zeros(len(params.models)), params, context)
        s.centre = params.reach
        s.log[:] = -log(3.0)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Run the filter in the centre and its two neighbours; move the centre if a neighbour is likelier."""
        n = int(p.count)
        centre = int(s.centre)
        if between_updates(p, s, x, centre - 1, centre + 2):
            return
        z = observed(x)
        first = s.started == 0.0
        s.started = 1.0
        seen = math.isfinite(z)
        evidence = seen and driven(p, s)
        low = centre - 1
        best = -math.inf
        for j in range(3):
            i = low + j
            if filter_step(p, s, i, z, first, seen) != 0:
                s.half_log[i] = 0.5 * log(s.covariance[i])
            nis = s.nis[i]
            x.residual[j] = s.residual[i]
            x.nis[j] = nis
            x.gain_displacement[j] = s.gain1[i]
            x.gain_velocity[j] = s.gain2[i]
            x.state_displacement[j] = s.x1[i]
            x.state_velocity[j] = s.x2[i]
            x.variance_displacement[j] = s.p11[i]
            x.covariance[j] = s.p12[i]
            x.variance_velocity[j] = s.p22[i]
            likelihood = s.log[j]
            if evidence:
                likelihood += -0.5 * nis - s.half_log[i]
            s.likelihood[j] = likelihood
            best = max(best, likelihood)
        probability = x.probability
        take_floored_softmax(s.log, s.likelihood, probability, 3, best, p.probability_floor, p.log_floor)
        half = n // 2
        x.estimate = 1.0 + p.spacing * (low - half + probability[1] + 2.0 * probability[2])
        step = 1 if probability[2] > p.move_above else -1 if probability[0] > p.move_above else 0
        if step != 0 and 1 <= centre + step <= n - 2:
            # the new filter starts with the state of its neighbour
            edge = centre + step
            hand_over(s, edge, edge + step)
            if step > 0:
                s.log[0] = s.log[1]
                s.log[1] = s.log[2]
                s.log[2] = p.log_floor
            else:
                s.log[2] = s.log[1]
                s.log[1] = s.log[0]
                s.log[0] = p.log_floor
            s.centre = edge
