"""Indirect model reference adaptive control: least squares with forgetting, then the gains that match."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.control.controller import (
    APPLIED,
    INPUTS,
    LAG_SIZE,
    MEASURED,
    MODEL,
    OUTPUT,
    REFERENCE,
    TRUTH,
    advance_lag,
    coefficients,
    lag,
    matching,
    true_plant,
    unsuited_second_order,
)
from core.estimation import (
    DRIVEN_SIZE,
    advance_filter,
    diagonal,
    drive_filter,
    driven_filter,
    least_squares,
    project,
    second_derivative,
    trace,
    triangle,
)
from core.voltage import moved

N = 3
FORGETTING, NOISE, NORMALISER, TRACE_LIMIT, LOW, HIGH, POLE, LAG = range(DRIVEN_SIZE, DRIVEN_SIZE + 8)
PRINTED, MODEL_A1, MODEL_A2, MODEL_GAIN, PLANT_A1, PLANT_A2, PLANT_GAIN = range(LAG + LAG_SIZE, LAG + LAG_SIZE + 7)
THETA, COVARIANCE, PHI = 0, N, N + triangle(N)
PRODUCT, INPUT_FILTER, OUTPUT_FILTER, W1, W2, LAST, STARTED, SIZE = (PHI + N + n for n in (0, 3, 5, 7, 8, 9, 10, 11))
FIRST_TRUTH = len(INPUTS)
OWN_VOLTAGE = FIRST_TRUTH + len(TRUTH)
TAPS = OWN_VOLTAGE + 1
PARAMETERS = ("gain", "a1", "a2")
GAINS = ("r", "w1", "w2", "y")


def indirect_mrac_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Identify from what was applied, compute the gains, then the voltage."""
    y = w[io[MEASURED]]
    r = w[io[REFERENCE]]
    u, middle, end = moved(w, io, APPLIED)
    last = s[LAST] if s[STARTED] != 0.0 else y
    drive_filter(p, 0, s, INPUT_FILTER, u, middle, end)
    advance_filter(p, 0, s, OUTPUT_FILTER, last, y)
    advance_lag(p, LAG, s, W1, u, middle, end)
    advance_lag(p, LAG, s, W2, last, 0.0, 0.0)
    s[LAST] = y
    s[STARTED] = 1.0

    s[PHI], s[PHI + 1], s[PHI + 2] = s[INPUT_FILTER], -s[OUTPUT_FILTER + 1], -s[OUTPUT_FILTER]
    error = second_derivative(p, 0, s, OUTPUT_FILTER, y)
    size = 1.0
    for i in range(N):
        error -= s[THETA + i] * s[PHI + i]
        size += p[NORMALISER] * s[PHI + i] * s[PHI + i]
    error = settled(error)
    information = least_squares(
        s, THETA, COVARIANCE, PHI, PRODUCT, N, error, size * p[NOISE], p[FORGETTING], p[TRACE_LIMIT]
    )
    project(s, THETA, COVARIANCE, N, 0, p[LOW], p[HIGH])
    gain, a1, a2 = s[THETA], s[THETA + 1], s[THETA + 2]
    on_r, on_w1, on_w2, on_y = matching(a1, a2, gain, p[MODEL_A1], p[MODEL_A2], p[MODEL_GAIN], p[POLE])
    if p[PRINTED] != 0.0:
        on_r = gain / p[MODEL_GAIN]
    w[io[OWN_VOLTAGE]] = on_r * r + on_w1 * s[W1] + on_w2 * s[W2] + on_y * y

    a1, a2, gain = true_plant(w, io, FIRST_TRUTH, p[PLANT_A1], p[PLANT_A2], p[PLANT_GAIN])
    estimate, truth, own, ideal = io[TAPS], io[TAPS + 1], io[TAPS + 2], io[TAPS + 3]
    for i in range(N):
        w[estimate + i] = s[THETA + i]
    w[truth], w[truth + 1], w[truth + 2] = gain, a1, a2
    w[own], w[own + 1], w[own + 2], w[own + 3] = on_r, on_w1, on_w2, on_y
    w[ideal], w[ideal + 1], w[ideal + 2], w[ideal + 3] = matching(
        a1, a2, gain, p[MODEL_A1], p[MODEL_A2], p[MODEL_GAIN], p[POLE]
    )
    w[io[TAPS + 4]] = y - w[io[MODEL]]
    w[io[TAPS + 5]] = error
    w[io[TAPS + 6]] = trace(s, COVARIANCE, N)
    w[io[TAPS + 7]] = information / (size * p[NOISE])


