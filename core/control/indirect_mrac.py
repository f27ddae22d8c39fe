"""Indirect model reference adaptive control: least squares with forgetting, then the gains that match."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.control.adaptation import REGRESSORS
from core.control.controller import (
    ControllerPorts,
    Lag,
    NormalisedPacked,
    TruthPorts,
    advance_lag,
    coefficients,
    fill_normalised,
    lag,
    matching,
    true_plant,
    unsuited_second_order,
)
from core.elementary import exp
from core.estimation import (
    DrivenFilter,
    diagonal,
    driven_filter_of,
    estimate,
    filter_input,
    filter_voltage,
    filtered_second_derivative,
    project_onto,
    trace_of,
    triangle,
)
from core.kernel import flush_tiny
from core.ports import tap
from core.record import Choice, Record, Vector, vector
from core.voltage import Motion, moves

PARAMETERS = ("gain", "a1", "a2")
N = len(PARAMETERS)


class IndirectMrac(Block):
    r"""Indirect MRAC: parameters by least squares with forgetting (3.3.2.8-11), gains from them (3.3.2.16).

    .. math:: z=\frac{s^2}{(s+\lambda)^2}y=\theta^T\phi,\quad
        \phi=\frac{1}{(s+\lambda)^2}[u,-sy,-y],\quad \theta=[k_p,a_{p1},a_{p0}]

    .. math:: u=Kr+\frac{\alpha_1}{s+\lambda}u+\frac{B_1s+B_0}{s+\lambda}y

    It identifies all the time from the voltage applied. The gains are only as good as the parameters: under one tone
    some combination of them is not identifiable.
    """

    title = "Indirect MRAC"
    place = 8
    equations = (
        Equation("parametric form", r"z=\frac{s^2}{(s+\lambda)^2}y=\theta^T\phi", "3.3.2.5-7"),
        Equation(
            "least squares with forgetting",
            r"K=\frac{P\phi}{m^2\mu/h+\phi^TP\phi},\;\theta\leftarrow\theta+K(z-\theta^T\phi),\;"
            r"P\leftarrow\frac{P-K\phi^TP}{\mu},\;\mu=e^{-Bh},\;m^2=1+\alpha\phi^T\phi",
            "3.3.2.8-11",
        ),
        Equation(
            "law",
            r"u=Kr+\alpha_1w_1+B_1y+(B_0-\lambda B_1)w_2,\quad \dot w_1=-\lambda w_1+u,\;\dot w_2=-\lambda w_2+y",
            "3.3.2.12",
        ),
        Equation(
            "gains",
            r"K=\frac{K_m}{K_p},\;\alpha_1=a_{p1}-a_{m1},\;B_1=\tfrac{1}{K_p}\left(a_{p0}+(\lambda-\alpha_1)a_{p1}"
            r"-\lambda a_{m1}-a_{m0}\right),\;B_0=\tfrac{1}{K_p}\left(a_{p0}(\lambda-\alpha_1)-\lambda a_{m0}\right)",
            "3.3.2.16",
            printed=r"K=\frac{K_p}{K_m}",
            why="equating the transfer functions gives K_m/K_p; the printed ratio multiplies the static displacement "
            "by (K_p/K_m)^2",
        ),
    )
    structure = (
        Stage("Filters of the regressor", "applied measured", "regressor", ("parametric form",)),
        Stage("Least squares", "regressor measured", "parameter prediction_error", ("least squares with forgetting",)),
        Stage("Gain design", "parameter", "gain", ("gains",)),
        Stage("State filters", "applied measured", "w1 w2", ("law",)),
        Stage("Law", "gain reference w1 w2 measured", "voltage", ("law",)),
    )

    class Params(BlockParams):
        """Identification and gains, in um, V and 1/w0."""

        forgetting_rate: float = parameter(30.0, "rate B of forgetting", "1/s", equation="3.3.2.10", ge=0, le=1e5)
        normaliser: float = parameter(10.0, "weight alpha of the normaliser", equation="3.3.2.11", ge=0, le=1e4)
        covariance: float = parameter(1e3, "covariance at the start", equation="3.3.2.10", gt=0, le=1e6, live=False)
        trace_limit: float = parameter(1e5, "largest trace of the covariance, 0 for 1e10", ge=0)
        filter_pole: float = parameter(
            1.0, "pole of all filters over w0", equation="3.3.2.5", gt=0.05, le=10, live=False
        )
        gain_floor: float = parameter(0.1, "least share of the nominal gain the estimate may fall to", gt=0, le=1)
        gain_map: Literal["working", "printed"] = parameter(
            "working", "gain on the reference: K_m/K_p, or as printed K_p/K_m", equation="3.3.2.16"
        )

    class Packed(NormalisedPacked):
        """Filters and their pole, forgetting and noise of a sample, limits of the estimate, whether K is as printed."""

        filter: DrivenFilter
        lag: Lag
        filter_pole: float
        forgetting: float
        noise: float
        normaliser: float
        trace_limit: float
        low: float
        high: float
        printed: Choice

    class State(Record):
        """Estimate, covariance, the regressor, scratch numbers, filters, the last measurement, whether it has run."""

        theta: Vector = vector(N)
        covariance: Vector = vector(triangle(N))
        regressor: Vector = vector(N)
        product: Vector = vector(N)
        input: Motion
        output: Motion
        w1: float
        w2: float
        last: float
        started: float

    class Ports(ControllerPorts, TruthPorts):
        """Ports of a controller, the truth, and the identification."""

        parameter: Vector = tap("mixed", "estimates of kp, a1 and a2, time in 1/w0", labels=PARAMETERS)
        parameter_true: Vector = tap("mixed", "what they should be", labels=PARAMETERS)
        gain: Vector = tap("mixed", "gains on r, w1, w2 and y computed from the estimates", labels=REGRESSORS)
        gain_ideal: Vector = tap("mixed", "gains that would match the model exactly", labels=REGRESSORS)
        error: float = tap("um", "measured minus model displacement")
        prediction_error: float = tap("um", "error of the estimate, in um w0^2")
        trace: float = tap("mixed", "trace of the covariance")
        excitation: float = tap("1", "new information in the regressor of this sample")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants and models that are not of second order."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        fill_normalised(p, context)
        p.forgetting = exp(-1e-3 * params.forgetting_rate * context.dt_ms)
        p.noise = p.forgetting / p.h
        floor = params.gain_floor * p.plant.gain
        p.low, p.high = (floor, math.inf) if p.plant.gain > 0.0 else (-math.inf, floor)
        p.filter = driven_filter_of(params.filter_pole, p.h, context.analogue)
        p.lag = lag(params.filter_pole, p.h, context.analogue)
        p.printed = params.gain_map == "printed"
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Parameters of the nominal device, the covariance, everything else zero."""
        a1, a2, gain = coefficients(context)[0]
        s = cls.State.zeros()
        s.theta[:] = gain, a1, a2
        s.covariance[:] = diagonal(N, params.covariance)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Identify from the voltage applied, compute the gains, then the voltage."""
        y = x.measured
        u, middle, end = moves(x)
        last = s.last if s.started != 0.0 else y
        filter_voltage(p.filter, s.input, u, middle, end)
        filter_input(p.filter, s.output, last, y)
        s.w1 = advance_lag(p.lag, s.w1, u, middle, end)
        s.w2 = advance_lag(p.lag, s.w2, last, 0.0, 0.0)
        s.last = y
        s.started = 1.0

        s.regressor[0], s.regressor[1], s.regressor[2] = s.input.x, -s.output.v, -s.output.x
        error = filtered_second_derivative(p.filter, s.output, y)
        size = 1.0
        for i in range(N):
            error -= s.theta[i] * s.regressor[i]
            size += p.normaliser * s.regressor[i] * s.regressor[i]
        error = flush_tiny(error)
        noise = size * p.noise
        information = estimate(
            s.theta, s.covariance, s.regressor, s.product, N, error, noise, p.forgetting, p.trace_limit
        )
        project_onto(s.theta, s.covariance, N, 0, p.low, p.high)
        gain, a1, a2 = s.theta[0], s.theta[1], s.theta[2]
        on_r, on_w1, on_w2, on_y = matching(a1, a2, gain, p.model, p.filter_pole)
        if p.printed != 0.0:
            on_r = gain / p.model.gain
        x.voltage = on_r * x.reference + on_w1 * s.w1 + on_w2 * s.w2 + on_y * y

        x.parameter[0], x.parameter[1], x.parameter[2] = gain, a1, a2
        x.gain[0], x.gain[1], x.gain[2], x.gain[3] = on_r, on_w1, on_w2, on_y
        a1, a2, gain = true_plant(x, p.plant)
        x.parameter_true[0], x.parameter_true[1], x.parameter_true[2] = gain, a1, a2
        ideal = x.gain_ideal
        ideal[0], ideal[1], ideal[2], ideal[3] = matching(a1, a2, gain, p.model, p.filter_pole)
        x.error = y - x.model
        x.prediction_error = error
        x.trace = trace_of(s.covariance, N)
        x.excitation = information / noise
