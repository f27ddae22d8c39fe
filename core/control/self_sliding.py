"""Self-sliding adaptive control: three static gains, adapted by the sign of the error."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.control.controller import (
    APPLIED,
    INPUTS,
    MEASURED,
    MODEL,
    MODEL_FILTER_MORE,
    MODEL_FILTER_SIZE,
    OUTPUT,
    REFERENCE,
    TRUTH,
    VELOCITY_INPUTS,
    advance_model,
    coefficients,
    model_filter,
    saturated,
    true_plant,
    unsuited_order,
)
from core.control.velocity import STATES, Source, pack_velocity, velocity, velocity_source
from core.voltage import add_moved, moved

H, RATE, SIGN, GAIN, WEIGHT_GAIN, LAYER, LEAKAGE, BOUND, FORM, ORIENTATION, SLOPE, RATIO, SECOND_ORDER = range(13)
MODEL_A1, MODEL_A2, MODEL_GAIN, PLANT_A1, PLANT_A2, PLANT_GAIN, MODEL_FILTER = range(13, 20)
MOVING = MODEL_FILTER + MODEL_FILTER_SIZE
FORMS = ("augmented", "relative_degree_one", "velocity", "printed")
AUGMENTED, RELATIVE_DEGREE_ONE, WITH_VELOCITY, PRINTED = range(4)
N = 4
THETA, ALPHA, LAST, FILTERED, APPLIED_FILTER, OWN, MOTION, SIZE = 0, 4, 5, 9, 17, 19, 20, 20 + STATES
VELOCITY, MODEL_VELOCITY = len(INPUTS), len(INPUTS) + 1
FIRST_TRUTH = len(INPUTS) + len(VELOCITY_INPUTS)
OWN_VOLTAGE = FIRST_TRUTH + len(TRUTH)
TAPS = OWN_VOLTAGE + 1
LABELS = ("r", "y", "e", "rate")


def self_sliding_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Measure, find the side of the surface, adapt, compute the voltage."""
    r = w[io[REFERENCE]]
    u, middle, end = moved(w, io, APPLIED)
    y = w[io[MEASURED]]
    form = p[FORM]
    v = velocity(p, MOVING, s, MOTION, w[io[VELOCITY]], y, u, middle, end) / p[RATE]
    e = p[ORIENTATION] * (y - w[io[MODEL]])
    eta = 0.0
    augmenting = form == AUGMENTED or form == PRINTED
    if augmenting:
        for i in range(3):
            advance_model(p, MODEL_FILTER, s, FILTERED + 2 * i, s[LAST + i])
        advance_model(p, MODEL_FILTER, s, APPLIED_FILTER, u)
        add_moved(p, MODEL_FILTER + MODEL_FILTER_MORE, s, APPLIED_FILTER, middle, end)
        eta = -s[APPLIED_FILTER]
        size = 1.0
        for i in range(3):
            eta += s[THETA + i] * s[FILTERED + 2 * i]
            size += s[LAST + i] * s[LAST + i]
        eta = settled(p[ORIENTATION] * eta)
        surface = settled(e + s[ALPHA] * eta)
        s[ALPHA] -= p[H] * p[WEIGHT_GAIN] * surface * eta / size
    else:
        # the error had its own voltage been applied: nothing to take out while it drives
        advance_model(p, MODEL_FILTER, s, APPLIED_FILTER, s[OWN] - u)
        add_moved(p, MODEL_FILTER + MODEL_FILTER_MORE, s, APPLIED_FILTER, -middle, -end)
        missing = p[ORIENTATION] * p[RATIO]
        surface = settled(e + missing * s[APPLIED_FILTER])
        if form == WITH_VELOCITY:
            slope = p[ORIENTATION] * (v - w[io[MODEL_VELOCITY]] / p[RATE]) + missing * s[APPLIED_FILTER + 1]
            surface = settled(p[SLOPE] * surface + slope)
    s[LAST], s[LAST + 1], s[LAST + 2], s[LAST + 3] = r, y, e, 0.0
    if form == WITH_VELOCITY:
        s[LAST + 2], s[LAST + 3] = surface, v

    a1, a2, gain = true_plant(w, io, FIRST_TRUTH, p[PLANT_A1], p[PLANT_A2], p[PLANT_GAIN])
    if p[SECOND_ORDER] == 0.0:  # there damping is what moves
        scale = w[io[FIRST_TRUTH]] / w[io[FIRST_TRUTH + 2]]
        a1, a2, gain = 0.0, a2 * scale, gain * scale
    t, ideal = io[TAPS], io[TAPS + 1]
    inverse = 1.0 / gain
    w[ideal], w[ideal + 1], w[ideal + 2] = p[MODEL_GAIN] * inverse, (a2 - p[MODEL_A2]) * inverse, 0.0
    w[ideal + 3] = (a1 - p[MODEL_A1]) * inverse if form == WITH_VELOCITY else 0.0
    rate = p[H] * p[GAIN] * p[SIGN] * saturated(surface, p[LAYER])
    voltage = 0.0
    distance = 0.0
    for i in range(N):
        regressor = s[FILTERED + 2 * i] if form == AUGMENTED and i < 3 else s[LAST + i]
        theta = s[THETA + i]
        theta -= rate * regressor + p[H] * p[LEAKAGE] * p[GAIN] * theta
        if p[BOUND] > 0.0:
            theta = min(max(theta, -p[BOUND]), p[BOUND])
        s[THETA + i] = theta
        voltage += theta * s[LAST + i]
        w[t + i] = theta
        distance += (theta - w[ideal + i]) * (theta - w[ideal + i])
    s[OWN] = voltage
    w[io[OWN_VOLTAGE]] = voltage
    w[io[TAPS + 2]] = e
    w[io[TAPS + 3]] = surface
    w[io[TAPS + 4]] = eta
    w[io[TAPS + 5]] = s[ALPHA]
    w[io[TAPS + 6]] = abs(surface) + 0.5 * abs(gain) * distance / p[GAIN]
    w[io[TAPS + 7]] = -p[MODEL_A2] * abs(surface)


