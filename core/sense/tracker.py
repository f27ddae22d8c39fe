r"""Kalman filter of a known shuttle under an unknown slow force: displacement, velocity, acceleration by that force.

.. math:: x_{i+1}=\Phi x_i+\Gamma u_i+\Gamma_f f_i,\qquad f_{i+1}=f_i+n_i

The device and the voltage are known; the random walk :math:`f` takes up the errors of the model. A voltage that moves
adds to :math:`\Gamma u_i` the effect of its difference from the start of the sample (`core.voltage`).
"""

from __future__ import annotations

import math
from dataclasses import replace

from core.block import Context, Equation, Oscillator, parameter
from core.device.oscillator import transition
from core.elementary import log
from core.kernel import flush_tiny, kernel
from core.record import Choice, Record
from core.sense.sensor import Sensor, SensorParams
from core.voltage import AppliedPorts, Gathered, Tick, gather, tick_of

MOTION = Equation("motion", r"\ddot x=\frac{F_e-\beta\dot x-kx}{m}+f,\quad \dot f=n")


class Tracked(Record):
    """A packed model over a sample: transition, effect of a volt and of a force, walk, ticks; and over one tick."""

    phi11: float
    phi12: float
    phi21: float
    phi22: float
    gamma1: float
    gamma2: float
    force1: float
    force2: float
    walk: float
    every: Choice
    tick: Tick


class Filter(Record):
    """State of a filter: displacement, velocity, acceleration by the force, and their covariance."""

    x: float
    v: float
    f: float
    p11: float
    p12: float
    p13: float
    p22: float
    p23: float
    p33: float


class TrackerParams(SensorParams):
    """Assumptions of a tracker about the shuttle."""

    stroke_um: float = parameter(4.0, "amplitude of the motion it is tuned for", "um", gt=0, le=100)
    stiffness: float = parameter(1.0, "stiffness it assumes over the nominal one", gt=0.01, le=100)
    model_error: float = parameter(
        0.1, "force the model may lack, over the spring force at that amplitude", ge=0.001, le=10
    )
    force_rate_per_ms: float = parameter(4.0, "how fast that force may wander", "1/ms", gt=0, le=1e4)


class Tracker(Sensor):
    """A sensor with a model of the shuttle."""

    every_tick = True

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices that the model of mass and spring does not describe."""
        return "" if device.mass > 0.0 and device.stiffness > 0.0 else "needs a device with mass and spring"


def model_of(params: TrackerParams, context: Context) -> Tracked:
    r"""Return the packed model; by default the walk has the variance :math:`4000\,s^{-1}(0.1\omega_0^2A)^2dt`."""
    device = context.device
    stiffness = device.stiffness * params.stiffness
    square = stiffness / device.mass
    volt = device.force / stiffness
    lacking = params.model_error * square * params.stroke_um
    model = Tracked.blank()
    model.phi11, model.phi12, model.phi21, model.phi22 = transition(
        device.mass, device.damping, stiffness, context.dt_ms
    )
    held1, held2 = 1.0 - model.phi11, -model.phi21
    model.gamma1, model.gamma2 = held1 * volt, held2 * volt
    model.force1, model.force2 = held1 / square, held2 / square
    model.walk = params.force_rate_per_ms * lacking * lacking * context.dt_ms
    model.every = context.every
    assumed = replace(device, stiffness=stiffness)
    model.tick = tick_of(assumed, device.force, context.dt_ms / context.every, context.analogue)
    return model


def put_at_rest(s: Filter, params: TrackerParams, context: Context) -> None:
    """Put a filter at zero, uncertain by 0.1 um, a tenth of the speed and the force of the model's errors."""
    square = context.device.stiffness / context.device.mass
    lacking = params.model_error * square * params.stroke_um
    speed = 0.1 * params.stroke_um * math.sqrt(square)
    s.x = s.v = s.f = 0.0
    s.p12 = s.p13 = s.p23 = 0.0
    s.p11, s.p22, s.p33 = 0.01, speed * speed, lacking * lacking


@kernel
def between_updates(p: Tracked, drive: Gathered, x: AppliedPorts) -> bool:
    """Gather the voltage of a tick; return whether a sensor that runs every N of them skips this one."""
    gather(p.tick, drive, x.applied, x.middle, x.end)
    return bool(p.every != 1.0 and int(x.tick) % int(p.every) != 0)


@kernel
def predict(p: Tracked, s: Filter, drive: Gathered) -> None:
    """Advance a filter by one sample, under the voltage gathered."""
    f11 = p.phi11
    f12 = p.phi12
    f21 = p.phi21
    f22 = p.phi22
    g1 = p.force1
    g2 = p.force2
    x = s.x
    v = s.v
    f = s.f
    u = drive.start
    s.x = flush_tiny(f11 * x + f12 * v + g1 * f + p.gamma1 * u + drive.gained1)
    s.v = flush_tiny(f21 * x + f22 * v + g2 * f + p.gamma2 * u + drive.gained2)
    c11 = s.p11
    c12 = s.p12
    c13 = s.p13
    c22 = s.p22
    c23 = s.p23
    c33 = s.p33
    a11 = f11 * c11 + f12 * c12 + g1 * c13
    a12 = f11 * c12 + f12 * c22 + g1 * c23
    a13 = f11 * c13 + f12 * c23 + g1 * c33
    a22 = f21 * c12 + f22 * c22 + g2 * c23
    a23 = f21 * c13 + f22 * c23 + g2 * c33
    s.p11 = a11 * f11 + a12 * f12 + a13 * g1
    s.p12 = a11 * f21 + a12 * f22 + a13 * g2
    s.p13 = a13
    s.p22 = (f21 * c11 + f22 * c12 + g2 * c13) * f21 + a22 * f22 + a23 * g2
    s.p23 = a23
    s.p33 = c33 + p.walk


@kernel
def correct(s: Filter, residual: float, h: float, noise: float) -> float:
    """Correct a filter by the residual of a measurement with slope ``h`` in x; return the log of its likelihood."""
    c11 = s.p11
    c12 = s.p12
    c13 = s.p13
    psi = h * h * c11 + noise
    k1 = h * c11 / psi
    k2 = h * c12 / psi
    k3 = h * c13 / psi
    s.x += k1 * residual
    s.v += k2 * residual
    s.f = flush_tiny(s.f + k3 * residual)
    s.p22 -= k2 * h * c12
    s.p23 -= k2 * h * c13
    s.p33 -= k3 * h * c13
    s.p11 = c11 - k1 * h * c11
    s.p12 = c12 - k1 * h * c12
    s.p13 = c13 - k1 * h * c13
    return float(-0.5 * (residual * residual / psi + log(psi)))