class IndirectMrac(Block):
    r"""Indirect MRAC: parameters by least squares with forgetting (3.3.2.8-11), gains from them (3.3.2.16).

    .. math:: z=\frac{s^2}{(s+\lambda)^2}y=\theta^T\phi,\quad
        \phi=\frac{1}{(s+\lambda)^2}[u,-sy,-y],\quad \theta=[k_p,a_{p1},a_{p0}]

    .. math:: u=Kr+\frac{\alpha_1}{s+\lambda}u+\frac{B_1s+B_0}{s+\lambda}y

    It identifies all the time from the voltage applied. The gains are only as good as the parameters: under one tone
    some combination of them is not identifiable.
    """

    title = "Indirect MRAC"
    inputs = (*INPUTS, *TRUTH)
    outputs = (OUTPUT,)
    taps = (
        Port("parameter", "mixed", "estimates of kp, a1 and a2, time in 1/w0", labels=PARAMETERS),
        Port("parameter_true", "mixed", "what they should be", labels=PARAMETERS),
        Port("gain", "mixed", "gains on r, w1, w2 and y computed from the estimates", labels=GAINS),
        Port("gain_ideal", "mixed", "gains that would match the model exactly", labels=GAINS),
        Port("error", "um", "measured minus model displacement"),
        Port("prediction_error", "um", "what the estimate missed, in um w0^2"),
        Port("trace", "mixed", "trace of the covariance"),
        Port("excitation", "1", "what the regressor of this sample tells beside what is known"),
    )
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
            why="equating the transfer functions gives K_m/K_p; the printed ratio multiplies the displacement at rest "
            "by (K_p/K_m)^2",
        ),
    )

    class Params(BlockParams):
        """Identification and gains, in um, V and 1/w0."""

        forgetting_rate: float = parameter(30.0, "rate B of forgetting", "1/s", equation="3.3.2.10", ge=0, le=1e5)
        normaliser: float = parameter(10.0, "weight alpha of the normaliser", equation="3.3.2.11", ge=0, le=1e4)
        covariance: float = parameter(1e3, "covariance at the start", equation="3.3.2.10", gt=0, le=1e6, live=False)
        trace_limit: float = parameter(1e5, "largest trace of the covariance, 0 for none", ge=0)
        filter_pole: float = parameter(
            1.0, "pole of all filters over w0", equation="3.3.2.5", gt=0.05, le=10, live=False
        )
        gain_floor: float = parameter(0.1, "least share of the nominal gain the estimate may fall to", gt=0, le=1)
        gain_map: Literal["working", "printed"] = parameter(
            "working", "gain on the reference: K_m/K_p, or as printed K_p/K_m", equation="3.3.2.16"
        )

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants and models that are not of second order."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        h = context.dt_ms * context.device.natural_frequency
        (a1, a2, gain), (m1, m2, model_gain) = coefficients(context)
        forgetting = math.exp(-1e-3 * params.forgetting_rate * context.dt_ms)
        floor = params.gain_floor * gain
        low, high = (floor, math.inf) if gain > 0.0 else (-math.inf, floor)
        pole = params.filter_pole
        return np.array(
            [
                *driven_filter(pole, h, context.analogue),
                forgetting,
                forgetting / h,
                params.normaliser,
                params.trace_limit,
                low,
                high,
                pole,
                *lag(pole, h, context.analogue),
                float(params.gain_map == "printed"),
                m1,
                m2,
                model_gain,
                a1,
                a2,
                gain,
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Parameters of the nominal device, the covariance, everything else at rest."""
        a1, a2, gain = coefficients(context)[0]
        start = np.zeros(SIZE)
        start[THETA : THETA + N] = gain, a1, a2
        start[COVARIANCE : COVARIANCE + triangle(N)] = diagonal(N, params.covariance)
        return start

    step = indirect_mrac_step
