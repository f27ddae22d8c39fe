"""Least squares with continuous forgetting."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.estimation import diagonal, least_squares, project, trace
from core.identify.filtered import (
    OWN_P,
    OWN_S,
    OWN_TAP,
    PHI,
    RANGE,
    TAPS,
    THETA,
    Filtered,
    FilteredParams,
    bounds,
    gathers,
    observe,
    report,
)
from core.identify.identifier import ENABLED, H

DECAY, NORMALISER, LIMIT, INITIAL = range(OWN_P, OWN_P + 4)
COVARIANCE, PRODUCT, WAS_ENABLED = OWN_S, OWN_S + 6, OWN_S + 9
TRACE = OWN_TAP


def least_squares_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Filter, compare, update estimate and covariance."""
    if gathers(p, s, w, io):
        return
    seen, e = observe(p, s, w, io)
    if p[ENABLED] != 0.0:
        if s[WAS_ENABLED] == 0.0:
            for i in range(6):
                s[COVARIANCE + i] = p[INITIAL] if i == 0 or i == 2 or i == 5 else 0.0
        if seen:
            square = s[PHI] * s[PHI] + s[PHI + 1] * s[PHI + 1] + s[PHI + 2] * s[PHI + 2]
            noise = (1.0 + p[NORMALISER] * square) * p[DECAY] / p[H]
            least_squares(s, THETA, COVARIANCE, PHI, PRODUCT, 3, e, noise, p[DECAY], p[LIMIT])
            if p[RANGE] > 0.0:
                for i in range(3):
                    low, high = bounds(p, i)
                    project(s, THETA, COVARIANCE, 3, i, low, high)
    s[WAS_ENABLED] = p[ENABLED]
    report(p, s, w, io, e)
    w[io[TRACE]] = trace(s, COVARIANCE, 3)


class LeastSquares(Filtered):
    r"""Least squares with continuous forgetting, sampled exactly (3.3.2.8-11).

    .. math:: \dot{\hat\theta}=\frac{P\varphi e}{m^2},\quad
        \dot P=BP-\frac{P\varphi\varphi^TP}{m^2},\quad m^2=1+\alpha\varphi^T\varphi

    .. math:: P^{-1}\leftarrow e^{-Bh}P^{-1}+\frac{h}{m^2}\varphi\varphi^T,\quad
        P_i^{-1}\tilde\theta_i=e^{-Bhi}P_0^{-1}\tilde\theta_0

    So the weight of the start is forgotten at the rate B whatever alpha. A greater rate is quicker while the initial
    covariance is small; once it is large the data alone decide and the rate makes no difference.
    """

    title = "Least squares, continuous forgetting"
    taps: ClassVar[tuple[Port, ...]] = (*TAPS, Port("covariance_trace", "mixed", "trace of the covariance"))
    equations = (
        Equation(
            "model",
            r"z=\theta^T\varphi,\quad\theta=[k_p,a_{p1},a_{p0}]^T",
            "3.3.2.6-7",
            printed=r"\theta=[K_m,ap_1,ap_2]",
            why="the first is the gain of the plant, the last its a_p0",
        ),
        Equation("estimate", r"\dot{\hat\theta}=Pe\varphi,\quad e=\frac{z-\theta^T\varphi}{m_s^2}", "3.3.2.8-9"),
        Equation(
            "covariance",
            r"\dot P=BP-P\frac{\varphi\varphi^T}{m_s^2}P,\quad m_s^2=1+\alpha\varphi^T\varphi",
            "3.3.2.10-11",
        ),
        Equation(
            "sample",
            r"K=\frac{P\varphi}{m^2\mu/h+\varphi^TP\varphi},\;\hat\theta\leftarrow\hat\theta+K(z-\hat\theta^T\varphi),\;"
            r"P\leftarrow\frac{P-K\varphi^TP}{\mu},\quad\mu=e^{-Bh}",
        ),
    )

    class Params(FilteredParams):
        """Forgetting, trust and bounds, in um, V and 1/w0."""

        forgetting_rate: float = parameter(30.0, "rate B of forgetting", "1/s", equation="3.3.2.10", ge=0, le=1e6)
        normaliser: float = parameter(10.0, "alpha of the normaliser", equation="3.3.2.11", ge=0, le=1e6)
        initial_covariance: float = parameter(1e3, "P0, as a multiple of I", equation="3.3.2.10", gt=0, le=1e12)
        covariance_limit: float = parameter(1e5, "largest trace of the covariance, 0 for none", ge=0, le=1e15)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        decay = math.exp(-params.forgetting_rate * 1e-3 * context.dt_ms)
        own = [decay, params.normaliser, params.covariance_limit, params.initial_covariance]
        return np.array(cls.filters(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Start with filters at rest, the estimate and its covariance, scratch, and whether it was enabled."""
        own = [*diagonal(3, params.initial_covariance), 0.0, 0.0, 0.0, 1.0]
        return np.concatenate([cls.begin(params, context), own])

    step = least_squares_step
