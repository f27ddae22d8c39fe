"""PID with filtered derivative and conditional integration."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.control.controller import (
    APPLIED,
    ENGAGED,
    FIRST_ORDER,
    INPUTS,
    MEASURED,
    MODEL,
    OUTPUT,
    REFERENCE,
    VOLTAGE,
    normalised,
)

DT, KP, KI, KD, DECAY, FEED, LIMIT = range(7)
INTEGRAL, DERIVATIVE, LAST_ERROR, STARTED = range(4)
ERROR_TAP, INTEGRAL_TAP = VOLTAGE + 1, VOLTAGE + 2


def pid_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Compute one sample of the law; a PID that does not drive keeps its integral ready to take over."""
    e = w[io[MODEL]] - w[io[MEASURED]]
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        s[LAST_ERROR] = e
    s[DERIVATIVE] = settled(p[DECAY] * s[DERIVATIVE] + (1.0 - p[DECAY]) * (e - s[LAST_ERROR]) / p[DT])
    s[LAST_ERROR] = e
    rest = p[FEED] * w[io[REFERENCE]] + p[KP] * e + p[KD] * s[DERIVATIVE]
    if w[io[ENGAGED]] == 0.0:
        s[INTEGRAL] = w[io[APPLIED]] - rest
    else:
        more = p[KI] * e * p[DT]
        u = rest + s[INTEGRAL] + more
        # integrate only where that does not push further into the limit
        if abs(u) <= p[LIMIT] or u * more < 0.0:
            s[INTEGRAL] += more
    w[io[VOLTAGE]] = rest + s[INTEGRAL]
    w[io[ERROR_TAP]] = e
    w[io[INTEGRAL_TAP]] = s[INTEGRAL]


class Pid(Block):
    r"""PID on the tracking error, :math:`u=k_fr+K_pe+K_i\int e\,dt+K_d\dot e_f`, :math:`e=y_d-y`.

    Gains left empty place a triple pole at ``pole`` times the resonance:
    :math:`K_p=(3p^2-a_2)/k_p,\;K_i=p^3/k_p,\;K_d=(3p-a_1)/k_p` in normalised time. Gains are magnitudes;
    the sign of the device's gain (negative for the push-pull comb) is put in here.
    """

    title = "PID"
    inputs = INPUTS
    outputs = (OUTPUT,)
    taps = (
        Port("error", "um", "model minus measured displacement"),
        Port("integral", "V", "integral part"),
    )
    equations = (
        Equation("law", r"u=k_fr+K_pe+K_i\int e\,dt+K_d\dot e_f,\quad e=y_d-y"),
        Equation("pole placement", r"K_p=\frac{3p^2-a_2}{k_p},\;K_i=\frac{p^3}{k_p},\;K_d=\frac{3p-a_1}{k_p}"),
    )

    class Params(BlockParams):
        """Gains, or the pole they are computed from."""

        pole: float = parameter(1.3, "triple pole over the resonance, for gains left empty", gt=0.6, le=5)
        proportional_v_um: float | None = parameter(None, "proportional gain", "V/um", ge=0)
        integral_v_um_ms: float | None = parameter(None, "integral gain", "V/(um ms)", ge=0)
        derivative_v_ms_um: float | None = parameter(None, "derivative gain", "V ms/um", ge=0)
        derivative_filter: float = parameter(0.2, "time constant of the derivative filter over 1/w0", gt=0, le=10)
        feedforward: float = parameter(0.0, "share of the reference voltage added", ge=-2, le=2)

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants of first order."""
        return FIRST_ORDER if device.mass == 0.0 else ""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        w0 = context.device.natural_frequency
        a1, a2, gain = normalised(context.device, w0)
        gain = gain or 1.0  # identical stators: nothing can be controlled, but the law stays finite
        sign, size = math.copysign(1.0, gain), abs(gain)
        pole = params.pole
        placed = ((3 * pole**2 - a2) / size, pole**3 / size * w0, (3 * pole - a1) / size / w0)
        given = (params.proportional_v_um, params.integral_v_um_ms, params.derivative_v_ms_um)
        gains = [sign * (auto if own is None else own) for own, auto in zip(given, placed, strict=True)]
        decay = math.exp(-context.dt_ms * w0 / params.derivative_filter)
        return np.array([context.dt_ms, *gains, decay, params.feedforward, context.limit_v])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Integral, filtered derivative, last error, whether it has run."""
        return np.zeros(4)

    step = pid_step
