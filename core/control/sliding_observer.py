"""State feedback of the velocity that a sliding-mode observer estimates."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import unsuited_second_order
from core.control.nominal import Following, FollowingPorts, followed, following
from core.kernel import flush_tiny
from core.ports import tap
from core.record import Record
from core.voltage import Motion, moves


class SlidingObserver(Block):
    r"""Super-twisting observer of the velocity, with state feedback (Davila, Fridman and Levant 2005).

    .. math:: \dot{\hat y}=\hat v+1.5\sqrt\Delta\,|e|^{1/2}\mathrm{sgn}\,e,\quad
        \dot{\hat v}=(Fu-\beta\hat v-ky)/m+1.1\Delta\,\mathrm{sgn}\,e,\quad e=y-\hat y

    Displacement and velocity are exact after a finite time while the acceleration that the nominal device does not
    explain is below :math:`\Delta`; sampled, they are wrong by :math:`O(\Delta h^2)` and :math:`O(\Delta h)` (Levant
    1998). Both poles of the tracking error are at :math:`\omega_c`.
    """

    title = "Sliding-mode observer"
    place = 7
    equations = (
        Equation("displacement", r"\dot{\hat y}=\hat v+1.5\sqrt\Delta\,|e|^{1/2}\mathrm{sgn}\,e,\quad e=y-\hat y"),
        Equation("velocity", r"\dot{\hat v}=(Fu-\beta\hat v-ky)/m+1.1\Delta\,\mathrm{sgn}\,e", "Levant 1998"),
        Equation("law", r"u=u_m+\tfrac1F\bigl[(m\omega_c^2-k)(y_m-y)+(2m\omega_c-\beta)(\dot y_m-\hat v)\bigr]"),
    )
    structure = (
        Stage("Observer", "applied measured", "estimate velocity", ("displacement", "velocity")),
        Stage("Law", "reference model model_velocity measured velocity", "voltage", ("law",)),
    )
    weaknesses = (
        "The velocity chatters by about the bound times the sample interval: at 100 kHz a bound for a spring 80 % "
        "stiffer, 600 um/ms^2, gives 6 um/ms.",
        "As a source of velocity for other laws it is no match for their linear observer. Without chatter, in the "
        "implicit sampled form, the velocity is still wrong by half a sample of the unexplained acceleration, whatever "
        "the bound: 1.2 um/ms rms at 100 kHz for a spring 80 % stiffer, where the linear observer has 0.2. A boundary "
        "layer of 4 bounds times the square of the sample interval makes it 1.4 times as wrong as the switching.",
        "Noise of the sensor reaches the velocity as the root of its size times the bound.",
        "It has no integral action: under a device that differs from the nominal device an error stays.",
    )

    class Params(BlockParams):
        """Bound of the forces outside the nominal model, and the bandwidth of the feedback."""

        bound_um_ms2: float = parameter(100.0, "bound of the unexplained acceleration", "um/ms^2", gt=1e-6, le=1e9)
        controller_bandwidth: float = parameter(2.0, "omega_c over w0", gt=0.05, le=20)

    class Packed(Record):
        """The voltage of the model's motion, volts per um and um/ms, and the observer.

        Of the observer: the sample interval, the acceleration by volt, velocity and displacement, the switched terms.
        """

        following: Following
        by_error: float
        by_velocity_error: float
        dt_ms: float
        of_voltage: float
        of_velocity: float
        of_displacement: float
        root: float
        switched: float

    class State(Record):
        """Whether there was a measurement, the last one, and the estimate."""

        started: float
        measured: float
        estimate: Motion

    class Ports(FollowingPorts):
        """Ports of a controller, the velocity of the model, and the estimates."""

        estimate: float = tap("um", "estimated displacement")
        velocity: float = tap("um/ms", "estimated velocity")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the observer and the law."""
        device, p = context.device, cls.Packed.zeros()
        p.dt_ms = context.dt_ms
        p.of_voltage, p.of_velocity = device.force / device.mass, -device.damping / device.mass
        p.of_displacement = -device.stiffness / device.mass
        p.root, p.switched = 1.5 * math.sqrt(params.bound_um_ms2), 1.1 * params.bound_um_ms2
        if device.force == 0.0:
            return p  # nothing moves this device
        p.following = following(device, context.model)
        bandwidth = params.controller_bandwidth * device.natural_frequency
        p.by_error = (device.mass * bandwidth * bandwidth - device.stiffness) / device.force
        p.by_velocity_error = (2.0 * device.mass * bandwidth - device.damping) / device.force
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance the observer over the sample that ends now by the error at its start, and feed back."""
        y = x.measured
        if not math.isfinite(y):  # no measurement: the estimate takes its place
            y = s.estimate.x + p.dt_ms * s.estimate.v
        if s.started != 0.0:
            e = s.measured - s.estimate.x
            way = 1.0 if e > 0.0 else -1.0 if e < 0.0 else 0.0
            u, middle, end = moves(x)
            mean = u + (4.0 * middle + end) / 6.0
            # velocity and force at the middle of the sample: the error of Euler's step there is of higher order
            nominal = p.of_voltage * mean + p.of_velocity * s.estimate.v + 0.5 * p.of_displacement * (s.measured + y)
            rise = p.dt_ms * (nominal + p.switched * way)
            s.estimate.x = flush_tiny(
                s.estimate.x + p.dt_ms * (s.estimate.v + 0.5 * rise + p.root * math.sqrt(abs(e)) * way)
            )
            s.estimate.v = flush_tiny(s.estimate.v + rise)
        else:
            s.estimate.x = y
        s.measured = y
        s.started = 1.0
        behind = p.by_error * (x.model - y) + p.by_velocity_error * (x.model_velocity - s.estimate.v)
        x.voltage = followed(p.following, x) + behind
        x.estimate = s.estimate.x
        x.velocity = s.estimate.v
