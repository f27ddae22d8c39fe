"""PID with filtered derivative and conditional integration."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import FIRST_ORDER, ControllerPorts, normalised
from core.elementary import exp
from core.kernel import flush_tiny
from core.ports import tap
from core.record import Record


class Pid(Block):
    r"""PID on the tracking error, :math:`u=k_fr+K_pe+K_i\int e\,dt+K_d\dot e_f`, :math:`e=y_d-y`.

    Gains left empty place a triple pole at ``pole`` times the resonance:
    :math:`K_p=(3p^2-a_2)/k_p,\;K_i=p^3/k_p,\;K_d=(3p-a_1)/k_p` in normalised time. Gains are magnitudes;
    the sign of the device's gain (negative for the push-pull comb) is put in here.
    """

    title = "PID"
    place = 2
    equations = (
        Equation("law", r"u=k_fr+K_pe+K_i\int e\,dt+K_d\dot e_f,\quad e=y_d-y"),
        Equation("pole placement", r"K_p=\frac{3p^2-a_2}{k_p},\;K_i=\frac{p^3}{k_p},\;K_d=\frac{3p-a_1}{k_p}"),
    )
    structure = (
        Stage("Error", "model measured", "error"),
        Stage("Integral", "error", "integral"),
        Stage("Filtered derivative", "error", "derivative"),
        Stage("Law", "reference error integral derivative", "voltage", ("law", "pole placement")),
    )

    class Params(BlockParams):
        """Gains, or the pole they are computed from."""

        pole: float = parameter(1.3, "triple pole over the resonance, for gains left empty", gt=0.6, le=5)
        proportional_v_um: float | None = parameter(None, "proportional gain", "V/um", ge=0)
        integral_v_um_ms: float | None = parameter(None, "integral gain", "V/(um ms)", ge=0)
        derivative_v_ms_um: float | None = parameter(None, "derivative gain", "V ms/um", ge=0)
        derivative_filter: float = parameter(0.2, "time constant of the derivative filter over 1/w0", gt=0, le=10)
        feedforward: float = parameter(0.0, "share of the reference voltage added", ge=-2, le=2)

    class Packed(Record):
        """Sample interval, gains, share of the derivative kept from sample to sample, limit of the drive."""

        dt_ms: float
        kp: float
        ki: float
        kd: float
        decay: float
        feedforward: float
        limit_v: float

    class State(Record):
        """Integral, filtered derivative, last error, whether it has run."""

        integral: float
        derivative: float
        last_error: float
        started: float

    class Ports(ControllerPorts):
        """Ports of a controller, its error and its integral."""

        error: float = tap("um", "model minus measured displacement")
        integral: float = tap("V", "integral part")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants of first order."""
        return FIRST_ORDER if device.mass == 0.0 else ""

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        w0 = context.device.natural_frequency
        a1, a2, gain = normalised(context.device, w0)
        gain = gain or 1.0  # identical stators: nothing can be controlled, but the law stays finite
        sign, size = math.copysign(1.0, gain), abs(gain)
        pole = params.pole
        placed = ((3 * pole**2 - a2) / size, pole**3 / size * w0, (3 * pole - a1) / size / w0)
        given = (params.proportional_v_um, params.integral_v_um_ms, params.derivative_v_ms_um)
        gains = [sign * (auto if gain is None else gain) for gain, auto in zip(given, placed, strict=True)]
        p = cls.Packed.blank()
        p.kp, p.ki, p.kd = gains
        p.dt_ms = context.dt_ms
        p.decay = exp(-context.dt_ms * w0 / params.derivative_filter)
        p.limit_v = context.limit_v
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Compute one sample of the law; a PID that does not drive keeps its integral ready to take over."""
        e = x.model - x.measured
        if s.started == 0.0:
            s.started = 1.0
            s.last_error = e
        s.derivative = flush_tiny(p.decay * s.derivative + (1.0 - p.decay) * (e - s.last_error) / p.dt_ms)
        s.last_error = e
        rest = p.feedforward * x.reference + p.kp * e + p.kd * s.derivative
        if x.engaged == 0.0:
            s.integral = x.applied - rest
        else:
            increment = p.ki * e * p.dt_ms
            u = rest + s.integral + increment
            # integrate only if that does not push the voltage further into its limit
            if abs(u) <= p.limit_v or u * increment < 0.0:
                s.integral += increment
        x.voltage = rest + s.integral
        x.error = e
        x.integral = s.integral
