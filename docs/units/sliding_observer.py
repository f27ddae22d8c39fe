r"""State feedback of the velocity that a super-twisting observer estimates."""

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Oscillator, parameter
from core.control.controller import ControllerPorts, unsuited_second_order
from core.ports import reads, tap
from core.record import Record


class SlidingObserver(Block):
    r"""Feedback of displacement and velocity, the velocity from a super-twisting observer.

    Displacement and velocity are exact after a finite time while the acceleration that the nominal device does not
    explain stays below :math:`\Delta` (Davila, Fridman and Levant 2005); sampled, they are wrong by
    :math:`O(\Delta h^2)` and :math:`O(\Delta h)` (Levant 1998).
    """

    title = "Sliding observer"
    equations = (
        Equation("displacement", r"\dot{\hat y}=\hat v+1.5\sqrt{\Delta}\,|e|^{1/2}\,\mathrm{sgn}\,e,\quad e=y-\hat y"),
        Equation("velocity", r"\dot{\hat v}=(Fu-\beta\hat v-ky)/m+1.1\Delta\,\mathrm{sgn}\,e", "Levant 1998"),
        Equation("law", r"u=r+K_p(y_m-y)+K_d(v_m-\hat v)"),
    )
    weaknesses = ("noise of the sensor reaches the velocity as the root of its size times the bound",)

    class Params(BlockParams):
        """Bound of the forces outside the nominal model, and the gains of the feedback."""

        bound_um_ms2: float = parameter(100.0, "bound of the unexplained acceleration", "um/ms^2", gt=1e-6, le=1e9)
        proportional_v_um: float = parameter(-10.0, "gain of the displacement", "V/um", ge=-1e3, le=1e3)
        derivative_v_ms_um: float = parameter(-1.0, "gain of the velocity", "V ms/um", ge=-1e3, le=1e3)

    class Packed(Record):
        """Gains, the acceleration by volt, velocity and displacement, and the sample interval."""

        proportional_v_um: float
        derivative_v_ms_um: float
        root: float
        switched: float
        of_voltage: float
        of_velocity: float
        of_displacement: float
        dt_ms: float

    class State(Record):
        """Estimated displacement and velocity, the last measurement, and whether there was one."""

        displacement: float
        velocity: float
        measured: float
        started: float

    class Ports(ControllerPorts):
        """The ports of every controller, the model's velocity, and the estimates."""

        model_velocity: float = reads("model.velocity", "um/ms", "velocity of the model")
        estimate: float = tap("um", "estimated displacement")
        velocity: float = tap("um/ms", "estimated velocity")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the acceleration of the nominal device, and the gains of the observer."""
        p = cls.Packed.blank()
        device = context.device
        p.root = 1.5 * math.sqrt(params.bound_um_ms2)
        p.switched = 1.1 * params.bound_um_ms2
        p.of_voltage = device.force / device.mass
        p.of_velocity = -device.damping / device.mass
        p.of_displacement = -device.stiffness / device.mass
        p.dt_ms = context.dt_ms
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance the observer over the sample that ends now by the error at its start, and feed back."""
        if s.started != 0.0:
            e = s.measured - s.displacement
            way = 1.0 if e > 0.0 else -1.0 if e < 0.0 else 0.0
            # velocity and force at the middle of the sample: the error of Euler's step there is of higher order
            nominal = (
                p.of_voltage * x.applied
                + p.of_velocity * s.velocity
                + 0.5 * p.of_displacement * (s.measured + x.measured)
            )
            rise = p.dt_ms * (nominal + p.switched * way)
            s.displacement += p.dt_ms * (s.velocity + 0.5 * rise + p.root * math.sqrt(abs(e)) * way)
            s.velocity += rise
        else:
            s.displacement = x.measured
        s.measured = x.measured
        s.started = 1.0
        x.estimate = s.displacement
        x.velocity = s.velocity
        x.voltage = (
            x.reference
            + p.proportional_v_um * (x.model - x.measured)
            + p.derivative_v_ms_um * (x.model_velocity - s.velocity)
        )
