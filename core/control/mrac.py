"""Direct model reference adaptive control, relative degree two."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, kernel, parameter, settled
from core.control.controller import APPLIED, FIRST_ORDER, INPUTS, MEASURED, MODEL, OUTPUT, REFERENCE, normalised
from core.device.oscillator import transition

H, GAIN, WEIGHT_INPUT, WEIGHT_OUTPUT, POLE, LEAKAGE, BOUND, NORMALISE, AUGMENT, ADAPT_ALPHA = range(10)
MODEL_GAIN, MODEL_A1, MODEL_A2, PLANT_A1, PLANT_A2, PLANT_GAIN, SIGN, FILTER_DECAY, FILTER_GAIN = range(10, 19)
PHI11, PHI12, PHI21, PHI22, STATIC = range(19, 24)
THETA, ALPHA, W1, W2, LAST = 0, 4, 5, 6, 7  # LAST: the regressor of the sample before
FILTERED, APPLIED_FILTER, START = 11, 19, 21  # two states for each of the four regressors, then of the input
MASS_SCALE, STIFFNESS_SCALE, DAMPING_SCALE = 5, 6, 7
OWN_VOLTAGE = 8
TAPS = OWN_VOLTAGE + 1


@kernel
def advance(p: Any, s: Any, at: int, held: float) -> None:
    """Advance one copy of the model over an interval with a held input."""
    rest = p[STATIC] * held
    x = s[at] - rest
    v = s[at + 1]
    s[at] = settled(p[PHI11] * x + p[PHI12] * v + rest)
    s[at + 1] = settled(p[PHI21] * x + p[PHI22] * v)


def mrac_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Measure, advance the filters, adapt, compute the voltage."""
    y = w[io[MEASURED]]
    r = w[io[REFERENCE]]
    u = w[io[APPLIED]]
    if s[START] != 0.0:
        for i in range(4):
            advance(p, s, FILTERED + 2 * i, s[LAST + i])  # w~ = G_m[w]
        advance(p, s, APPLIED_FILTER, u)  # G_m[u]
        s[W1] = settled(p[FILTER_DECAY] * s[W1] + p[FILTER_GAIN] * u)  # w1' = -lam w1 + u
        s[W2] = settled(p[FILTER_DECAY] * s[W2] + p[FILTER_GAIN] * s[LAST + 3])  # w2' = -lam w2 + y
    s[START] = 1.0
    s[LAST], s[LAST + 1], s[LAST + 2], s[LAST + 3] = r, s[W1], s[W2], y

    e = settled(y - w[io[MODEL]])
    eta = -s[APPLIED_FILTER]
    den = 1.0
    for i in range(4):
        filtered = s[FILTERED + 2 * i]
        eta += s[THETA + i] * filtered
        den += (p[WEIGHT_INPUT] if i < 2 else p[WEIGHT_OUTPUT]) * filtered * filtered
    eta = settled(eta)
    den += eta * eta
    if p[NORMALISE] == 0.0:
        den = 1.0
    eps = settled(e + s[ALPHA] * eta) if p[AUGMENT] != 0.0 else e
    rate = p[H] * p[GAIN] / den
    for i in range(4):
        g = p[WEIGHT_INPUT] if i < 2 else p[WEIGHT_OUTPUT]
        theta = s[THETA + i]
        theta += -p[SIGN] * rate * g * eps * s[FILTERED + 2 * i] - p[H] * p[LEAKAGE] * p[GAIN] * theta
        if p[BOUND] > 0.0:
            # a projection onto a box scaled like the adaptation weights
            bound = p[BOUND] * math.sqrt(g)
            theta = min(max(theta, -bound), bound)
        s[THETA + i] = theta
    if p[ADAPT_ALPHA] != 0.0:
        s[ALPHA] -= rate * eps * eta

    voltage = 0.0
    for i in range(4):
        voltage += s[THETA + i] * s[LAST + i]
    w[io[OWN_VOLTAGE]] = voltage

    # what the gains should be, from the truth the bench knows
    mass = w[io[MASS_SCALE]]
    a1 = p[PLANT_A1] * w[io[DAMPING_SCALE]] / mass
    a2 = p[PLANT_A2] * w[io[STIFFNESS_SCALE]] / mass
    gain = p[PLANT_GAIN] / mass
    ideal_r = p[MODEL_GAIN] / gain
    ideal_w1 = a1 - p[MODEL_A1]
    ideal_y = (a2 + (p[POLE] - ideal_w1) * a1 - p[MODEL_A2] - p[POLE] * p[MODEL_A1]) / gain
    ideal_w2 = ((p[POLE] - ideal_w1) * a2 - p[POLE] * p[MODEL_A2]) / gain - p[POLE] * ideal_y
    t = io[TAPS]
    ideal = io[TAPS + 1]
    w[ideal], w[ideal + 1], w[ideal + 2], w[ideal + 3] = ideal_r, ideal_w1, ideal_w2, ideal_y
    lyapunov = 0.0
    for i in range(4):
        w[t + i] = s[THETA + i]
        phi = s[THETA + i] - w[ideal + i]
        lyapunov += phi * phi / (p[WEIGHT_INPUT] if i < 2 else p[WEIGHT_OUTPUT])
    inverse = 1.0 / ideal_r
    lyapunov = 0.5 * (abs(inverse) * lyapunov + (s[ALPHA] - inverse) * (s[ALPHA] - inverse)) / p[GAIN]
    w[io[TAPS + 2]] = s[ALPHA]
    w[io[TAPS + 3]] = e
    w[io[TAPS + 4]] = eta
    w[io[TAPS + 5]] = eps
    w[io[TAPS + 6]] = lyapunov
    w[io[TAPS + 7]] = -eps * eps / den


