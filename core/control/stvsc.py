"""Self-tuning variable structure control: a gradient estimator tunes the gains of a sliding law."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from core.block import Block, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.control.controller import APPLIED, MEASURED, OUTPUT, TRUTH, true_plant, unsuited_second_order
from core.control.sliding import (
    GAINS_EQUATION,
    LAYER_EQUATION,
    PLANT_A1,
    PLANT_A2,
    PLANT_GAIN,
    RATE,
    SIGN,
    SLIDING_INPUTS,
    SLIDING_SIZE,
    SLIDING_TAPS,
    SURFACE_EQUATION,
    TIME_STEP,
    VELOCITY,
    SlidingParams,
    pack_sliding,
    slide,
)
from core.control.velocity import STATES, VELOCITY_SIZE, pack_velocity, velocity
from core.estimation import DRIVEN_SIZE, advance_filter, drive_filter, driven_filter
from core.voltage import moved

MOVING, FILTER = SLIDING_SIZE, SLIDING_SIZE + VELOCITY_SIZE
ESTIMATOR_GAIN, OUTPUT_WEIGHT, POLE, FLOOR, ON_ESTIMATE, NORMALISE = range(
    FILTER + DRIVEN_SIZE, FILTER + DRIVEN_SIZE + 6
)
PEAK, MOTION, THETA, INPUT_FILTER, OUTPUT_FILTER, LAST, SIZE = (
    0,
    1,
    1 + STATES,
    4 + STATES,
    6 + STATES,
    8 + STATES,
    9 + STATES,
)
FIRST_TRUTH = len(SLIDING_INPUTS)
OWN_VOLTAGE = FIRST_TRUTH + len(TRUTH)
TAPS = OWN_VOLTAGE + 1
ESTIMATES = TAPS + len(SLIDING_TAPS)
LABELS = ("gain", "a2", "a1")
HUGE = 1e9
"""What an estimate that runs away without its normaliser is kept below, so that it stays a number."""


def stvsc_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Estimate with what was applied, then slide with the estimate."""
    y = w[io[MEASURED]]
    u, middle, end = moved(w, io, APPLIED)
    drive_filter(p, FILTER, s, INPUT_FILTER, u, middle, end)
    advance_filter(p, FILTER, s, OUTPUT_FILTER, s[LAST], y)
    s[LAST] = y
    pole = p[POLE]
    # y = kp u* + (lam^2 - a2) y* + (2 lam - a1) py*, with * for 1/(s + lam)^2
    u_filtered, y_filtered, rate_filtered = s[INPUT_FILTER], s[OUTPUT_FILTER], s[OUTPUT_FILTER + 1]
    error = settled(
        s[THETA] * u_filtered
        + (pole * pole - s[THETA + 1]) * y_filtered
        + (2.0 * pole - s[THETA + 2]) * rate_filtered
        - y
    )
    weight = p[OUTPUT_WEIGHT]
    den = 1.0
    if p[NORMALISE] != 0.0:
        den += u_filtered * u_filtered + weight * (y_filtered * y_filtered + rate_filtered * rate_filtered)
    gradient = p[ESTIMATOR_GAIN] * error / den
    gain = s[THETA] - p[TIME_STEP] * gradient * u_filtered
    floor = p[FLOOR] * abs(p[PLANT_GAIN])
    s[THETA] = p[SIGN] * min(max(p[SIGN] * gain, floor), HUGE)
    spring = s[THETA + 1] + p[TIME_STEP] * gradient * weight * y_filtered
    damping = s[THETA + 2] + p[TIME_STEP] * gradient * weight * rate_filtered
    s[THETA + 1] = min(max(spring, -HUGE), HUGE)
    s[THETA + 2] = min(max(damping, -HUGE), HUGE)

    v = velocity(p, MOVING, s, MOTION, w[io[VELOCITY]], y, u, middle, end) / p[RATE]
    w[io[OWN_VOLTAGE]] = slide(
        p, s, PEAK, w, io, TAPS, y, v, s[THETA + 2], s[THETA + 1], s[THETA], error, p[ON_ESTIMATE] != 0.0
    )

    a1, a2, true_gain = true_plant(w, io, FIRST_TRUTH, p[PLANT_A1], p[PLANT_A2], p[PLANT_GAIN])
    estimate, truth = io[ESTIMATES], io[ESTIMATES + 1]
    w[truth], w[truth + 1], w[truth + 2] = true_gain, a2, a1
    missing = s[THETA] - true_gain
    lyapunov = missing * missing
    for i in range(3):
        w[estimate + i] = s[THETA + i]
        if i > 0:
            missing = s[THETA + i] - w[truth + i]
            lyapunov += missing * missing / weight
    w[io[ESTIMATES + 2]] = error
    w[io[ESTIMATES + 3]] = lyapunov / p[ESTIMATOR_GAIN]
    w[io[ESTIMATES + 4]] = -2.0 * error * error / den


