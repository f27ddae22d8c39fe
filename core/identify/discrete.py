r"""Identifiers of the sampled plant, :math:`z_{i+1}=h_i^T\theta,\;\theta=[b_0,b_1,a_1,a_2]` (5.3.3.1-4)."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Literal

from core import voltage
from core.block import Context, Oscillator, parameter
from core.device.oscillator import held
from core.elementary import atan2, log
from core.estimation import diagonal, trace_of, triangle
from core.identify.identifier import (
    EstimatePorts,
    Identifier,
    IdentifierParams,
    excite,
    show_truth,
    worst,
)
from core.kernel import kernel
from core.ports import tap
from core.record import Vector, vector
from core.voltage import Gathered, Interval, gather, interval_of, observed, weighed_voltages

N = 4
COEFFICIENTS = ("b0", "b1", "a1", "a2")


class DiscreteParams(IdentifierParams):
    """Parameters of every identifier of the sampled plant."""

    initial_covariance: float = parameter(1e8, "covariance at the start, as a multiple of I", gt=0, le=1e15)
    covariance_limit: float = parameter(1e10, "largest trace of the covariance, 0 for 1e10", ge=0, le=1e18)
    start: Literal["nominal", "zero"] = parameter("nominal", "estimate at the start", equation="5.3.3.8", live=False)
    least_excitation: float = parameter(
        1e-9, "least relative excitation that counts as identifiable", "1", equation="A.9.1", ge=0, le=1
    )


class Discrete(Identifier):
    """Base of the identifiers of the sampled plant."""

    class Packed(Identifier.Packed):
        """Whether it is enabled, the nominal device, covariance at the start and its limit, mean noise of h h'."""

        enabled: float
        mass: float
        damping: float
        stiffness: float
        force: float
        dt_ms: float
        initial_covariance: float
        covariance_limit: float
        noise: Vector = vector(triangle(N))
        interval: Interval

    class State(Identifier.State):
        """Samples so far, counted up to three, and the last ones; estimate and covariance; the truth and its scales."""

        samples: float
        last_y: float
        older_y: float
        later_u: float
        older_u: float
        was_enabled: float
        theta: Vector = vector(N)
        phi: Vector = vector(N)
        product: Vector = vector(N)
        covariance: Vector = vector(triangle(N))
        true: Vector = vector(N)
        mass_scale: float
        stiffness_scale: float
        damping_scale: float
        drive_gain: float
        gathered: Gathered

    class Ports(EstimatePorts):
        """Estimate and truth as coefficients of the sampled plant, and the trace of the covariance."""

        coefficient: Vector = tap("mixed", "estimated coefficients of the sampled plant", labels=COEFFICIENTS)
        coefficient_true: Vector = tap("mixed", "true coefficients of the sampled plant", labels=COEFFICIENTS)
        residual: float = tap("um", "measured minus predicted displacement")
        covariance_trace: float = tap("mixed", "trace of the covariance")

    @classmethod
    def fill_sampled(cls, p: Packed, params: Any, context: Context) -> None:
        """Pack the numbers that every identifier of the sampled plant needs."""
        device = context.device
        cls.fill_shared(p, params, context)
        p.mass, p.damping, p.stiffness, p.force = device.mass, device.damping, device.stiffness, device.force
        p.dt_ms = context.dt_ms
        p.noise[:] = diagonal(N, context.sensor_noise_um**2)
        p.noise[0] = p.noise[2] = 0.0  # the two voltages
        p.interval = interval_of(context)

    @classmethod
    def fill_start(cls, s: State, params: Any, context: Context) -> None:
        """Write the estimate and the covariance at the start."""
        s.covariance[:] = diagonal(N, params.initial_covariance)
        s.was_enabled = 1.0
        if params.start == "nominal":
            s.theta[:] = nominal(context.device, context.dt_ms)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        cls.fill_sampled(p, params, context)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Estimate and covariance at the start."""
        s = cls.State.zeros()
        cls.fill_start(s, params, context)
        return s

    @classmethod
    def caution(cls, params: Any, context: Context, hz: float) -> str:
        """Say how much of the response to a tone is lost if mass, stiffness or damping is larger by a tenth."""
        device = context.device
        parts = ("mass", "stiffness", "damping")
        tenth = {part: replace(device, **{part: 1.1 * getattr(device, part)}) for part in parts}
        return voltage.caution(context, {f"1.1 times the {part}": other for part, other in tenth.items()}, hz)


def nominal(device: Oscillator, dt_ms: float) -> tuple[float, float, float, float]:
    """Return b0, b1, a1 and a2 of a device whose voltage is held."""
    b0, b1, a1, a2 = sampled(device.mass, device.damping, device.stiffness, device.force, dt_ms)
    return float(b0), float(b1), float(a1), float(a2)


@kernel
def sampled(
    mass: float, damping: float, stiffness: float, force: float, dt: float
) -> tuple[float, float, float, float]:
    r"""Return :math:`b_0,b_1,a_1,a_2` of :math:`y_i=b_0u_{i-1}+b_1u_{i-2}-a_1y_{i-1}-a_2y_{i-2}`."""
    a, b, c, d, reach, push = held(mass, damping, stiffness, dt)
    return force * reach, force * (b * push - d * reach), -(a + d), a * d - b * c


@kernel
def gather_voltage(p: Discrete.Packed, s: Discrete.State, x: Discrete.Ports) -> None:
    """Add the voltage of a tick to the interval."""
    gather(p.interval, s.gathered, x.applied, x.middle, x.end)


@kernel
def observe(p: Discrete.Packed, s: Discrete.State, x: Discrete.Ports) -> tuple[bool, float]:
    """Form the regressor, and return whether there was a sample and its difference from the prediction."""
    y = observed(x)
    seen = math.isfinite(y)
    if not seen:
        y = s.last_y
    first = s.samples < 3.0
    s.samples = min(s.samples + 1.0, 3.0)
    s.older_u = s.later_u
    last_u, s.later_u = weighed_voltages(p.interval, s.gathered)
    s.phi[0] = last_u
    s.phi[1] = s.older_u
    s.phi[2] = -s.last_y
    s.phi[3] = -s.older_y
    s.older_y = s.last_y
    s.last_y = y
    e = y
    for i in range(N):
        e -= s.theta[i] * s.phi[i]
    if p.enabled != 0.0 and s.was_enabled == 0.0:
        restart(p, s)
    s.was_enabled = p.enabled
    return seen and not first and p.enabled != 0.0, e


@kernel
def restart(p: Discrete.Packed, s: Discrete.State) -> None:
    """Reset the covariance to that at the start."""
    for i in range(10):
        s.covariance[i] = 0.0
    for i in range(N):
        s.covariance[i * (i + 3) // 2] = p.initial_covariance


@kernel
def follow_truth(p: Discrete.Packed, s: Discrete.State, x: Discrete.Ports) -> None:
    """Compute the true coefficients anew when the device has changed."""
    mass, stiffness, damping, gain = x.mass_scale, x.stiffness_scale, x.damping_scale, x.drive_gain
    if mass != s.mass_scale or stiffness != s.stiffness_scale or damping != s.damping_scale or gain != s.drive_gain:
        s.mass_scale = mass
        s.stiffness_scale = stiffness
        s.damping_scale = damping
        s.drive_gain = gain
        s.true[0], s.true[1], s.true[2], s.true[3] = sampled(
            p.mass * mass, p.damping * damping, p.stiffness * stiffness, p.force * gain, p.dt_ms
        )


@kernel
def report(p: Discrete.Packed, s: Discrete.State, x: Discrete.Ports, residual: float) -> None:
    r"""Write estimate, truth, error and excitation.

    From the poles :math:`z=e^{(-\sigma\pm j\omega_d)h}` and the static gain g follow
    :math:`k=F/g,\;m=k/(\sigma^2+\omega_d^2),\;\beta=2\sigma m`. While the poles do not belong to a damped plant, the
    estimate keeps its last values.
    """
    show_truth(x)
    follow_truth(p, s, x)
    for i in range(N):
        x.coefficient[i] = s.theta[i]
        x.coefficient_true[i] = s.true[i]
    b0, b1, a1, a2 = s.theta[0], s.theta[1], s.theta[2], s.theta[3]
    whole = 1.0 + a1 + a2
    if 0.0 < a2 < 1.0 and whole > 0.0 and b0 + b1 != 0.0:
        sigma = -0.5 * log(a2) / p.dt_ms
        turn = -0.5 * a1 / math.sqrt(a2)
        if turn > -1.0:
            reach = math.sqrt(abs((1.0 - turn) * (1.0 + turn)))  # of the inverse cosine, or the hyperbolic one
            angle = (atan2(reach, turn) if turn <= 1.0 else log(turn + reach)) / p.dt_ms
            square = sigma * sigma + (angle * angle if turn <= 1.0 else -angle * angle)
            stiffness = p.force * whole / (b0 + b1)
            mass = stiffness / square
            x.estimate[0] = mass / p.mass
            x.estimate[1] = stiffness / p.stiffness
            x.estimate[2] = 2.0 * sigma * mass / p.damping
    x.residual = residual
    x.error_pct = worst(s.theta, x.coefficient_true, N)
    excite(p, p.noise, s.gram, s.phi, N, x)
    x.covariance_trace = trace_of(s.covariance, N)
