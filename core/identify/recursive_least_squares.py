"""Recursive least squares with a forgetting factor."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, parameter
from core.estimation import least_squares, trace
from core.identify.discrete import (
    COVARIANCE,
    LIMIT,
    OWN_P,
    PHI,
    PRODUCT,
    THETA,
    Discrete,
    DiscreteParams,
    N,
    gathers,
    observe,
    report,
    restart,
)

FORGETTING, DEAD_ZONE, RESET_BELOW = range(OWN_P, OWN_P + 3)


def recursive_least_squares_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, compare, update estimate and covariance."""
    if gathers(p, s, w, io):
        return
    use, e = observe(p, s, w, io)
    if use and abs(e) >= p[DEAD_ZONE]:
        least_squares(s, THETA, COVARIANCE, PHI, PRODUCT, N, e, p[FORGETTING], p[FORGETTING], p[LIMIT])
        if p[RESET_BELOW] > 0.0 and trace(s, COVARIANCE, N) < p[RESET_BELOW]:
            restart(p, s)
    report(p, s, w, io, e)


class RecursiveLeastSquares(Discrete):
    r"""Recursive least squares with a forgetting factor, FFRLS (5.3.3.6-9).

    .. math:: K=\frac{\eta h}{\lambda+h^T\eta h},\quad\hat\theta\leftarrow\hat\theta+K(z-h^T\hat\theta),\quad
        \eta\leftarrow\frac{\eta-Kh^T\eta}{\lambda},\quad h=[u_{i-1},u_{i-2},-z_{i-1},-z_{i-2}]

    It minimises :math:`\sum\lambda^{n-i}(z_i-h_i^T\theta)^2`: a memory of about :math:`1/(1-\lambda)` samples. Of the
    covariance only a triangle is kept, since the antisymmetric part of its rounding would grow as
    :math:`\lambda^{-i}`; and its trace is limited, since without excitation it grows so itself. Noise of the sensor
    stands in the regressor and biases the estimate, the more so the faster it samples: run it at 10 to 20 kHz.
    """

    title = "Recursive least squares (FFRLS)"
    equations = (
        Equation("model", r"z_{i+1}=h_i^T\theta,\quad\theta=[b_0,b_1,a_1,a_2]^T", "5.3.3.1-4"),
        Equation(
            "estimate", r"\hat\theta\leftarrow\hat\theta+\frac{\eta h}{\lambda+h^T\eta h}(z-h^T\hat\theta)", "5.3.3.8"
        ),
        Equation(
            "covariance",
            r"\eta\leftarrow\frac1\lambda\left(\eta-\frac{\eta hh^T\eta}{\lambda+h^T\eta h}\right)",
            "5.3.3.9",
        ),
        Equation(
            "memory",
            r"n=\frac1{1-\lambda}",
            "5.3.4",
            printed=r"\text{a higher forgetting factor: a short history}",
            why="backwards: 7, 10 and 50 samples at 0.86, 0.9 and 0.98",
        ),
    )

    class Params(DiscreteParams):
        """Forgetting, trust and safeguards, in um and V."""

        forgetting: float = parameter(0.98, "forgetting factor", "1", equation="5.3.3.8", gt=0, le=1)
        dead_zone_um: float = parameter(0.0, "residual below which nothing is learnt", "um", ge=0, le=100)
        reset_below: float = parameter(0.0, "trace below which the covariance starts anew, 0 for never", ge=0, le=1e15)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        own = [params.forgetting, params.dead_zone_um, params.reset_below]
        return np.array(cls.sampled(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Estimate and covariance at the start."""
        return cls.begin(params, context)

    step = recursive_least_squares_step
