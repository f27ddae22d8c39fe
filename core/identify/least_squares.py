"""Least squares with continuous forgetting."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, Stage, parameter
from core.elementary import exp
from core.estimation import diagonal, estimate, project_onto, trace_of, triangle
from core.identify.filtered import (
    FilteredEstimator,
    FilteredParams,
    N,
    bounds,
    follow_voltage,
    observe,
    prediction,
    report,
)
from core.identify.identifier import DEVICE, JUDGED, between_updates
from core.ports import tap
from core.record import Vector, vector


class LeastSquares(FilteredEstimator):
    r"""Least squares with continuous forgetting, sampled exactly (3.3.2.8-11).

    .. math:: \dot{\hat\theta}=\frac{P\varphi e}{m^2},\quad
        \dot P=BP-\frac{P\varphi\varphi^TP}{m^2},\quad m^2=1+\alpha\varphi^T\varphi

    .. math:: P^{-1}\leftarrow e^{-Bh}P^{-1}+\frac{h}{m^2}\varphi\varphi^T,\quad
        P_i^{-1}\tilde\theta_i=e^{-Bhi}P_0^{-1}\tilde\theta_0

    So the weight of the start is forgotten at the rate B, independent of alpha. A greater rate is quicker while the
    initial covariance is small; if it is large the data alone decide and the rate makes no difference.
    """

    title = "Least squares, continuous forgetting"
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
    structure = (
        Stage("Filters", "applied measured", "phi", ("model",)),
        Stage("Residual", "coefficient phi measured", "residual", ("estimate",)),
        Stage("Covariance", "phi", "covariance covariance_trace", ("covariance", "sample")),
        Stage("Estimator", "residual phi covariance", "coefficient", ("estimate", "sample")),
        DEVICE,
        JUDGED,
    )

    class Params(FilteredParams):
        """Forgetting, trust and bounds, in um, V and 1/w0."""

        forgetting_rate: float = parameter(30.0, "rate B of forgetting", "1/s", equation="3.3.2.10", ge=0, le=1e6)
        normaliser: float = parameter(10.0, "alpha of the normaliser", equation="3.3.2.11", ge=0, le=1e6)
        initial_covariance: float = parameter(1e3, "P0, as a multiple of I", equation="3.3.2.10", gt=0, le=1e12)
        covariance_limit: float = parameter(1e5, "largest trace of the covariance, 0 for 1e10", ge=0, le=1e15)

    class Packed(FilteredEstimator.Packed):
        """Share kept from sample to sample, normaliser, limit of the covariance and its value at the start."""

        decay: float
        normaliser: float
        covariance_limit: float
        initial_covariance: float

    class State(FilteredEstimator.State):
        """Covariance, scratch, whether it was enabled."""

        covariance: Vector = vector(triangle(N))
        product: Vector = vector(N)
        was_enabled: float

    class Ports(FilteredEstimator.Ports):
        """The trace of the covariance."""

        covariance_trace: float = tap("mixed", "trace of the covariance")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        cls.fill_nominal(p, params, context)
        p.decay = exp(-params.forgetting_rate * 1e-3 * context.dt_ms)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Start with filters at zero, the estimate and its covariance, scratch, and whether it was enabled."""
        s = cls.State.zeros()
        cls.fill_start(s, params, context)
        s.covariance[:] = diagonal(N, params.initial_covariance)
        s.was_enabled = 1.0
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Filter, compare, update estimate and covariance."""
        follow_voltage(p, s, x)
        if between_updates(p, x):
            return
        seen, z = observe(p, s, x)
        e = z - prediction(s)
        if p.enabled != 0.0:
            if s.was_enabled == 0.0:
                for i in range(6):
                    s.covariance[i] = p.initial_covariance if i == 0 or i == 2 or i == 5 else 0.0
            if seen:
                square = s.phi[0] * s.phi[0] + s.phi[1] * s.phi[1] + s.phi[2] * s.phi[2]
                noise = (1.0 + p.normaliser * square) * p.decay / p.h
                estimate(s.theta, s.covariance, s.phi, s.product, N, e, noise, p.decay, p.covariance_limit)
                if p.range_ratio > 0.0:
                    for i in range(N):
                        low, high = bounds(p, i)
                        project_onto(s.theta, s.covariance, N, i, low, high)
        s.was_enabled = p.enabled
        report(p, s, x, e)
        x.covariance_trace = trace_of(s.covariance, N)
