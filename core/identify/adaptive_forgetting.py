"""Recursive least squares whose forgetting factor follows the innovations."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np

from core.block import Context, Equation, FloatArray, Port, kernel, parameter
from core.estimation import least_squares
from core.identify.discrete import (
    COVARIANCE,
    LIMIT,
    OWN_P,
    OWN_S,
    OWN_TAP,
    PHI,
    PRODUCT,
    TAPS,
    THETA,
    Discrete,
    DiscreteParams,
    N,
    gathers,
    nominal,
    observe,
    report,
)

READING, VARIANCE, MEMORY, GATE, LEAST, STEP = range(OWN_P, OWN_P + 6)
DIRECT, STEPWISE, PRINTED = 0.0, 1.0, 2.0
LAMBDA, RATIO, WEIGHT, OWN_SIZE = OWN_S, OWN_S + 1, OWN_S + 2, OWN_S + 3
FORGETTING, INNOVATION = OWN_TAP, OWN_TAP + 1
HUGE = 1e30
"""What a ratio that grows without end is kept below."""


@kernel
def spread(s: Any) -> float:
    """Return h' eta h."""
    total = 0.0
    for i in range(N):
        for j in range(N):
            low, high = min(i, j), max(i, j)
            total += s[PHI + i] * s[COVARIANCE + high * (high + 1) // 2 + low] * s[PHI + j]
    return total


@kernel
def follow(p: Any, s: Any, e: float) -> None:
    r"""Choose the forgetting factor of this sample.

    Innovations that are more than :math:`1+h^T\eta h/\lambda` times the variance of the noise mean that the estimate is
    trusted too much; the factor that would explain them is :math:`\tilde\lambda=h^T\eta h/(R-1)`.
    """
    square = e * e
    before = s[LAMBDA]
    memory = p[MEMORY] if p[READING] == DIRECT else before
    if p[READING] == PRINTED:
        weight = 1.0 + before * s[WEIGHT]
        s[RATIO] = min((before * s[RATIO] + square) / (weight * p[VARIANCE]), HUGE)
    else:
        weight = 1.0 + memory * s[WEIGHT]
        s[RATIO] = (memory * s[WEIGHT] * s[RATIO] + square / p[VARIANCE]) / weight
    s[WEIGHT] = weight
    information = spread(s)
    if p[READING] == DIRECT:
        s[LAMBDA] = 1.0
        if s[RATIO] > p[GATE]:
            s[LAMBDA] = min(max(information / (s[RATIO] - 1.0), p[LEAST]), 1.0)
        return
    wanted = (before + information) / max(s[RATIO], 1.0 / HUGE)
    moved = before + (p[STEP] if wanted > before else -p[STEP] if wanted < before else 0.0)
    s[LAMBDA] = max(moved, p[LEAST]) if p[READING] == PRINTED else min(max(moved, p[LEAST]), 1.0)


def adaptive_forgetting_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, compare, choose how much to forget, update estimate and covariance."""
    if gathers(p, s, w, io):
        return
    use, e = observe(p, s, w, io)
    if use:
        follow(p, s, e)
        least_squares(s, THETA, COVARIANCE, PHI, PRODUCT, N, e, s[LAMBDA], s[LAMBDA], p[LIMIT])
    report(p, s, w, io, e)
    w[io[FORGETTING]] = s[LAMBDA]
    w[io[INNOVATION]] = s[RATIO]


class AdaptiveForgetting(Discrete):
    r"""Recursive least squares that forgets when its innovations say so (5.4.1).

    .. math:: R_i=\frac{\rho\gamma_{i-1}R_{i-1}+w_i^2/\sigma^2}{\gamma_i},\;\gamma_i=1+\rho\gamma_{i-1},\quad
        \lambda_i=\mathrm{clip}\Big(\frac{h^T\eta h}{R_i-1},\lambda_{min},1\Big)
        \text{ while }R_i>R_{gate},\text{ else }1

    with :math:`w_i` the innovation and :math:`\sigma^2` the variance it would have with a perfect estimate. As printed
    the scheme does not look at the data at all: its ratio goes to infinity where the noise is small in its units, or to
    zero where it is large, and the factor just walks down or up by mu per sample.
    """

    title = "Least squares, adaptive forgetting"
    taps: ClassVar[tuple[Port, ...]] = (
        *TAPS,
        Port("forgetting", "1", "forgetting factor of this sample"),
        Port("innovation_ratio", "1", "mean squared innovation over what noise alone would give, R"),
    )
    equations = (
        Equation(
            "innovation",
            r"R_i=\frac{\rho\gamma_{i-1}R_{i-1}+w_i^2/\sigma^2}{\gamma_i}",
            "5.4.1.3-5",
            printed=r"\hat R_i=\frac{1}{\sigma_\omega^2}\frac{\lambda_{i-1}\hat R_{i-1}+w_kw_k^*}{\gamma_i}",
            why="without gamma inside and with sigma outside the recursion it forgets the data or explodes; w is the "
            "innovation, not the noise",
        ),
        Equation(
            "forgetting factor",
            r"\tilde\lambda_i=\frac{h^T\eta h}{R_i-1}",
            "5.4.6",
            printed=r"\lambda_i=\frac{\lambda_{i-1}(1+H_iP'_{i-1}H_i^T)}{\hat R_i}",
            why="that one is right at rest, since then R = 1 + h'eta h / lambda, but slow on the way",
        ),
        Equation(
            "limit",
            r"\lambda_i=\mathrm{clip}(\lambda_{i-1}+\mu\,\mathrm{sgn}(\tilde\lambda_i-\lambda_{i-1}),\lambda_{min},1)",
            "5.4.7",
            printed=r"\lambda_i=\lambda_{i-1}+\mu\,\mathrm{sgn}(\lambda_i-\lambda_{i-1})",
            why="a sign bounds the step and not the factor, and one symbol cannot stand on both sides",
        ),
    )

    class Params(DiscreteParams):
        """Reading, variance and limits, in um and V."""

        reading: Literal["direct", "step", "printed"] = parameter(
            "direct", "set the factor at once, step towards it (corrected), or as printed", equation="5.4.7"
        )
        innovation_um: float | None = parameter(
            None,
            "standard deviation of the innovation of a perfect estimate; from the sensor's noise unless given",
            "um",
            equation="5.4.1.1",
            gt=0,
            le=100,
        )
        memory_samples: float = parameter(3.0, "samples the ratio R looks back", "samples", ge=1, le=1e6)
        gate: float = parameter(5.0, "ratio R above which it forgets", equation="5.4.6", ge=1, le=1e6)
        least_forgetting: float = parameter(0.2, "smallest forgetting factor", "1", gt=0.01, le=1)
        step_size: float = parameter(1e-4, "step mu of the other readings", equation="5.4.7", gt=0, le=1)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        deviation = params.innovation_um
        if deviation is None:
            # the noise of three samples meets in one residual
            *_, a1, a2 = nominal(context.device, context.dt_ms)
            deviation = max(context.sensor_noise_um, 1e-3) * (1.0 + a1 * a1 + a2 * a2) ** 0.5
        own = [
            {"direct": DIRECT, "step": STEPWISE, "printed": PRINTED}[params.reading],
            deviation**2,
            1.0 - 1.0 / params.memory_samples,
            params.gate,
            params.least_forgetting,
            params.step_size,
        ]
        return np.array(cls.sampled(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Estimate and covariance at the start, factor 1, nothing seen."""
        return np.concatenate([cls.begin(params, context), [1.0, 0.0, 0.0]])

    step = adaptive_forgetting_step
