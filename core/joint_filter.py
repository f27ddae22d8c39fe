r"""A Kalman filter of the motion, the spring and the damper of a device together, linearised about its own estimate.

The spring and the damper are factors :math:`\kappa,\delta` on the nominal device. Mass and force are taken as known.

.. math:: m\ddot x+\delta\beta\dot x+\kappa kx=Fu,\qquad
    \frac{\partial(x,\dot x)}{\partial\kappa}\approx
    -k\begin{bmatrix}\gamma_1(2x_0+x_1)/3\\\gamma_2(x_0+x_1)/2\end{bmatrix},\quad
    \frac{\partial(x,\dot x)}{\partial\delta}\approx
    -\beta\begin{bmatrix}\gamma_1(2\dot x_0+\dot x_1)/3\\\gamma_2(\dot x_0+\dot x_1)/2\end{bmatrix}

where :math:`\gamma` is the effect of a unit force that is held over the tick: a larger spring is a force
:math:`-kx`, and x is on a straight line between the ends of the tick.
"""

from __future__ import annotations

import math
from typing import Any

from core.block import BlockParams, Context, Equation, Stage, parameter
from core.device.oscillator import held, within
from core.kernel import flush_tiny, kernel
from core.ports import tap
from core.record import Choice, Record, Vector
from core.voltage import Motion, Moves, ObservedPorts, add_moves, moves, shuttle_memory

LEAST, MOST = 0.01, 100.0
"""Limits of both factors; an estimate outside makes no sense."""
EQUATIONS = (
    Equation(
        "prediction", r"z=(x,\dot x,\kappa,\delta):\quad z^-=f(z,u),\quad P^-=JPJ^T+W,\quad J=\partial f/\partial z"
    ),
    Equation("correction", r"r=y-x^-,\quad\psi=P^-_{11}+R,\quad K=P^-H^T/\psi,\quad z=z^-+Kr,\quad P=P^--K\psi K^T"),
)
FILTER = Stage(
    "Extended Kalman filter", "applied measured", "stiffness damping covariance residual", ("prediction", "correction")
)


class JointFilterParams(BlockParams):
    """Assumed noise and the uncertainty at the start."""

    stiffness_walk: float = parameter(0.01, "rms by which the spring may wander in 1 ms, over nominal", ge=0, le=10)
    damping_walk: float = parameter(0.03, "rms by which the damper may wander in 1 ms, over nominal", ge=0, le=10)
    process_noise_v: float = parameter(0.01, "assumed noise on the voltage, rms per tick", "V", ge=0, le=100)
    sensor_noise_um: float | None = parameter(
        None, "assumed sensor noise; the sensor's own unless given", "um", ge=1e-6, le=100
    )
    initial_stiffness_std: float = parameter(0.3, "uncertainty of the spring at the start, over nominal", gt=0, le=10)
    initial_damping_std: float = parameter(0.3, "uncertainty of the damper at the start, over nominal", gt=0, le=10)
    least_drive_v: float = parameter(
        0.01, "drive (rms over the shuttle's own memory) below which the factors stay as they are", "V", ge=0, le=100
    )
    initial_std_um: float = parameter(
        1.0, "uncertainty of the displacement at the start", "um", gt=0, le=100, live=False
    )


class PackedJointFilter(Moves):
    """The nominal device over a tick, ticks between two measurements, and variances.

    The variances: of the voltage, of a measurement, of the walk of both factors in a tick, and of both at the start.
    Then the share that the mean square of the drive keeps from tick to tick, and its lower limit.
    """

    every: Choice
    dt_ms: float
    mass: float
    damping: float
    stiffness: float
    force: float
    voltage_variance: float
    variance: float
    stiffness_variance: float
    damping_variance: float
    first_stiffness_variance: float
    first_damping_variance: float
    memory: float
    least_drive: float


class Covariance(Record):
    """Half of the covariance of displacement x, velocity v, spring k and damper b."""

    xx: float
    xv: float
    vv: float
    xk: float
    vk: float
    kk: float
    xb: float
    vb: float
    kb: float
    bb: float


class Joint(Record):
    """Whether it has run, the mean square of the drive, and the filter.

    The filter is the motion, both factors, their covariance, the residual, and its square over its variance.
    """

    started: float
    drive: float
    motion: Motion
    stiffness: float
    damping: float
    covariance: Covariance
    residual: float
    nis: float


class JointPorts(ObservedPorts):
    """Measurement and voltage; motion, deviations and innovation of the filter."""

    displacement: float = tap("um", "estimated displacement")
    velocity: float = tap("um/ms", "estimated velocity")
    deviation: Vector = tap("1", "standard deviation of the factors", labels=("stiffness", "damping"))
    innovation: float = tap("um", "measured minus predicted displacement")
    innovation_nis: float = tap("1", "its square over its variance, 1 on average for a true and well tuned filter")


def fill_joint(p: PackedJointFilter, params: Any, context: Context) -> None:
    """Pack the device and the assumptions."""
    device = context.device
    p.every, p.dt_ms = context.every, context.dt_ms / context.every
    p.mass, p.damping, p.stiffness, p.force = device.mass, device.damping, device.stiffness, device.force
    numbers = device.mass, device.damping, device.stiffness, p.dt_ms, device.force
    p.middle1, p.middle2, p.end1, p.end2 = within(*numbers) if context.analogue else (0.0, 0.0, 0.0, 0.0)
    noise_um = params.sensor_noise_um or context.assumed_noise_um
    p.voltage_variance, p.variance = params.process_noise_v**2, noise_um * noise_um
    p.stiffness_variance = params.stiffness_walk**2 * p.dt_ms
    p.damping_variance = params.damping_walk**2 * p.dt_ms
    p.first_stiffness_variance = params.initial_stiffness_std**2
    p.first_damping_variance = params.initial_damping_std**2
    p.memory, p.least_drive = shuttle_memory(device, p.dt_ms), params.least_drive_v**2


