"""Direct model reference adaptive control, relative degree two."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, kernel, parameter, settled
from core.control.controller import (
    APPLIED,
    INPUTS,
    LAG_SIZE,
    MEASURED,
    MODEL,
    MODEL_FILTER_MORE,
    OUTPUT,
    REFERENCE,
    TRUTH,
    advance_lag,
    advance_model,
    coefficients,
    lag,
    matching,
    model_filter,
    true_plant,
    unsuited_second_order,
)
from core.voltage import add_moved, moved

H, GAIN, WEIGHT_INPUT, WEIGHT_OUTPUT, POLE, LEAKAGE, BOUND, NORMALISE, AUGMENT, ADAPT_ALPHA = range(10)
MODEL_GAIN, MODEL_A1, MODEL_A2, PLANT_A1, PLANT_A2, PLANT_GAIN, SIGN, LAG = range(10, 18)
BIAS, ASKED_FOR, MODEL_FILTER = range(LAG + LAG_SIZE, LAG + LAG_SIZE + 3)
R, FILTERED_INPUT, FILTERED_OUTPUT, Y, CONSTANT, N = range(6)
"""The regressors; the constant takes part only if it is not 0."""
THETA, ALPHA, W1, W2, LAST = 0, N, N + 1, N + 2, N + 3  # LAST: the regressor of the sample before
FILTERED, APPLIED_FILTER = LAST + N, LAST + 3 * N
START, OWN, STATES = APPLIED_FILTER + 2, APPLIED_FILTER + 3, APPLIED_FILTER + 4
FIRST_TRUTH = len(INPUTS)
DRIVE_OFFSET = FIRST_TRUTH + len(TRUTH)
OWN_VOLTAGE = DRIVE_OFFSET + 1
TAPS = OWN_VOLTAGE + 1


@kernel
def weight(p: Any, i: int) -> float:
    """Return the adaptation weight of a regressor: w2 and y are micrometres, the others volts."""
    return float(p[WEIGHT_OUTPUT] if i == FILTERED_OUTPUT or i == Y else p[WEIGHT_INPUT])


def mrac_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Measure, advance the filters, adapt, compute the voltage."""
    y = w[io[MEASURED]]
    r = w[io[REFERENCE]]
    u, middle, end = moved(w, io, APPLIED)
    n = CONSTANT if p[BIAS] == 0.0 else N
    if s[START] != 0.0:
        for i in range(n):
            advance_model(p, MODEL_FILTER, s, FILTERED + 2 * i, s[LAST + i])  # w~ = G_m[w]
        if p[ASKED_FOR] == 0.0:
            advance_model(p, MODEL_FILTER, s, APPLIED_FILTER, u)  # G_m[u]
            add_moved(p, MODEL_FILTER + MODEL_FILTER_MORE, s, APPLIED_FILTER, middle, end)
        else:
            advance_model(p, MODEL_FILTER, s, APPLIED_FILTER, s[OWN])
        advance_lag(p, LAG, s, W1, u, middle, end)  # w1' = -lam w1 + u
        advance_lag(p, LAG, s, W2, s[LAST + Y], 0.0, 0.0)  # w2' = -lam w2 + y
    s[START] = 1.0
    s[LAST], s[LAST + 1], s[LAST + 2], s[LAST + 3], s[LAST + 4] = r, s[W1], s[W2], y, p[BIAS]

    e = settled(y - w[io[MODEL]])
    eta = -s[APPLIED_FILTER]
    den = 1.0
    for i in range(n):
        filtered = s[FILTERED + 2 * i]
        eta += s[THETA + i] * filtered
        den += weight(p, i) * filtered * filtered
    eta = settled(eta)
    den += eta * eta
    if p[NORMALISE] == 0.0:
        den = 1.0
    eps = settled(e + s[ALPHA] * eta) if p[AUGMENT] != 0.0 else e
    rate = p[H] * p[GAIN] / den
    voltage = 0.0
    for i in range(n):
        g = weight(p, i)
        theta = s[THETA + i]
        theta += -p[SIGN] * rate * g * eps * s[FILTERED + 2 * i] - p[H] * p[LEAKAGE] * p[GAIN] * theta
        if p[BOUND] > 0.0:
            # a projection onto a box scaled like the adaptation weights
            bound = p[BOUND] * math.sqrt(g)
            theta = min(max(theta, -bound), bound)
        s[THETA + i] = theta
        voltage += theta * s[LAST + i]
    if p[ADAPT_ALPHA] != 0.0:
        s[ALPHA] -= rate * eps * eta
    s[OWN] = voltage
    w[io[OWN_VOLTAGE]] = voltage

    a1, a2, gain = true_plant(w, io, FIRST_TRUTH, p[PLANT_A1], p[PLANT_A2], p[PLANT_GAIN])
    t = io[TAPS]
    ideal = io[TAPS + 1]
    w[ideal], w[ideal + 1], w[ideal + 2], w[ideal + 3] = matching(
        a1, a2, gain, p[MODEL_A1], p[MODEL_A2], p[MODEL_GAIN], p[POLE]
    )
    # what takes a constant voltage at the comb out again
    offset = w[io[DRIVE_OFFSET]] / w[io[FIRST_TRUTH + 3]]
    w[ideal + CONSTANT] = -(1.0 - w[ideal + 1] / p[POLE]) * offset / p[BIAS] if n == N else 0.0
    w[t + CONSTANT] = s[THETA + CONSTANT]
    lyapunov = 0.0
    for i in range(n):
        w[t + i] = s[THETA + i]
        phi = s[THETA + i] - w[ideal + i]
        lyapunov += phi * phi / weight(p, i)
    inverse = 1.0 / w[ideal]
    lyapunov = 0.5 * (abs(inverse) * lyapunov + (s[ALPHA] - inverse) * (s[ALPHA] - inverse)) / p[GAIN]
    w[io[TAPS + 2]] = s[ALPHA]
    w[io[TAPS + 3]] = e
    w[io[TAPS + 4]] = eta
    w[io[TAPS + 5]] = eps
    w[io[TAPS + 6]] = lyapunov
    w[io[TAPS + 7]] = -eps * eps / den


