"""Active disturbance rejection: an observer estimates the unexplained acceleration, and the law cancels it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

from core.block import Block, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import unsuited_second_order
from core.control.nominal import Following, FollowingPorts, KnownParams, followed, following, known
from core.control.observer import Observed, StateObserver, observe, observer_of
from core.ports import tap
from core.record import Record
from core.voltage import moves


class Adrc(Block):
    r"""Linear active disturbance rejection (Han 2009; Gao 2003), with an extended state observer.

    .. math:: m\ddot y=Fu-\beta\dot y-ky+mf,\qquad u=\frac{m}{F}\bigl[\ddot y_m+2\omega_c(\dot y_m-\hat v)
        +\omega_c^2(y_m-\hat y)-\hat f\bigr]+\frac{\beta\hat v+k\hat y}{F}

    The observer follows displacement, velocity and f, the acceleration that its model does not explain. All three poles
    of its error are at :math:`\omega_o`, both poles of the tracking error at :math:`\omega_c`. With ``integrators`` the
    model has no damping and no spring, as in the original, and f holds them too.
    """

    title = "Active disturbance rejection (ADRC)"
    place = 4
    equations = (
        Equation("law", r"u=\tfrac mF[\ddot y_m+2\omega_c(\dot y_m-\hat v)+\omega_c^2(y_m-\hat y)-\hat f]+\dots"),
        Equation("observer", r"\hat x=\bar x+L(y-C\bar x),\quad \det(zI-\Phi+L C\Phi)=(z-e^{-\omega_oh})^3"),
    )
    structure = (
        Stage("Extended state observer", "applied measured", "estimate velocity disturbance", ("observer",)),
        Stage("Law", "reference model model_velocity estimate velocity disturbance", "voltage", ("law",)),
    )
    weaknesses = (
        "The estimate of the disturbance lags by about 3/omega_o: a device 30 % stiffer than nominal leaves an error "
        "under a tone near resonance.",
        "A fast observer passes the noise of the sensor on to the drive.",
    )

    class Params(KnownParams):
        """The assumed device, bandwidths over the resonance, and the model of the observer."""

        controller_bandwidth: float = parameter(1.0, "omega_c over w0", gt=0.05, le=20)
        observer_bandwidth: float = parameter(5.0, "omega_o over w0", gt=0.05, le=100)
        plant: Literal["nominal", "integrators"] = parameter(
            "nominal", "model of the observer: the nominal device, or a mass without damping and spring", live=False
        )

    class Packed(Record):
        """The observer, the voltage of the model's motion, and volts per um, um/ms and um/ms^2 of the estimates."""

        observer: StateObserver
        following: Following
        by_error: float
        by_velocity_error: float
        by_displacement: float
        by_velocity: float
        by_disturbance: float

    class State(Record):
        """The observer."""

        observed: Observed

    class Ports(FollowingPorts):
        """Ports of a controller, the velocity of the model, and the estimates."""

        estimate: float = tap("um", "estimated displacement")
        velocity: float = tap("um/ms", "estimated velocity")
        disturbance: float = tap("um/ms^2", "estimated acceleration that the model does not explain")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the observer and the law."""
        rate, device = context.device.natural_frequency, known(params, context)
        model = device if params.plant == "nominal" else replace(device, damping=0.0, stiffness=0.0)
        p = cls.Packed.zeros()
        p.observer = observer_of(model, context, params.observer_bandwidth * rate)
        if device.force == 0.0:
            return p  # nothing moves this device
        p.following = following(model, context.model)
        bandwidth, of_acceleration = params.controller_bandwidth * rate, device.mass / device.force
        p.by_disturbance = of_acceleration
        p.by_error, p.by_velocity_error = bandwidth * bandwidth * of_acceleration, 2.0 * bandwidth * of_acceleration
        # the model's motion is in `following`: only its difference from the estimate is left
        p.by_displacement, p.by_velocity = model.stiffness / device.force, model.damping / device.force
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Observe, move as the model, correct, and cancel the disturbance."""
        u, middle, end = moves(x)
        observe(p.observer, s.observed, x.measured, u, middle, end)
        estimate = s.observed.motion.x
        velocity = s.observed.motion.v
        error = x.model - estimate
        velocity_error = x.model_velocity - velocity
        wanted = followed(p.following, x)
        wanted += (p.by_error - p.by_displacement) * error + (p.by_velocity_error - p.by_velocity) * velocity_error
        x.voltage = wanted - p.by_disturbance * s.observed.acceleration
        x.estimate = estimate
        x.velocity = velocity
        x.disturbance = s.observed.acceleration