def matching(
    plant: tuple[float, float, float], model: tuple[float, float, float], pole: float
) -> tuple[float, float, float, float]:
    r"""Return the gains on r, w1, w2, y that make the loop equal the model.

    .. math:: k=\frac{k_m}{k_p},\quad \theta_1=a_{p1}-a_{m1},\quad
        \theta_0=\frac{a_{p2}+(\lambda-\theta_1)a_{p1}-a_{m2}-\lambda a_{m1}}{k_p},\quad
        \theta_2=\frac{(\lambda-\theta_1)a_{p2}-\lambda a_{m2}}{k_p}-\lambda\theta_0
    """
    a1, a2, gain = plant
    m1, m2, model_gain = model
    first = a1 - m1
    zero = (a2 + (pole - first) * a1 - m2 - pole * m1) / gain
    return model_gain / gain, first, ((pole - first) * a2 - pole * m2) / gain - pole * zero, zero


LABELS = ("r", "w1", "w2", "y")


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
        Port("mass_scale", "1", "true mass over nominal, for the ideal gains", source="effects.mass_scale"),
        Port("stiffness_scale", "1", "true stiffness over nominal", source="effects.stiffness_scale"),
        Port("damping_scale", "1", "true damping over nominal", source="effects.damping_scale"),
    )
    outputs = (OUTPUT,)
    taps = (
        Port("gain", "mixed", "adapted gains on r, w1, w2 and y", labels=LABELS),
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
        adapt_alpha: bool = parameter(True, "adapt alpha as well")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants of first order, and models that are not at rest without a reference."""
        if model.mass <= 0.0 or model.stiffness <= 0.0:
            return "needs a reference model of second order with a spring"
        return FIRST_ORDER if device.mass == 0.0 else ""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        w0 = context.device.natural_frequency
        h = context.dt_ms * w0
        a1, a2, gain = normalised(context.device, w0)
        m1, m2, model_gain = normalised(context.model, w0)
        gain, model_gain = gain or 1.0, model_gain or 1.0  # identical stators give no gain to match
        weight = 1.0 / gain**2 if params.output_weight is None else params.output_weight
        pole = params.filter_pole
        decay = math.exp(-pole * h)
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
                decay,
                (1.0 - decay) / pole,
                *transition(1.0, m1, m2, h),
                model_gain / m2,
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Gains that match the nominal device, everything else at rest."""
        w0 = context.device.natural_frequency
        plant, model = normalised(context.device, w0), normalised(context.model, w0)
        start = np.zeros(22)
        if plant[2] != 0.0:
            start[THETA : THETA + 4] = matching(plant, model, params.filter_pole)
        start[ALPHA] = 1.0 / (start[THETA] or 1.0)
        return start

    step = mrac_step
