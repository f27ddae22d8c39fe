"""The early rules that adapt one gain: MIT, Lyapunov, Dressler, Price, Monopoli."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.control.controller import INPUTS, MEASURED, MODEL, OUTPUT, REFERENCE
from core.theory.gain_adaptation import LYAPUNOV, MIT, MONOPOLI, PARKS, PRICE, RULES

RULE, H, RATE, ERROR_WEIGHT, PROPORTIONAL, FILTER_TIME, DECAY, IDEAL, ALGEBRAIC = range(9)
INTEGRAL, LAST_ERROR, LAST_REFERENCE, FILTERED, STARTED = range(5)
STIFFNESS_SCALE, DRIVE_GAIN, OWN_VOLTAGE, GAIN, GAIN_IDEAL, ERROR = range(len(INPUTS), len(INPUTS) + 6)


def gain_adaptation_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Compare, adapt the gain, scale the reference."""
    r, ym = w[io[REFERENCE]], w[io[MODEL]]
    e = settled(ym - w[io[MEASURED]])
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        s[LAST_ERROR] = e
    else:
        # y' = (r - y)/q with the reference held
        s[FILTERED] = settled(p[DECAY] * s[FILTERED] + (1.0 - p[DECAY]) * s[LAST_REFERENCE])
    rule = p[RULE]
    slope = p[RATE] * e * r
    if rule == MIT:
        slope = p[RATE] * e * ym
    elif rule == MONOPOLI:
        slope = p[RATE] * e * s[FILTERED]
    elif rule == PARKS or rule == LYAPUNOV:
        # the integral of e' r over a sample with r held needs no derivative
        s[INTEGRAL] += p[RATE] * (e - s[LAST_ERROR]) * s[LAST_REFERENCE]
        slope = p[RATE] * p[ERROR_WEIGHT] * e * r if rule == LYAPUNOV else 0.0
    s[INTEGRAL] += p[H] * slope
    gain = s[INTEGRAL]
    if rule == PRICE:
        gain += p[PROPORTIONAL] * slope
    if p[ALGEBRAIC] != 0.0:
        gain = slope
    u = gain * r
    if rule == MONOPOLI:
        u += p[FILTER_TIME] * slope * s[FILTERED]
    s[LAST_ERROR], s[LAST_REFERENCE] = e, r
    w[io[OWN_VOLTAGE]] = u
    w[io[GAIN]] = gain
    w[io[GAIN_IDEAL]] = p[IDEAL] * w[io[STIFFNESS_SCALE]] / w[io[DRIVE_GAIN]]
    w[io[ERROR]] = e


