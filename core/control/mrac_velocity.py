"""Direct model reference adaptive control, relative degree one: with velocity, or for plants of first order."""

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
    MODEL_FILTER_SIZE,
    OUTPUT,
    REFERENCE,
    TRUTH,
    VELOCITY_INPUTS,
    advance_lag,
    advance_model,
    coefficients,
    lag,
    matching,
    model_filter,
    true_plant,
    unsuited_order,
)
from core.control.velocity import STATES, Source, pack_velocity, velocity, velocity_source
from core.voltage import add_moved, moved

H, RATE, SIGN, GAIN, WEIGHT_OUTPUT, LEAKAGE, BOUND, REACH, FILTERS, POLE = range(10)
LEAD, LAG, RATIO, FIRST_ORDER = 10, 11, 11 + LAG_SIZE, 12 + LAG_SIZE
MODEL_A1, MODEL_A2, MODEL_GAIN, PLANT_A1, PLANT_A2, PLANT_GAIN, MODEL_FILTER = range(13 + LAG_SIZE, 20 + LAG_SIZE)
MOVING = MODEL_FILTER + MODEL_FILTER_SIZE
THETA, W1, W2, LAST, OWN, AUXILIARY, MOTION, SIZE = 0, 4, 5, 6, 10, 11, 13, 13 + STATES
"""LAST: the regressor of the sample before, y last."""
LAST_Y = LAST + 3
VELOCITY, MODEL_VELOCITY = len(INPUTS), len(INPUTS) + 1
FIRST_TRUTH = len(INPUTS) + len(VELOCITY_INPUTS)
OWN_VOLTAGE = FIRST_TRUTH + len(TRUTH)
TAPS = OWN_VOLTAGE + 1
LABELS = ("r", "w1", "w2", "y")


@kernel
def matching_lead(
    a1: float,
    a2: float,
    gain: float,
    m1: float,
    m2: float,
    model_gain: float,
    pole: float,
    lead: float,
    first_order: bool,
) -> tuple[float, float, float, float]:
    r"""Return the gains on r, w1, w2 and :math:`y_c=y+\dot y/c` that make the loop equal the model.

    From :math:`(\Lambda-\theta_1)R_p-\tfrac{k_p}{c}(s+c)(\theta_2+\theta_0\Lambda)=\Lambda R_m,\;\Lambda=s+\lambda`:

    .. math:: \theta_1=\frac{(c-\lambda)[(a_{p1}-a_{m1})-(a_{p2}-a_{m2})/c]}{c-a_{p1}+a_{p2}/c}

    A plant of first order needs neither lead nor filters.
    """
    if first_order:
        return model_gain / gain, 0.0, 0.0, (a2 - m2) / gain
    if lead == 0.0:
        return matching(a1, a2, gain, m1, m2, model_gain, pole)
    c = 1.0 / lead
    first = (c - pole) * ((a1 - m1) - (a2 - m2) * lead) / (c - a1 + a2 * lead)
    through = (a1 - m1 - first) / (gain * lead)
    rest = ((pole - first) * a2 - pole * m2) / gain
    return model_gain / gain, first, rest - pole * through, through


