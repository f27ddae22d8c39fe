"""Reference model: where the shuttle should be."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.device.oscillator import held, parabola, transition
from core.device.ranges import Sized
from core.device.transfer_function import of_coefficients
from core.errors import InputError

PHI11, PHI12, PHI21, PHI22, STATIC, DIRECT, REACH, PUSH, ZEROTH, FIRST, SLOPE_X, SLOPE_V, SLOPE_IN, DT = range(14)
RISE_X, RISE_V, BEND_X, BEND_V = range(14, 18)
X, V, START, MIDDLE, END, STARTED = range(6)
REFERENCE, HALFWAY, AFTERWARDS, DISPLACEMENT, VELOCITY = range(5)


def model_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance the model over the interval that ends now."""
    if p[DIRECT] != 0.0:
        before = w[io[DISPLACEMENT]]
        w[io[DISPLACEMENT]] = p[STATIC] * w[io[REFERENCE]]
        w[io[VELOCITY]] = (w[io[DISPLACEMENT]] - before) / p[DT] if s[STARTED] != 0.0 else 0.0
        s[STARTED] = 1.0
        return
    if s[STARTED] != 0.0:
        # an analogue reference is a parabola through the start, middle and end of the interval, a held one level
        half = s[MIDDLE] - s[START]
        whole = s[END] - s[START]
        rise = (4.0 * half - whole) / p[DT]
        bend = 4.0 * (whole - 2.0 * half) / (p[DT] * p[DT])
        rest = p[STATIC] * s[START]
        x = s[X] - rest
        v = s[V]
        more_x = p[RISE_X] * rise + p[BEND_X] * bend
        more_v = p[RISE_V] * rise + p[BEND_V] * bend
        s[X] = settled(p[PHI11] * x + p[PHI12] * v + rest + p[REACH] * s[START] + more_x)
        s[V] = settled(p[PHI21] * x + p[PHI22] * v + p[PUSH] * s[START] + more_v)
    s[STARTED] = 1.0
    s[START] = w[io[REFERENCE]]
    s[MIDDLE] = w[io[HALFWAY]]
    s[END] = w[io[AFTERWARDS]]
    w[io[DISPLACEMENT]] = p[ZEROTH] * s[X] + p[FIRST] * s[V]
    w[io[VELOCITY]] = p[SLOPE_X] * s[X] + p[SLOPE_V] * s[V] + p[SLOPE_IN] * s[START]


class Model(Block):
    r"""Reference model, :math:`\ddot y_m+a_{m1}\dot y_m+a_{m2}y_m=k_mr`.

    Or any :math:`\frac{b_1s+b_0}{a_2s^2+a_1s+a_0}` in the unit of time of a plant given as a transfer function
    (:math:`1/\omega_0` of a resonator). Exact for a held reference; an analogue one is a parabola over each sample, as
    it is to the plant.
    """

    title = "Reference model"
    inputs = (
        Port("reference", "V", "reference voltage", source="reference.voltage"),
        Port("middle", "V", "reference half a sample later", source="reference.middle"),
        Port("end", "V", "reference one sample later", source="reference.end"),
    )
    outputs = (Port("displacement", "um", "where the shuttle should be"),)
    taps = (Port("velocity", "um/ms", "how fast it should move"),)
    equations = (
        Equation("model", r"\ddot y_m+a_{m1}\dot y_m+a_{m2}y_m=k_mr", "3.1.2.4"),
        Equation("transfer function", r"y_m=\frac{b_1s+b_0}{a_2s^2+a_1s+a_0}\,r", "4.3.1.2"),
    )

    class Params(BlockParams):
        """Which model."""

        kind: Literal["copy", "damped", "direct", "transfer_function"] = parameter(
            "copy",
            "the nominal device, a damped one of the same resonance, just the displacement at rest, or a "
            "transfer function",
            live=False,
        )
        numerator: list[Sized] = Field(
            [1.0],
            min_length=1,
            max_length=2,
            description="of the transfer function, highest power first",
            json_schema_extra={"unit": "", "live": False, "equation": "4.3.1.2"},
        )
        denominator: list[Sized] = Field(
            [1.0, 1.0],
            min_length=2,
            max_length=3,
            description="of the transfer function, highest power first",
            json_schema_extra={"unit": "", "live": False, "equation": "4.3.1.2"},
        )
        damping_ratio: float = parameter(0.7, "damping ratio of the damped model", gt=0, le=10, live=False)

        @model_validator(mode="after")
        def _proper(self) -> Self:
            if self.denominator[0] <= 0.0:
                raise ValueError("the first coefficient of the denominator must be > 0")
            if len(self.numerator) >= len(self.denominator):
                raise ValueError("the numerator must be shorter than the denominator")
            return self

    @classmethod
    def oscillator(cls, params: Any, device: Oscillator) -> Oscillator:
        """Return the model that belongs to a device; a zero of its transfer function is left out.

        Raises
        ------
        InputError
            For a model this device cannot have.
        """
        if params.kind == "transfer_function":
            unit = 1.0 / device.natural_frequency
            given = of_coefficients(params.numerator[-1], params.denominator, unit)
            return replace(given, time_unit_ms=device.time_unit_ms)
        if params.kind == "copy":
            return device
        if device.mass <= 0.0 or device.stiffness <= 0.0:
            raise InputError(f"{params.kind} needs a device with mass and spring", "model.kind", "choose another")
        if params.kind == "direct":
            return device
        critical = 2.0 * (device.stiffness * device.mass) ** 0.5
        return Oscillator(device.mass, params.damping_ratio * critical, device.stiffness, device.force)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        model = context.model
        resonator = params.kind != "transfer_function" and context.device.time_unit_ms == 0.0
        if resonator or params.kind == "direct":
            phi = transition(model.mass, model.damping, model.stiffness, context.dt_ms)
            plain = (0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0)
            more = _parabola(model, model.force, context)
            return np.array([*phi, model.static_gain, float(params.kind == "direct"), *plain, context.dt_ms, *more])
        *free, reach, push = held(model.mass, model.damping, model.stiffness, context.dt_ms)
        gain, unit = model.force, 1.0 / context.device.natural_frequency
        first, zeroth = 0.0, 1.0
        if params.kind == "transfer_function":
            # the zero works on the output: the state is that of a unit numerator
            gain = 1.0
            first, zeroth = [0.0, 0.0, *params.numerator][-2:]
        first *= unit
        if model.mass == 0.0:
            slope = (-zeroth * model.stiffness / model.damping, 0.0, zeroth * gain / model.damping)
        else:
            inverse = 1.0 / model.mass
            slope = (
                -first * model.stiffness * inverse,
                zeroth - first * model.damping * inverse,
                first * gain * inverse,
            )
        more = _parabola(model, gain, context)
        return np.array([*free, 0.0, 0.0, gain * reach, gain * push, zeroth, first, *slope, context.dt_ms, *more])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Displacement, velocity, reference over the sample that begins, whether it has run."""
        return np.zeros(6)

    step = model_step


def _parabola(model: Oscillator, gain: float, context: Context) -> tuple[float, float, float, float]:
    """Return what displacement and velocity gain over a sample by the two derivatives of r; 0 when it is held."""
    if not context.analogue:
        return 0.0, 0.0, 0.0, 0.0
    return parabola(model.mass, model.damping, model.stiffness, context.dt_ms, gain)
