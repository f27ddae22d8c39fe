"""Interacting multiple models."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, Port, inlined, parameter
from core.diagnose.excitation import LEAST_INFORMATION, nearest_rival
from core.diagnose.filters import (
    COUNT,
    COVARIANCE,
    DEPTH,
    LANES,
    NIS,
    OWN,
    P11,
    P12,
    P22,
    PROBABILITY,
    STARTED,
    WIDTH,
    X1,
    X2,
    coasts,
    filters_step,
    informed,
)
from core.diagnose.kalman import KalmanBank, KalmanParams
from core.diagnose.lanes import LANE

OTHER = 0
"""Parameter of its own."""
WEIGHT, SEPARATION = DEPTH, DEPTH + 1
"""Lanes of its own."""
RESIDUAL_TAP, NIS_TAP, INFORMATION, UNEXCITED = range(PROBABILITY + 1, PROBABILITY + 5)


@inlined
def mix(s: Any, n: int, other: float) -> None:
    r"""Give every filter the mixture of states it may have come from, and its weight before the measurement.

    With :math:`\pi_{ij}=e+(1-ne)\delta_{ij}` the sums over i are the same for all j but for one term, so mixing costs
    n terms and not n squared. Spreads are taken about the common mean.
    """
    keep = 1.0 - n * other
    x1 = 0.0
    x2 = 0.0
    for i in range(n):
        b = OWN + i
        weight = s[b + WEIGHT * LANE]
        x1 += weight * s[b + X1 * LANE]
        x2 += weight * s[b + X2 * LANE]
    m11 = 0.0
    m12 = 0.0
    m22 = 0.0
    for i in range(n):
        b = OWN + i
        weight = s[b + WEIGHT * LANE]
        d1 = s[b + X1 * LANE] - x1
        d2 = s[b + X2 * LANE] - x2
        m11 += weight * (s[b + P11 * LANE] + d1 * d1)
        m12 += weight * (s[b + P12 * LANE] + d1 * d2)
        m22 += weight * (s[b + P22 * LANE] + d2 * d2)
    for i in range(n):
        b = OWN + i
        own = keep * s[b + WEIGHT * LANE]
        before = other + own
        own /= before
        rest = other / before
        d1 = s[b + X1 * LANE] - x1
        d2 = s[b + X2 * LANE] - x2
        k1 = own * d1
        k2 = own * d2
        s[b + X1 * LANE] = x1 + k1
        s[b + X2 * LANE] = x2 + k2
        s[b + P11 * LANE] = rest * m11 + own * (s[b + P11 * LANE] + d1 * d1) - k1 * k1
        s[b + P12 * LANE] = rest * m12 + own * (s[b + P12 * LANE] + d1 * d2) - k1 * k2
        s[b + P22 * LANE] = rest * m22 + own * (s[b + P22 * LANE] + d2 * d2) - k2 * k2
        s[b + WEIGHT * LANE] = before


def imm_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Mix, predict and correct, weigh."""
    n = int(p[COUNT])
    if coasts(p, s, w, io, LANE, 0, n):
        return
    evidence = informed(p, s, w, io)
    if evidence and s[STARTED] != 0.0:
        mix(s, n, p[LANES + WIDTH * LANE + OTHER])
    filters_step(p, s, w, io, n, RESIDUAL_TAP)
    if evidence:
        least = math.inf
        for i in range(n):
            least = min(least, s[OWN + NIS * LANE + i])
        total = 0.0
        for i in range(n):
            density = math.exp(0.5 * (least - s[OWN + NIS * LANE + i])) / math.sqrt(s[OWN + COVARIANCE * LANE + i])
            share = s[OWN + WEIGHT * LANE + i] * density
            s[OWN + WEIGHT * LANE + i] = share
            total += share
        for i in range(n):
            s[OWN + WEIGHT * LANE + i] /= total
    at = io[PROBABILITY]
    for i in range(n):
        w[at + i] = s[OWN + WEIGHT * LANE + i]
    information = nearest_rival(p, s, OWN + SEPARATION * LANE, n, w, at)
    w[io[INFORMATION]] = information
    w[io[UNEXCITED]] = 1.0 if information < LEAST_INFORMATION else 0.0


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
    taps = (
        *KalmanBank.taps,
        Port("information", "nat", "evidence per sample against the nearest rival of the winner"),
        Port("unexcited", "1", "1 while the drive hardly tells the winner from its nearest rival"),
    )
    equations = (
        Equation(
            "mixing",
            r"\bar x_j=\tfrac{1}{c_j}\textstyle\sum_i\pi_{ij}\mu_ix_i,\quad c_j=\sum_i\pi_{ij}\mu_i",
            "Blom and Bar-Shalom 1988",
        ),
        Equation("weights", r"\mu_j\propto c_j\,\psi_j^{-1/2}e^{-r_j^2/2\psi_j}"),
    )

    class Params(KalmanParams):
        """Assumptions of the bank."""

        process_noise_v: float = parameter(
            0.01, "assumed noise on the voltage, rms per sample", "V", equation="5.2.3.1.2", ge=0, le=100
        )
        switching: float = parameter(1e-4, "probability of a change to another hypothesis, per sample", gt=0, le=0.5)

    @classmethod
    def prior(cls, params: Any, before: list[float]) -> list[float]:
        """Return the weights after mixing."""
        other = params.switching / (len(before) - 1)
        return [other + (1.0 - len(before) * other) * weight for weight in before]

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        other = params.switching / (len(params.hypotheses) - 1)
        return np.array([*cls.filters(params, context), other])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """All filters at rest, all hypotheses alike."""
        return np.array(cls.at_rest(params, context, (1.0 / len(params.hypotheses), 0.0)))

    step = imm_step
