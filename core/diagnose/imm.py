"""Interacting multiple models."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from core.block import Context, Equation, Stage, parameter
from core.diagnose.excitation import EVIDENCE, LEAST_INFORMATION, nearest_rival
from core.diagnose.filters import between_updates, filters_step, informed
from core.diagnose.kalman import FILTERS, KalmanBank, KalmanParams
from core.diagnose.lanes import LANE
from core.elementary import exp
from core.kernel import kernel, whole
from core.ports import tap
from core.record import Vector, vector


@kernel
def mix(s: Imm.State, n: int, switching: float) -> None:
    r"""Give every filter the mixture of states it may have come from, and its weight before the measurement.

    With :math:`\pi_{ij}=e+(1-ne)\delta_{ij}` the sums over i are the same for all j except for one term, so mixing
    costs n terms instead of n squared. The spreads are taken about the common mean.
    """
    keep = 1.0 - n * switching
    x1 = 0.0
    x2 = 0.0
    for i in range(n):
        weight = s.weight[i]
        x1 += weight * s.x1[i]
        x2 += weight * s.x2[i]
    m11 = 0.0
    m12 = 0.0
    m22 = 0.0
    for i in range(n):
        weight = s.weight[i]
        d1 = s.x1[i] - x1
        d2 = s.x2[i] - x2
        m11 += weight * (s.p11[i] + d1 * d1)
        m12 += weight * (s.p12[i] + d1 * d2)
        m22 += weight * (s.p22[i] + d2 * d2)
    for i in range(whole(n)):
        stays = keep * s.weight[i]
        before = switching + stays
        stays /= before
        rest = switching / before
        d1 = s.x1[i] - x1
        d2 = s.x2[i] - x2
        k1 = stays * d1
        k2 = stays * d2
        s.x1[i] = x1 + k1
        s.x2[i] = x2 + k2
        s.p11[i] = rest * m11 + stays * (s.p11[i] + d1 * d1) - k1 * k1
        s.p12[i] = rest * m12 + stays * (s.p12[i] + d1 * d2) - k1 * k2
        s.p22[i] = rest * m22 + stays * (s.p22[i] + d2 * d2) - k2 * k2
        s.weight[i] = before


class Imm(KalmanBank):
    r"""Kalman filters that exchange their states, because the device may change from one hypothesis to another.

    .. math:: c_j=\sum_i\pi_{ij}\mu_i,\quad \bar x_j=\frac{1}{c_j}\sum_i\pi_{ij}\mu_ix_i,\quad
        \bar P_j=\frac{1}{c_j}\sum_i\pi_{ij}\mu_i\left[P_i+(x_i-\bar x_j)(x_i-\bar x_j)^T\right],\quad
        \mu_j\propto c_j\,\psi_j^{-1/2}e^{-r_j^2/2\psi_j}

    The text's bank keeps its filters apart. Here a filter that becomes the right one starts from the right state, so
    no pseudo-noise has to make it forget, and the chance of a change takes the place of the floor (Blom and Bar-Shalom
    1988).
    """

    title = "Interacting multiple models (IMM)"
    equations = (
        Equation(
            "mixing",
            r"\bar x_j=\tfrac{1}{c_j}\textstyle\sum_i\pi_{ij}\mu_ix_i,\quad c_j=\sum_i\pi_{ij}\mu_i",
            "Blom and Bar-Shalom 1988",
        ),
        Equation("weights", r"\mu_j\propto c_j\,\psi_j^{-1/2}e^{-r_j^2/2\psi_j}"),
    )
    structure = (
        Stage("Mixing", "weight", "x1 x2", ("mixing",)),
        replace(FILTERS, takes="measured applied x1 x2"),
        Stage("Densities", "nis covariance", "density", ("weights",)),
        Stage("Weights", "density weight", "weight probability", ("weights",)),
        EVIDENCE,
    )

    class Params(KalmanParams):
        """Assumptions of the Kalman filters, and parameters of this bank."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        switching: float = parameter(1e-4, "probability of a change to another hypothesis, per sample", gt=0, le=0.5)

    class Packed(KalmanBank.Packed):
        """Parameters of the filters; probability of a change to one particular other hypothesis."""

        switching: float

    class State(KalmanBank.State):
        """The filters; weights of the hypotheses, densities of a sample, separations."""

        weight: Vector = vector(LANE)
        density: Vector = vector(LANE)
        separation: Vector = vector(LANE)

    class Ports(KalmanBank.Ports):
        """Ports of every bank, and the evidence per sample."""

        information: float = tap("nat", "evidence per sample against the nearest rival of the winner")
        unexcited: float = tap("1", "1 while the drive hardly tells the winner from its nearest rival")

    weighed = "the probabilities before, mixed by switching"

    @classmethod
    def prior(cls, params: Any, before: list[float]) -> list[float]:
        """Return the weights after mixing."""
        switching = params.switching / (len(before) - 1)
        return [switching + (1.0 - len(before) * switching) * weight for weight in before]

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.filters(cls.Packed.blank(), params, context)
        p.switching = params.switching / (len(params.hypotheses) - 1)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """All filters at zero, all hypotheses alike."""
        s = cls.at_rest(cls.State.zeros(), params, context)
        s.weight[:] = 1.0 / len(params.hypotheses)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Mix, predict and correct, weigh."""
        n = int(p.count)
        if between_updates(p, s, x, 0, whole(n)):
            return
        evidence = informed(p, s, x)
        if evidence and s.started != 0.0:
            mix(s, n, p.switching)
        filters_step(p, s, x, n)
        if evidence:
            least = math.inf
            for i in range(n):
                least = min(least, s.nis[i])
            total = 0.0
            for i in range(whole(n)):
                exponent = min(0.5 * (least - s.nis[i]), 0.0)  # positive behind the models alone
                s.density[i] = exp(exponent) / math.sqrt(s.covariance[i])
            for i in range(n):
                share = s.weight[i] * s.density[i]
                s.weight[i] = share
                total += share
            for i in range(n):
                s.weight[i] /= total
        probability = x.probability
        for i in range(n):
            probability[i] = s.weight[i]
        information = nearest_rival(p, s, s.separation, x.probability, n)
        x.information = information
        x.unexcited = 1.0 if information < LEAST_INFORMATION else 0.0
