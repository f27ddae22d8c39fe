"""Diagnosis by estimated spring and damper: which hypotheses are near the estimate of an extended Kalman filter."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, Oscillator, Stage, parameter
from core.diagnose import window
from core.diagnose.consistency import Conclusion, ConclusionParams, PackedConclusion, concluded
from core.diagnose.hypothesis import BankParams, lacking
from core.diagnose.judge import Judge
from core.diagnose.lanes import LANE
from core.diagnose.weights import take_softmax
from core.elementary import log
from core.joint_filter import (
    EQUATIONS,
    FILTER,
    Joint,
    JointFilterParams,
    JointPorts,
    PackedJointFilter,
    fill_joint,
    fill_start,
    follow,
)
from core.kernel import kernel
from core.ports import output, tap
from core.record import Record, Vector, vector

LEAST_INDEPENDENT = 1e-12
"""Smallest determinant of the covariance, over the product of both variances."""


class EkfDiagnoser(Judge):
    r"""Places each hypothesis in the plane of spring and damper, and compares it with the estimate there.

    .. math:: d_k^2=(\hat\theta-\theta_k)^TP_\theta^{-1}(\hat\theta-\theta_k),\quad
        \theta_k=\Bigl(\frac{f_k-\mu_k\rho}{g_k}+\rho,\;\frac{\delta_k}{g_k}\Bigr),\quad\rho=\omega^2/\omega_0^2

    :math:`\mu,f,\delta,g` are the factors of a hypothesis on mass, spring, damper and gain: at the tone, a device with
    the nominal mass and gain and with the factors :math:`\theta_k` on spring and damper responds as the hypothesis.
    A hypothesis is consistent while :math:`d_k^2\le\chi^2_2(1-\alpha)=-2\ln\alpha`. The verdict follows the rules of
    the consistency test, with one more: it stays while the healthy device is consistent and another is nearer. So a
    covariance that grows while the drive decays does not end a fault.
    """

    title = "Extended Kalman filter (EKF)"
    every_tick = True
    equations = (
        *EQUATIONS,
        Equation(
            "place", r"\theta_k=\bigl((f_k-\mu_k\rho)/g_k+\rho,\;\delta_k/g_k\bigr),\quad\rho=\omega^2/\omega_0^2"
        ),
        Equation("distance", r"d_k^2=(\hat\theta-\theta_k)^TP_\theta^{-1}(\hat\theta-\theta_k)"),
        Equation("probability", r"P_k\propto e^{-d_k^2/2}"),
        Equation("test", r"d_k^2\le-2\ln\alpha"),
    )
    structure = (
        FILTER,
        Stage("Distances", "stiffness damping covariance", "distance", ("place", "distance")),
        Stage("Weights", "distance", "probability", ("probability",)),
        Stage("Test", "distance", "consistent", ("test",)),
        Stage("Verdict", "consistent", "candidates verdict"),
    )
    weaknesses = (
        "Hypotheses with the same response at the tone have the same place, whatever the reason: 5 % more mass and a "
        "spring softer by 5 % of (omega/omega_0)^2.",
        "After a jump the estimate passes other places on its way: on the seven steps it needs 19 samples, the Kalman "
        "bank 13.",
        "It places a mass by one tone: in the benchmark, whose references have one tone or two, it leaves the true "
        "hypothesis 25 times in a case, the Kalman bank once.",
    )

    class Params(JointFilterParams, ConclusionParams, BankParams):
        """Assumptions of the filter, the test, and the hypotheses."""

        significance: float = parameter(1e-3, "chance that the test calls a true hypothesis false", gt=0, le=0.5)
        tone_hz: float | None = parameter(None, "tone; the reference's unless given", "Hz", gt=0, le=1e6)

    class Packed(Judge.Packed, PackedJointFilter, PackedConclusion):
        """Number of hypotheses, filter, samples before a verdict, limit of the test, places of the hypotheses."""

        limit: float
        stiffness_at: Vector = vector(LANE)
        damping_at: Vector = vector(LANE)

    class State(Joint, Conclusion):
        """The filter, the verdict so far, and the logarithms of the probabilities."""

        likelihood: Vector = vector(LANE)

    class Ports(Judge.Ports, JointPorts):
        """Probabilities and verdict, and the filter behind them."""

        verdict: float = output("1", "0 normal, 1 detected, 2 isolated, 3 ambiguous, 4 unknown fault")
        candidates: float = output("1", "number of consistent hypotheses")
        stiffness: float = output("1", "estimated spring over nominal")
        damping: float = output("1", "estimated damper over nominal")
        residual: Vector = tap(
            "um", "measured minus predicted displacement, of all hypotheses alike", each="hypotheses"
        )
        nis: Vector = tap("1", "its square over its variance, of all hypotheses alike", each="hypotheses")
        consistent: Vector = tap("1", "1 while the estimate does not contradict the hypothesis", each="hypotheses")
        distance: Vector = tap("1", "square of the distance from the estimate, 2 on average", each="hypotheses")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass, damping or spring."""
        return lacking(device) or ("" if device.damping > 0.0 else "needs a device with damping")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Record:
        """Pack filter, test, and the places of the hypotheses at the tone."""
        p = cls.Packed.blank()
        fill_joint(p, params, context)
        p.count = len(params.hypotheses)
        p.limit = -2.0 * log(params.significance)
        turn = 2e-3 * math.pi * window.tone_hz(params, context) / context.device.natural_frequency
        share = turn * turn
        for i, one in enumerate(params.hypotheses):
            p.stiffness_at[i] = (one.stiffness - one.mass * share) / one.gain + share
            p.damping_at[i] = one.damping / one.gain
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> Record:
        """Start with the nominal device, which does not move, and no verdict."""
        s = cls.State.zeros()
        fill_start(s, params, context)
        s.alone = -1.0
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Filter, compare with the places of the hypotheses, conclude."""
        if not follow(p, s, x):
            return
        n = int(p.count)
        candidates = 0
        last = -1
        healthy = False
        best = -math.inf
        for i in range(n):
            square = squared_distance(s, s.stiffness - p.stiffness_at[i], s.damping - p.damping_at[i])
            x.distance[i] = square
            x.residual[i] = s.residual
            x.nis[i] = s.nis
            s.likelihood[i] = -0.5 * square
            best = max(best, s.likelihood[i])
            x.consistent[i] = 1.0 if square <= p.limit else 0.0
            if square <= p.limit:
                candidates += 1
                last = i
                healthy = healthy or i == 0
        take_softmax(s.likelihood, x.probability, n, best)
        verdict = concluded(p, s, candidates, last, healthy)
        if s.likelihood[0] == best or not healthy:
            x.verdict = verdict
        x.candidates = candidates
        x.stiffness = s.stiffness
        x.damping = s.damping


@kernel
def squared_distance(s: Joint, stiffness: float, damping: float) -> float:
    """Return the square of a distance from the estimate, in the metric of its covariance."""
    c = s.covariance
    product = c.kk * c.bb
    determinant = max(product - c.kb * c.kb, LEAST_INDEPENDENT * product)
    cross = 2.0 * c.kb * stiffness * damping
    return (c.bb * stiffness * stiffness - cross + c.kk * damping * damping) / determinant