LABELS = ("r", "w1", "w2", "y", "bias")


class Mrac(Block):
    r"""Direct model reference adaptive control with augmented error (3.1.2.5-16).

    .. math:: u=\theta^Tw,\quad w=[r,w_1,w_2,y],\quad \dot w_1=-\lambda w_1+u,\;\dot w_2=-\lambda w_2+y

    .. math:: \eta=\theta^T\bar w-G_m[u],\;\bar w=G_m[w],\quad \varepsilon=e+\alpha\eta,\;e=y-y_m

    .. math:: \dot\theta=-\mathrm{sgn}(k_p/k_m)\,g\,\Gamma\frac{\varepsilon\bar w}{1+\bar w^T\Gamma\bar w+\eta^2},
        \quad \dot\alpha=-g\frac{\varepsilon\eta}{1+\bar w^T\Gamma\bar w+\eta^2}

    Time is in units of :math:`1/\omega_0`, displacement in um: the gain depends on units, and ``1`` in SI
    would move nothing. The auxiliary signal is taken from the voltage that was *applied*, which is the same as
    3.1.2.14 in normal running and stays exact in saturation or while another controller drives.
    """

    title = "Direct MRAC"
    inputs = (
        *INPUTS,
        *TRUTH,
        Port("drive_offset", "V", "voltage at the comb that nobody applied", source="effects.drive_offset"),
    )
    outputs = (OUTPUT,)
    taps = (
        Port("gain", "mixed", "adapted gains on r, w1, w2, y and a constant", labels=LABELS),
        Port("gain_ideal", "mixed", "gains that would match the model exactly", labels=LABELS),
        Port("alpha", "1", "adapted gain of the auxiliary error"),
        Port("error", "um", "measured minus model displacement"),
        Port("auxiliary_error", "um", "auxiliary error eta"),
        Port("augmented_error", "um", "augmented error epsilon"),
        Port("lyapunov", "um^2", "Lyapunov function V"),
        Port("lyapunov_rate", "um^2", "its derivative by theory, per 1/w0"),
    )
    equations = (
        Equation("law", r"u=\theta^Tw,\quad w=[r,w_1,w_2,y]^T", "3.1.2.5-8"),
        Equation(
            "augmented error",
            r"\varepsilon=e+\alpha\eta,\quad \eta=\theta^T\bar w-G_m[u_{applied}],\quad \bar w=G_m[w]",
            "3.1.2.13-14",
            printed=r"\eta=\phi^T\bar w-G_m[\phi^Tw]",
            why="the parameter error phi cannot be computed; theta may replace it, because theta* cancels. Using "
            "the voltage applied keeps the identity in saturation and in shadow",
        ),
        Equation(
            "adaptation",
            r"\dot\theta=-\mathrm{sgn}(k_p/k_m)\,g\,\Gamma\,\frac{\varepsilon\bar w}{1+\bar w^T\Gamma\bar w+\eta^2}",
            "3.1.2.15-16",
        ),
        Equation(
            "Lyapunov function",
            r"V=\tfrac{1}{2g}\left(|1/k^*|\,\phi^T\Gamma^{-1}\phi+(\alpha-1/k^*)^2\right)",
        ),
    )

    class Params(BlockParams):
        """Gains of the adaptation, in um, V and 1/w0."""

        adaptation_gain: float = parameter(1.0, "adaptation gain g", equation="3.1.2.15", gt=0, le=1e6)
        filter_pole: float = parameter(
            1.0, "pole of the state filters over w0", equation="3.1.2.6", gt=0.05, le=10, live=False
        )
        output_weight: float | None = parameter(
            None,
            "weight of w2 and y in Gamma; 1/kp^2 unless given, so that y counts in volts",
            "V^2/um^2",
            gt=0,
        )
        leakage: float = parameter(0.0, "leakage of the gains, per 1/w0", ge=0, le=1)
        gain_bound: float = parameter(0.0, "bound of the gains (projection), 0 for none", ge=0)
        normalise: bool = parameter(True, "divide by 1 + w'Gw + eta^2")
        augment: bool = parameter(
            True, "adapt on the augmented error; off adapts on the plain one", equation="3.1.2.14"
        )
        auxiliary: Literal["applied", "printed"] = parameter(
            "applied",
            "voltage the auxiliary error is taken from: the one applied, or as printed the one asked for, which is "
            "another at the limit and while another controller drives",
            equation="3.1.2.14",
        )
        adapt_alpha: bool = parameter(True, "adapt alpha as well")
        bias_v: float = parameter(0.0, "constant regressor against a constant load, 0 for none", "V", ge=0, le=100)

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants and models that are not of second order."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        h = context.dt_ms * context.device.natural_frequency
        (a1, a2, gain), (m1, m2, model_gain) = coefficients(context)
        weight = 1.0 / gain**2 if params.output_weight is None else params.output_weight
        pole = params.filter_pole
        return np.array(
            [
                h,
                params.adaptation_gain,
                1.0,
                weight,
                pole,
                params.leakage,
                params.gain_bound,
                float(params.normalise),
                float(params.augment),
                float(params.adapt_alpha),
                model_gain,
                m1,
                m2,
                a1,
                a2,
                gain,
                math.copysign(1.0, gain * model_gain),
                *lag(pole, h, context.analogue),
                params.bias_v,
                float(params.auxiliary == "printed"),
                *model_filter(context),
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Gains that match the nominal device, everything else at rest."""
        plant, model = coefficients(context)
        start = np.zeros(STATES)
        start[THETA : THETA + CONSTANT] = matching(*plant, *model, params.filter_pole)
        start[ALPHA] = 1.0 / start[THETA]
        return start

    step = mrac_step