class GainAdaptation(Block):
    r"""One gain in front of a plant of unknown gain, :math:`u=k_cr`, by the rules of appendix B.

    .. math:: \text{MIT: }\dot k_c=Bey_m;\quad\text{Lyapunov: }\dot k_c=B(\dot e+ce)r;\quad\text{Dressler: }\dot k_c=Ber

    .. math:: \text{Price: }k_c=\int Ber\,dt+\gamma Ber;\quad
        \text{Monopoli: }\dot k_c=Bey,\;y=\frac{r}{1+qs},\;u=k_cr+q\dot k_cy

    with :math:`e=y_m-y_p`. For a plant :math:`k_v/(b_2s^2+b_1s+1)` and a constant reference R the MIT rule and
    Dressler's are stable up to :math:`b_1/(b_2kk_vR^2)` and :math:`b_1/(b_2k_vR^2)`; Price's always for
    :math:`\gamma\ge b_2/b_1`, Monopoli's for :math:`q>b_2/b_1`, Lyapunov's for :math:`0<c<b_1/b_2`. Under a sine the
    first two have tongues of instability.
    """

    title = "Gain adaptation (appendix B)"
    inputs = (
        *INPUTS,
        Port(
            "stiffness_scale", "1", "true stiffness over nominal, for the ideal gain", source="effects.stiffness_scale"
        ),
        Port("drive_gain", "1", "voltage at the plant over voltage applied", source="effects.drive_gain"),
    )
    outputs = (OUTPUT,)
    taps = (
        Port("gain", "1", "adapted gain kc"),
        Port("gain_ideal", "1", "gain that would match the model"),
        Port("error", "um", "model minus measured displacement"),
    )
    equations = (
        Equation(
            "MIT rule",
            r"\dot k_c=-Be\frac{\partial e}{\partial k_c}\propto ey_m",
            "B.1.1",
            printed=r"k_c=-Be\frac{\partial e}{\partial k_c}",
            why="the dot is missing: a gain in proportion to the error leaves an error",
        ),
        Equation(
            "Lyapunov rule",
            r"\dot k_c=B(\dot e+ce)r,\quad0<c<b_1/b_2",
            "B.2.5-8",
            printed=r"\dot x=-k_v\dot k_c=\frac{-b_1er}{\lambda b_2}",
            why="B.2.5 has e^2 for e'^2, B.2.8 lacks a square and a b2, and they give e' for e; that rule alone "
            "stops at e = kR/(1 + kv B R^2), so a part c e is added",
        ),
        Equation("Dressler's rule", r"\dot k_c=Ber", "B.3.1"),
        Equation("Price's rule", r"\dot k_c=Ber+\gamma\frac{d}{dt}(Ber)", "B.4.1"),
        Equation(
            "Monopoli's rule",
            r"\dot k_c=Bey,\quad y=\frac{r}{1+qs},\quad u=k_cr+q\dot k_cy",
            "B.5.1",
            printed=r"\dot k_c=Bey+\gamma\frac{d}{dt}(Bey)",
            why="the part with gamma would need the slope of the slope in u, and is not needed for stability",
        ),
    )

    class Params(BlockParams):
        """Rule and gains, in um, V and the plant's unit of time."""

        rule: Literal["mit", "lyapunov", "dressler", "price", "monopoli"] = parameter("lyapunov", "which rule")
        form: Literal["corrected", "derived", "printed"] = parameter(
            "corrected",
            "corrected; as derived (Lyapunov: on the slope of the error alone); or as printed (MIT: without its dot, "
            "Lyapunov: on the error alone)",
        )
        adaptation_gain: float = parameter(0.4, "adaptation gain B", equation="B.1.1", gt=0, le=1e4)
        error_weight: float = parameter(0.5, "part c of the error in Lyapunov's rule", equation="B.2.8", ge=0, le=1e3)
        proportional: float = parameter(1.0, "gamma of Price's rule", equation="B.4.1", ge=0, le=1e3)
        filter_time: float = parameter(1.5, "time constant q of Monopoli's filter", equation="B.5.1", gt=0.001, le=1e3)
        initial_gain: float = parameter(0.0, "gain at the start", ge=-1e3, le=1e3, live=False)

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse what has no static gain to match, and resonators, whose gain is known."""
        if device.time_unit_ms == 0.0:
            return "is for the plants of appendix B; choose first-order-gain or second-order-gain"
        whole = min(device.stiffness, model.stiffness) > 0.0 and device.force != 0.0
        return "" if whole else "needs a plant and a model that come to rest"

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        h = context.dt_ms * context.device.natural_frequency
        rule = params.rule
        if rule == "lyapunov" and params.form != "corrected":
            rule = {"derived": "parks", "printed": "dressler"}[params.form]
        return np.array(
            [
                RULES[rule],
                h,
                params.adaptation_gain,
                params.error_weight,
                params.proportional,
                params.filter_time,
                math.exp(-h / params.filter_time),
                context.model.static_gain / context.device.static_gain,
                float(params.rule == "mit" and params.form == "printed"),
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Start with the gain given, and nothing seen."""
        return np.array([params.initial_gain, 0.0, 0.0, 0.0, 0.0])

    step = gain_adaptation_step