class SelfSliding(Block):
    r"""Self-sliding adaptive control of chapter 4: static gains on r, y and e, adapted by the sign of the error.

    .. math:: u=k_rr+k_yy+k_ee,\quad \dot\theta=-\mathrm{sgn}(k_p)\,P_0\,\mathrm{sgn}(s)\,w,\quad e=y-y_m

    ``relative_degree_one`` has :math:`s=e`; ``augmented`` has :math:`s=e+\alpha(\theta^T\bar w-G_m[u])` and adapts
    along the filtered regressor :math:`\bar w=G_m[w]`; ``printed`` along w itself; ``velocity`` has
    :math:`s=\dot e+ce` and feeds back s and the velocity as well. Static gains cannot add damping, so a fault of
    damping or a large one of mass stays; :math:`k_e` has no value it could go to.
    """

    title = "Self-sliding control"
    inputs = (*INPUTS, *VELOCITY_INPUTS, *TRUTH)
    outputs = (OUTPUT,)
    taps = (
        Port("gain", "mixed", "adapted gains on r, y, e (or s) and the velocity", labels=LABELS),
        Port("gain_ideal", "mixed", "gains that would match, as far as static ones can", labels=LABELS),
        Port("error", "um", "measured minus model displacement, or the other way round with the printed signs"),
        Port("surface", "um", "s, whose sign drives the adaptation"),
        Port("auxiliary_error", "um", "auxiliary error eta"),
        Port("alpha", "1", "adapted gain of the auxiliary error"),
        Port("lyapunov", "um", "Lyapunov function V of a plant of first order"),
        Port("lyapunov_rate", "um", "its derivative by theory, per 1/w0"),
    )
    equations = (
        Equation(
            "law",
            r"u=k_rr+k_yy+k_ee,\quad e=y-y_m",
            "4.2.1.1-3",
            printed=r"C=k_pR_p+k_e(R_m-R_p)+k_rr",
            why="with e = R_m - R_p the printed minus signs of the adaptation are positive feedback",
        ),
        Equation("adaptation", r"\dot\theta=-\mathrm{sgn}(k_p)\,P_0\,\mathrm{sgn}(s)\,w", "4.2.1.4-6"),
        Equation(
            "augmented error",
            r"\varepsilon=e+\alpha\eta,\;\eta=\theta^T\bar w-G_m[u],\;\bar w=G_m[w]",
            "4.2.2.1-5",
            printed=r"\eta=\theta^T[G_m\omega]-[G_m\theta^T]\omega",
            why="the model acts on the product; and along the raw regressor k_e runs away under noise",
        ),
        Equation(
            "Lyapunov function, first order",
            r"V=|e|+\tfrac{|k_p|}{2P_0}\phi^T\phi,\quad \dot V=-a_m|e|",
            "4.2.1.7-13",
            printed=r"V=\tfrac12e^2+\tfrac{|s|}{2P_0}(\tilde k_e^2+\tilde k_r^2+\tilde k_p^2)",
            why="the printed V is 0 whenever e is, whatever the gains, and its proof drops the term of the model",
        ),
    )

    class Params(BlockParams):
        """Parameters of the law, in um, V and 1/w0."""

        adaptation_gain: float = parameter(0.03, "adaptation gain P0", equation="4.2.1.4-6", gt=0, le=1e4)
        form: Literal["augmented", "relative_degree_one", "velocity", "printed"] = parameter(
            "augmented",
            "augmented error with filtered regressor, plain error, surface with velocity, or augmented error with the "
            "raw regressor as printed",
            equation="4.2.2",
        )
        signs: Literal["working", "printed"] = parameter(
            "working", "error measured minus model, or as printed", equation="4.2.1.1"
        )
        alpha_gain: float = parameter(
            0.3, "gain of the weight of the auxiliary error", equation="4.2.2.5", ge=0, le=1e3
        )
        surface_slope: float = parameter(2.0, "c of the surface with velocity, over w0", gt=0, le=100)
        layer_um: float = parameter(0.0, "boundary layer of the sign, 0 for none", "um", ge=0, le=100)
        start: Literal["nominal", "zero"] = parameter(
            "nominal", "gains at the start: those that match the nominal device, or none", live=False
        )
        leakage: float = parameter(0.0, "leakage of the gains, per 1/w0", ge=0, le=1)
        gain_bound: float = parameter(0.0, "bound of the gains, 0 for none", ge=0)
        velocity: Source = velocity_source()

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse a model of another kind than the plant."""
        return unsuited_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        plant, model = coefficients(context)
        rate = context.device.natural_frequency
        return np.array(
            [
                context.dt_ms * rate,
                rate,
                # along the filtered regressor the sign of the model is in it
                math.copysign(1.0, plant[2] * (model[2] if params.form == "augmented" else 1.0)),
                params.adaptation_gain,
                params.alpha_gain,
                params.layer_um,
                params.leakage,
                params.gain_bound,
                float(FORMS.index(params.form)),
                1.0 if params.signs == "working" else -1.0,
                params.surface_slope,
                plant[2] / model[2],
                float(context.device.mass > 0.0),
                *model,
                *plant,
                *model_filter(context),
                *pack_velocity(params.velocity, context, rate),
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Gains at the start, everything else at rest."""
        plant, model = coefficients(context)
        start = np.zeros(SIZE)
        start[ALPHA] = plant[2] / model[2]
        if params.start == "nominal":
            start[THETA] = model[2] / plant[2]
            start[THETA + 1] = (plant[1] - model[1]) / plant[2]
        return start

    step = self_sliding_step
