r"""Kalman filter of a shuttle that is known but for a slow force: displacement, velocity, acceleration by it.

.. math:: x_{i+1}=\Phi x_i+\Gamma u_i+\Gamma_f f_i,\qquad f_{i+1}=f_i+n_i

The device and the voltage are known; what the model lacks is left to :math:`f`, a random walk. A voltage that moves
adds to :math:`\Gamma u_i` what it is more than at the start of the sample (`core.voltage`).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from core import voltage
from core.block import TICK, Context, Equation, Oscillator, kernel, parameter, settled
from core.device.oscillator import transition
from core.sense.sensor import Sensor, SensorParams

PHI11, PHI12, PHI21, PHI22, GAMMA1, GAMMA2, FORCE1, FORCE2, WALK, EVERY, TICK_MODEL = range(11)
MODEL = TICK_MODEL + voltage.TICK_SIZE
"""Layout of a packed model over a sample, the model over a tick behind it, and its length."""
X, V, F, P11, P12, P13, P22, P23, P33, FILTER = range(10)
"""Layout of a filter's state, and its length."""

MOTION = Equation("motion", r"\ddot x=\frac{F_e-\beta\dot x-kx}{m}+f,\quad \dot f=n")


class TrackerParams(SensorParams):
    """What a tracker assumes of the shuttle."""

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
        """Refuse what the model of mass and spring cannot be."""
        return "" if device.mass > 0.0 and device.stiffness > 0.0 else "needs a device with mass and spring"


def pack_model(params: TrackerParams, context: Context) -> list[float]:
    r"""Return the packed model; by default the walk has the variance :math:`4000\,s^{-1}(0.1\omega_0^2A)^2dt`."""
    device = context.device
    stiffness = device.stiffness * params.stiffness
    phi = transition(device.mass, device.damping, stiffness, context.dt_ms)
    square = stiffness / device.mass
    volt = device.force / stiffness
    own = params.model_error * square * params.stroke_um
    walk = params.force_rate_per_ms * own * own * context.dt_ms
    held = (1.0 - phi[0], -phi[2])
    tick = replace(device, stiffness=stiffness)
    return [
        *phi,
        held[0] * volt,
        held[1] * volt,
        held[0] / square,
        held[1] / square,
        walk,
        context.every,
        *voltage.pack_tick(tick, device.force, context.dt_ms / context.every, context.analogue),
    ]


def start(params: TrackerParams, context: Context) -> list[float]:
    """Return a filter at rest at zero, uncertain by 0.1 um, by a tenth of the speed and by the force it may lack."""
    square = context.device.stiffness / context.device.mass
    own = params.model_error * square * params.stroke_um
    speed = 0.1 * params.stroke_um * math.sqrt(square)
    return [0.0, 0.0, 0.0, 0.01, 0.0, 0.0, speed * speed, 0.0, own * own]


@kernel
def gather(p: Any, at: int, s: Any, drive: int, w: Any, io: Any, applied: int) -> bool:
    """Take in the voltage of a tick; say whether a sensor that runs every N of them is between two of its turns."""
    voltage.follow(p, at + TICK_MODEL, s, drive, w[io[applied]], w[io[applied + 1]], w[io[applied + 2]])
    return bool(p[at + EVERY] != 1.0 and w[TICK] % p[at + EVERY] != 0.0)


@kernel
def predict(p: Any, at: int, s: Any, b: int, drive: int) -> None:
    """Advance the filter at ``b`` of the state by one sample, under the voltage gathered at ``drive``."""
    f11 = p[at + PHI11]
    f12 = p[at + PHI12]
    f21 = p[at + PHI21]
    f22 = p[at + PHI22]
    g1 = p[at + FORCE1]
    g2 = p[at + FORCE2]
    x = s[b + X]
    v = s[b + V]
    f = s[b + F]
    u = s[drive + voltage.START]
    s[b + X] = settled(f11 * x + f12 * v + g1 * f + p[at + GAMMA1] * u + s[drive + voltage.GAINED1])
    s[b + V] = settled(f21 * x + f22 * v + g2 * f + p[at + GAMMA2] * u + s[drive + voltage.GAINED2])
    c11 = s[b + P11]
    c12 = s[b + P12]
    c13 = s[b + P13]
    c22 = s[b + P22]
    c23 = s[b + P23]
    c33 = s[b + P33]
    a11 = f11 * c11 + f12 * c12 + g1 * c13
    a12 = f11 * c12 + f12 * c22 + g1 * c23
    a13 = f11 * c13 + f12 * c23 + g1 * c33
    a22 = f21 * c12 + f22 * c22 + g2 * c23
    a23 = f21 * c13 + f22 * c23 + g2 * c33
    s[b + P11] = a11 * f11 + a12 * f12 + a13 * g1
    s[b + P12] = a11 * f21 + a12 * f22 + a13 * g2
    s[b + P13] = a13
    s[b + P22] = (f21 * c11 + f22 * c12 + g2 * c13) * f21 + a22 * f22 + a23 * g2
    s[b + P23] = a23
    s[b + P33] = c33 + p[at + WALK]


@kernel
def correct(s: Any, b: int, residual: float, h: float, noise: float) -> float:
    """Correct the filter at ``b`` by a residual of slope ``h``; return the logarithm of its likelihood."""
    c11 = s[b + P11]
    c12 = s[b + P12]
    c13 = s[b + P13]
    psi = h * h * c11 + noise
    k1 = h * c11 / psi
    k2 = h * c12 / psi
    k3 = h * c13 / psi
    s[b + X] += k1 * residual
    s[b + V] += k2 * residual
    s[b + F] = settled(s[b + F] + k3 * residual)
    s[b + P22] -= k2 * h * c12
    s[b + P23] -= k2 * h * c13
    s[b + P33] -= k3 * h * c13
    s[b + P11] = c11 - k1 * h * c11
    s[b + P12] = c12 - k1 * h * c12
    s[b + P13] = c13 - k1 * h * c13
    return float(-0.5 * (residual * residual / psi + math.log(psi)))