def fill_start(s: Joint, params: Any, context: Context) -> None:
    """Write the nominal device, which does not move, with the uncertainty of the parameters."""
    s.stiffness = s.damping = 1.0
    s.covariance.xx = params.initial_std_um**2
    s.covariance.vv = s.covariance.xx * context.device.natural_frequency**2
    s.covariance.kk = params.initial_stiffness_std**2
    s.covariance.bb = params.initial_damping_std**2


@kernel
def follow(p: PackedJointFilter, s: Joint, x: JointPorts) -> bool:
    """Predict over the tick that ends now; correct and return true if the block has its turn."""
    if s.started != 0.0:
        predict(p, s, x)
    s.started = 1.0
    is_turn = p.every == 1.0 or int(x.tick) % int(p.every) == 0
    if is_turn:
        correct(p, s, x.measured)
        x.displacement = s.motion.x
        x.velocity = s.motion.v
        x.deviation[0] = math.sqrt(max(s.covariance.kk, 0.0))
        x.deviation[1] = math.sqrt(max(s.covariance.bb, 0.0))
        x.innovation = s.residual
        x.innovation_nis = s.nis
    return bool(is_turn)


@kernel
def predict(p: PackedJointFilter, s: Joint, x: JointPorts) -> None:
    """Advance estimate and covariance over a tick.

    A factor wanders no further without drive, nor where its variance is the variance at the start.
    """
    f11, f12, f21, f22, reach, push = held(p.mass, p.damping * s.damping, p.stiffness * s.stiffness, p.dt_ms)
    u, middle, end = moves(x)
    s.drive = flush_tiny(p.memory * s.drive + (1.0 - p.memory) * u * u)
    x0 = s.motion.x
    v0 = s.motion.v
    s.motion.x = flush_tiny(f11 * x0 + f12 * v0 + p.force * reach * u)
    s.motion.v = flush_tiny(f21 * x0 + f22 * v0 + p.force * push * u)
    add_moves(p, s.motion, middle, end)
    k1 = -p.stiffness * reach * (2.0 * x0 + s.motion.x) / 3.0
    k2 = -p.stiffness * push * (x0 + s.motion.x) / 2.0
    b1 = -p.damping * reach * (2.0 * v0 + s.motion.v) / 3.0
    b2 = -p.damping * push * (v0 + s.motion.v) / 2.0
    c = s.covariance
    xx = f11 * c.xx + f12 * c.xv + k1 * c.xk + b1 * c.xb
    xv = f11 * c.xv + f12 * c.vv + k1 * c.vk + b1 * c.vb
    xk = f11 * c.xk + f12 * c.vk + k1 * c.kk + b1 * c.kb
    xb = f11 * c.xb + f12 * c.vb + k1 * c.kb + b1 * c.bb
    vx = f21 * c.xx + f22 * c.xv + k2 * c.xk + b2 * c.xb
    vv = f21 * c.xv + f22 * c.vv + k2 * c.vk + b2 * c.vb
    vk = f21 * c.xk + f22 * c.vk + k2 * c.kk + b2 * c.kb
    vb = f21 * c.xb + f22 * c.vb + k2 * c.kb + b2 * c.bb
    of_volt = p.voltage_variance * p.force * p.force
    c.xx = flush_tiny(xx * f11 + xv * f12 + xk * k1 + xb * b1 + of_volt * reach * reach)
    c.xv = flush_tiny(xx * f21 + xv * f22 + xk * k2 + xb * b2 + of_volt * reach * push)
    c.vv = flush_tiny(vx * f21 + vv * f22 + vk * k2 + vb * b2 + of_volt * push * push)
    c.xk = flush_tiny(xk)
    c.vk = flush_tiny(vk)
    c.xb = flush_tiny(xb)
    c.vb = flush_tiny(vb)
    is_driven = s.drive >= p.least_drive
    c.kk += p.stiffness_variance if is_driven and c.kk < p.first_stiffness_variance else 0.0
    c.bb += p.damping_variance if is_driven and c.bb < p.first_damping_variance else 0.0


@kernel
def correct(p: PackedJointFilter, s: Joint, measured: float) -> None:
    """Correct estimate and covariance by a measurement; without one they stay as they are.

    Without drive the gains of the factors are 0 (Schmidt 1966): noise that is taken for motion tells nothing of them.
    """
    residual = measured - s.motion.x
    if not math.isfinite(residual):
        return
    c = s.covariance
    psi = c.xx + p.variance
    learnt = 1.0 if s.drive >= p.least_drive else 0.0
    v = c.xv / psi
    k = learnt * c.xk / psi
    b = learnt * c.xb / psi
    s.residual = residual
    s.nis = residual * residual / psi
    s.motion.x = flush_tiny(s.motion.x + c.xx / psi * residual)
    s.motion.v = flush_tiny(s.motion.v + v * residual)
    s.stiffness = min(max(s.stiffness + k * residual, LEAST), MOST)
    s.damping = min(max(s.damping + b * residual, LEAST), MOST)
    c.vv -= v * c.xv
    c.vk -= v * c.xk
    c.vb -= v * c.xb
    c.kk -= k * c.xk
    c.kb -= k * c.xb
    c.bb -= b * c.xb
    kept = p.variance / psi
    c.xx *= kept
    c.xv *= kept
    c.xk *= kept
    c.xb *= kept