def mrac_velocity_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Measure, advance the filters, adapt, compute the voltage."""
    r = w[io[REFERENCE]]
    u, middle, end = moved(w, io, APPLIED)
    y = w[io[MEASURED]]
    y += p[LEAD] * velocity(p, MOVING, s, MOTION, w[io[VELOCITY]], y, u, middle, end) / p[RATE]
    # what the plant would have done under the voltage asked for here
    advance_model(p, MODEL_FILTER, s, AUXILIARY, s[OWN] - u)
    add_moved(p, MODEL_FILTER + MODEL_FILTER_MORE, s, AUXILIARY, -middle, -end)
    if p[FILTERS] != 0.0:
        advance_lag(p, LAG, s, W1, u, middle, end)
        advance_lag(p, LAG, s, W2, s[LAST_Y], 0.0, 0.0)
    e = y - (w[io[MODEL]] + p[LEAD] * w[io[MODEL_VELOCITY]] / p[RATE])
    own = settled(e + p[RATIO] * (s[AUXILIARY] + p[LEAD] * s[AUXILIARY + 1]))

    a1, a2, gain = true_plant(w, io, FIRST_TRUTH, p[PLANT_A1], p[PLANT_A2], p[PLANT_GAIN])
    if p[FIRST_ORDER] != 0.0:  # damping is what moves there
        a1, a2, gain = 0.0, a2 * w[io[FIRST_TRUTH]], gain * w[io[FIRST_TRUTH]]
        a2 /= w[io[FIRST_TRUTH + 2]]
        gain /= w[io[FIRST_TRUTH + 2]]
    t, ideal = io[TAPS], io[TAPS + 1]
    w[ideal], w[ideal + 1], w[ideal + 2], w[ideal + 3] = matching_lead(
        a1, a2, gain, p[MODEL_A1], p[MODEL_A2], p[MODEL_GAIN], p[POLE], p[LEAD], p[FIRST_ORDER] != 0.0
    )
    weight = p[WEIGHT_OUTPUT]
    # the step of an implicit method: a sample changes the error by REACH times the change of voltage
    # along the regressor of the sample before, which is the one in the error: with that of now a voltage that turns
    # at every sample, as in chatter, would turn the sign of the law
    size = s[LAST] * s[LAST] + s[LAST + 1] * s[LAST + 1]
    size += weight * (s[LAST + 2] * s[LAST + 2] + s[LAST_Y] * s[LAST_Y])
    rate = p[H] * p[GAIN] * own / (1.0 + p[H] * p[GAIN] * p[REACH] * size)
    lyapunov = 0.0
    voltage = 0.0
    for i in range(4):
        regressor = r if i == 0 else s[W1] if i == 1 else s[W2] if i == 2 else y
        g = 1.0 if i < 2 else weight
        theta = s[THETA + i]
        theta += -p[SIGN] * rate * g * s[LAST + i] - p[H] * p[LEAKAGE] * p[GAIN] * theta
        if p[BOUND] > 0.0:
            bound = p[BOUND] * math.sqrt(g)
            theta = min(max(theta, -bound), bound)
        s[THETA + i] = theta
        s[LAST + i] = regressor
        voltage += theta * regressor
        w[t + i] = theta
        missing = theta - w[ideal + i]
        lyapunov += missing * missing / g
    s[OWN] = voltage
    w[io[OWN_VOLTAGE]] = voltage
    w[io[TAPS + 2]] = e
    w[io[TAPS + 3]] = own
    w[io[TAPS + 4]] = 0.5 * own * own + 0.5 * abs(gain) * lyapunov / p[GAIN]
    w[io[TAPS + 5]] = -p[MODEL_A2] * own * own if p[FIRST_ORDER] != 0.0 else 0.0


class MracVelocity(Block):
    r"""Direct MRAC of relative degree one (3.1.2.12): no augmented error, but it needs the velocity.

    .. math:: u=\theta^Tw,\quad w=[r,w_1,w_2,y_c],\;y_c=y+\dot y/c,\quad \dot\theta=-\mathrm{sgn}(k_p)\,g\,\Gamma e_cw

    With :math:`c<a_{m1}` the model from r to :math:`y_{c}` is strictly positive real, which the plain law needs; on y
    alone it is not. A plant of first order is so by itself. The error is that of its own voltage: what another
    controller applied instead is taken out through a copy of the model, so it learns in shadow and in saturation.
    """

    title = "Direct MRAC with velocity"
    inputs = (*INPUTS, *VELOCITY_INPUTS, *TRUTH)
    outputs = (OUTPUT,)
    taps = (
        Port("gain", "mixed", "adapted gains on r, w1, w2 and y", labels=LABELS),
        Port("gain_ideal", "mixed", "gains that would match the model exactly", labels=LABELS),
        Port("error", "um", "measured minus model output, velocity included"),
        Port("own_error", "um", "the same, had its own voltage been applied"),
        Port("lyapunov", "um^2", "Lyapunov function V of a plant of first order"),
        Port("lyapunov_rate", "um^2", "its derivative by theory, first order only, per 1/w0"),
    )
    equations = (
        Equation("law", r"u=\theta^Tw,\quad w=[r,w_1,w_2,y_c]^T,\quad y_c=y+\dot y/c,\;c=0.9\,a_{m1}", "3.1.2.5-8"),
        Equation(
            "adaptation",
            r"\dot\theta=-\mathrm{sgn}(k_p)\,g\,\Gamma\,e_c\,w",
            "3.1.2.12",
            printed=r"\dot\theta=-\mathrm{sgn}(k_p)\,g\,e\,w",
            why="from r to y the resonator is of relative degree two and not positive real: the plain law on y fails "
            "at small gains already",
        ),
        Equation(
            "Lyapunov function, first order",
            r"V=\tfrac12e^2+\tfrac{|k_p|}{2g}\phi^T\Gamma^{-1}\phi,\quad\dot V=-a_me^2",
        ),
    )

    class Params(BlockParams):
        """Parameters of the law, in um, V and 1/w0."""

        adaptation_gain: float = parameter(0.05, "adaptation gain g", equation="3.1.2.12", gt=0, le=1e6)
        form: Literal["relative_degree_one", "printed"] = parameter(
            "relative_degree_one",
            "on displacement and velocity, or as printed on displacement alone; the same for a plant of first order",
            equation="3.1.2.12",
            live=False,
        )
        zero: float = parameter(
            0.9, "zero c over the damping a1 of the model; below 1 is positive real", gt=0, le=10, live=False
        )
        filters: bool | None = parameter(
            None, "filters of input and output; unless given, for plants of second order only", live=False
        )
        filter_pole: float = parameter(1.0, "pole of the state filters over w0", gt=0.05, le=10, live=False)
        output_weight: float | None = parameter(
            None, "weight of w2 and y in Gamma; 1/kp^2 unless given, so that y counts in volts", "V^2/um^2", gt=0
        )
        start: Literal["nominal", "zero"] = parameter(
            "nominal", "gains at the start: those that match the nominal device, or none", live=False
        )
        leakage: float = parameter(0.0, "leakage of the gains, per 1/w0", ge=0, le=1)
        gain_bound: float = parameter(30.0, "bound of the gains (projection), 0 for none", ge=0)
        velocity: Source = velocity_source()

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse a model of another kind than the plant."""
        return unsuited_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        plant, model, lead = cls.shape(params, context)
        rate, pole, first_order = context.device.natural_frequency, params.filter_pole, context.device.mass == 0.0
        h = context.dt_ms * rate
        copy = model_filter(context)
        return np.array(
            [
                h,
                rate,
                math.copysign(1.0, plant[2]),
                params.adaptation_gain,
                1.0 / plant[2] ** 2 if params.output_weight is None else params.output_weight,
                params.leakage,
                params.gain_bound,
                abs(plant[2] / model[2] * (copy[4] + lead * copy[5])),
                float(not first_order if params.filters is None else params.filters),
                pole,
                lead,
                *lag(pole, h, context.analogue),
                plant[2] / model[2],
                float(first_order),
                *model,
                *plant,
                *copy,
                *pack_velocity(params.velocity, context, rate),
            ]
        )

    @classmethod
    def shape(
        cls, params: Any, context: Context
    ) -> tuple[tuple[float, float, float], tuple[float, float, float], float]:
        """Return coefficients of plant and model, and the weight of the velocity in 1/w0."""
        plant, model = coefficients(context)
        needs_lead = context.device.mass > 0.0 and params.form != "printed"
        return plant, model, 1.0 / (params.zero * (model[0] or 1.0)) if needs_lead else 0.0

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Gains that match the nominal device, everything else at rest."""
        plant, model, lead = cls.shape(params, context)
        start = np.zeros(SIZE)
        first_order = context.device.mass == 0.0
        if params.start == "nominal":
            start[THETA : THETA + 4] = matching_lead(*plant, *model, params.filter_pole, lead, first_order)
        return start

    step = mrac_velocity_step