class Stvsc(Block):
    r"""Self-tuning variable structure control, :math:`u=u_{eq}+\rho M\,\mathrm{sat}(s/\Phi)`.

    A normalised gradient estimator follows mass, damping and spring; the sliding law is computed from what it knows.
    It estimates all the time on the voltage applied, so a switch finds it tuned.
    """

    title = "Self-tuning VSC"
    inputs = (*SLIDING_INPUTS, *TRUTH)
    outputs = (OUTPUT,)
    taps = (
        *SLIDING_TAPS,
        Port("parameter", "mixed", "estimates of kp, a2 and a1, time in 1/w0", labels=LABELS),
        Port("parameter_true", "mixed", "what they should be", labels=LABELS),
        Port("prediction_error", "um", "estimated minus measured displacement"),
        Port("lyapunov", "1", "Lyapunov function V of the estimator"),
        Port("lyapunov_rate", "1", "its derivative by theory, per 1/w0"),
    )
    equations = (
        Equation(
            "law",
            r"u=u_{eq}+\rho M\,\mathrm{sat}(s/\Phi),\quad u_{eq}=K_e^Te+K_p^Tx_p+K_mr,\quad M=\sum|\cdot|",
            "3.2.4.2.1",
            printed=r"U_P=|K_py_P|+K_e|y_M-y_P|+|K_MU_M|\,\mathrm{sgn}(s)",
            why="products are taken component by component with absolute values, and the equivalent control is added: "
            "switching alone must be as large as the whole voltage",
        ),
        Equation(
            "surface",
            SURFACE_EQUATION.latex,
            SURFACE_EQUATION.source,
            printed=r"s=Ge_1",
            why="e_1 is the error of the estimate: at rest it is zero whatever the model does, and so is the voltage. "
            "The surface needs the tracking error",
        ),
        GAINS_EQUATION,
        Equation(
            "estimator",
            r"\dot{\hat\theta}=-g\Gamma\frac{w\,e_1}{1+w^T\Gamma w},\quad e_1=\hat y-y,\quad "
            r"\dot V=-\frac{2e_1^2}{1+w^T\Gamma w}\le0",
            "3.2.3.8, 3.2.5.1.4",
            printed=r"\hat\theta=-P_0we_1",
            why="the dot is lost, and without the normaliser the law runs away for 0.3 and more; V falls only as far "
            "as the input excites",
        ),
        LAYER_EQUATION,
    )

    class Params(SlidingParams):
        """Sliding law and estimator, in um, V and 1/w0."""

        estimator_gain: float = parameter(1.0, "gain g of the estimator", equation="3.2.5.1.4", gt=0, le=10)
        filter_pole: float = parameter(
            1.0, "double pole of the filters over w0", equation="3.2.3.3", gt=0.05, le=10, live=False
        )
        output_weight: float | None = parameter(
            None, "weight of y and its derivative; 1/kp^2 unless given, so that y counts in volts", "V^2/um^2", gt=0
        )
        normalise: bool = parameter(True, "divide by 1 + w'Gw; off as printed", equation="3.2.5.1.4")
        gain_floor: float = parameter(0.1, "least share of the nominal gain the estimate may fall to", gt=0, le=1)
        surface: Literal["tracking", "estimation"] = parameter(
            "tracking",
            "error the surface is made of; the printed one is the error of the estimate",
            equation="3.2.4.1.1",
        )

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants and models that are not of second order."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        shared = pack_sliding(params, context)
        weight = 1.0 / shared[PLANT_GAIN] ** 2 if params.output_weight is None else params.output_weight
        return np.array(
            [
                *shared,
                *pack_velocity(params.velocity, context, shared[RATE]),
                *driven_filter(params.filter_pole, shared[TIME_STEP], context.analogue),
                params.estimator_gain,
                weight,
                params.filter_pole,
                params.gain_floor,
                float(params.surface == "estimation"),
                float(params.normalise),
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Estimates of the nominal device, everything else at rest."""
        shared = pack_sliding(params, context)
        start = np.zeros(SIZE)
        start[THETA : THETA + 3] = shared[PLANT_GAIN], shared[PLANT_A2], shared[PLANT_A1]
        return start

    step = stvsc_step
