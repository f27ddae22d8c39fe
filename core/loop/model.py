"""Reference model: where the shuttle should be."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal, Self

from pydantic import Field, model_validator

from core.block import Block, BlockParams, Context, Equation, Oscillator, parameter
from core.device.oscillator import held, parabola, transition
from core.device.ranges import Sized
from core.device.transfer_function import of_coefficients
from core.errors import InputError
from core.kernel import flush_tiny
from core.ports import BlockPorts, output, reads, tap
from core.record import Record


class Model(Block):
    r"""Reference model, :math:`\ddot y_m+a_{m1}\dot y_m+a_{m2}y_m=k_mr`.

    Or any :math:`\frac{b_1s+b_0}{a_2s^2+a_1s+a_0}` in the unit of time of a plant given as a transfer function
    (:math:`1/\omega_0` of a resonator). Exact for a held reference; an analogue one is a parabola over each sample, as
    it is to the plant.
    """

    title = "Reference model"
    equations = (
        Equation("model", r"\ddot y_m+a_{m1}\dot y_m+a_{m2}y_m=k_mr", "3.1.2.4"),
        Equation("transfer function", r"y_m=\frac{b_1s+b_0}{a_2s^2+a_1s+a_0}\,r", "4.3.1.2"),
    )

    class Params(BlockParams):
        """Which model."""

        kind: Literal["copy", "damped", "direct", "transfer_function"] = parameter(
            "copy",
            "the nominal device, a damped device of the same resonance, just the static displacement, or a "
            "transfer function",
            live=False,
        )
        numerator: list[Sized] = Field(
            [1.0],
            min_length=1,
            max_length=2,
            description="coefficients of the numerator, highest power first",
            json_schema_extra={"unit": "", "live": False, "equation": "4.3.1.2"},
        )
        denominator: list[Sized] = Field(
            [1.0, 1.0],
            min_length=2,
            max_length=3,
            description="coefficients of the denominator, highest power first",
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

    class Packed(Record):
        """Transition, effects of the reference on state and output, and of its change within a sample."""

        phi11: float
        phi12: float
        phi21: float
        phi22: float
        static_gain: float
        direct: float
        reach: float
        push: float
        zeroth: float
        first: float
        slope_x: float
        slope_v: float
        slope_reference: float
        dt_ms: float
        rise_x: float
        rise_v: float
        bend_x: float
        bend_v: float

    class State(Record):
        """Displacement, velocity, reference over the sample that begins, whether it has run."""

        x: float
        v: float
        start: float
        middle: float
        end: float
        started: float

    class Ports(BlockPorts):
        """Reference in, displacement and velocity of the model out."""

        reference: float = reads("reference.voltage", "V", "reference voltage")
        middle: float = reads("reference.middle", "V", "reference half a sample later")
        end: float = reads("reference.end", "V", "reference one sample later")
        actual: float = reads("plant.displacement", "um", "true displacement")
        displacement: float = output("um", "where the shuttle should be")
        velocity: float = tap("um/ms", "how fast it should move")
        tracking_error: float = tap("um", "true minus model displacement")

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
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        model = context.model
        p = cls.Packed.zeros()
        p.dt_ms, p.direct = context.dt_ms, params.kind == "direct"
        resonator = params.kind != "transfer_function" and context.device.time_unit_ms == 0.0
        if resonator or params.kind == "direct":
            p.phi11, p.phi12, p.phi21, p.phi22 = transition(model.mass, model.damping, model.stiffness, context.dt_ms)
            p.static_gain, p.zeroth, p.slope_v = model.static_gain, 1.0, 1.0
            gain = model.force
        else:
            p.phi11, p.phi12, p.phi21, p.phi22, reach, push = held(
                model.mass, model.damping, model.stiffness, context.dt_ms
            )
            gain, unit = model.force, 1.0 / context.device.natural_frequency
            first, p.zeroth = 0.0, 1.0
            if params.kind == "transfer_function":
                # the zero acts on the output: the state belongs to a unit numerator
                gain = 1.0
                first, p.zeroth = [0.0, 0.0, *params.numerator][-2:]
            p.first, p.reach, p.push = first * unit, gain * reach, gain * push
            if model.mass == 0.0:
                p.slope_x = -p.zeroth * model.stiffness / model.damping
                p.slope_reference = p.zeroth * gain / model.damping
            else:
                inverse = 1.0 / model.mass
                p.slope_x = -p.first * model.stiffness * inverse
                p.slope_v = p.zeroth - p.first * model.damping * inverse
                p.slope_reference = p.first * gain * inverse
        if context.analogue:
            within = parabola(model.mass, model.damping, model.stiffness, context.dt_ms, gain)
            p.rise_x, p.rise_v, p.bend_x, p.bend_v = within
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance the model over the interval that ends now."""
        if p.direct != 0.0:
            before = x.displacement
            x.displacement = p.static_gain * x.reference
            x.velocity = (x.displacement - before) / p.dt_ms if s.started != 0.0 else 0.0
            s.started = 1.0
        else:
            if s.started != 0.0:
                # an analogue reference is a parabola through the start, middle and end of the interval
                half = s.middle - s.start
                whole = s.end - s.start
                rise = (4.0 * half - whole) / p.dt_ms
                bend = 4.0 * (whole - 2.0 * half) / (p.dt_ms * p.dt_ms)
                rest = p.static_gain * s.start
                from_rest = s.x - rest
                v = s.v
                gained_x = p.rise_x * rise + p.bend_x * bend
                gained_v = p.rise_v * rise + p.bend_v * bend
                s.x = flush_tiny(p.phi11 * from_rest + p.phi12 * v + rest + p.reach * s.start + gained_x)
                s.v = flush_tiny(p.phi21 * from_rest + p.phi22 * v + p.push * s.start + gained_v)
            s.started = 1.0
            s.start = x.reference
            s.middle = x.middle
            s.end = x.end
            x.displacement = p.zeroth * s.x + p.first * s.v
            x.velocity = p.slope_x * s.x + p.slope_v * s.v + p.slope_reference * s.start
        x.tracking_error = x.actual - x.displacement
