"""Where a controller that feeds back velocity has it from."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Context, kernel, parameter, settled
from core.device.oscillator import held

KIND, DT, PHI11, PHI12, PHI21, PHI22, INPUT1, INPUT2, CORRECT1, CORRECT2, VELOCITY_SIZE = range(11)
"""Packed numbers of a velocity source."""
SOURCES = ("true", "difference", "observer")
Source = Literal["true", "difference", "observer"]
STATES = 4
"""Last measurement, whether there is one, and the observer's displacement and velocity."""
OBSERVER_POLE = 3.0
"""Double pole of the observer over the rate of the device."""


def velocity_source() -> Any:
    """Declare the parameter."""
    return parameter(
        "true", "velocity from the plant itself, from the difference of two samples, or from an observer of the device"
    )


def pack_velocity(source: Source, context: Context, rate: float) -> list[float]:
    r"""Pack the source; the observer's error has a double pole at :math:`e^{-3\omega_0h}`, by Ackermann's formula."""
    h = context.dt_ms
    device = context.device
    phi11, phi12, phi21, phi22, first, second = held(device.mass, device.damping, device.stiffness, h)
    phi = np.array([[phi11, phi12], [phi21, phi22]])
    effect = (first * device.force, second * device.force)
    if device.mass == 0.0:
        return [0.0, h, *phi.ravel().tolist(), *effect, 0.0, 0.0]  # nothing here feeds back a velocity
    pole = math.exp(-OBSERVER_POLE * rate * h)
    wanted = phi @ phi - 2.0 * pole * phi + pole * pole * np.eye(2)
    correct = wanted @ np.linalg.solve(np.array([phi[0], (phi @ phi)[0]]), np.array([0.0, 1.0]))
    return [float(SOURCES.index(source)), h, *phi.ravel().tolist(), *effect, *correct.tolist()]


@kernel
def velocity(p: Any, packed: int, s: Any, at: int, true: float, y: float, u: float) -> float:
    """Return the velocity now, um/ms; ``u`` was applied over the interval that ends now."""
    last = s[at]
    known = s[at + 1] != 0.0
    s[at] = y
    s[at + 1] = 1.0
    if p[packed + KIND] == 0.0:
        return float(true)
    if p[packed + KIND] == 1.0:
        return float((y - last) / p[packed + DT]) if known else 0.0
    x = s[at + 2]
    v = s[at + 3]
    ahead = p[packed + PHI11] * x + p[packed + PHI12] * v + p[packed + INPUT1] * u
    v = p[packed + PHI21] * x + p[packed + PHI22] * v + p[packed + INPUT2] * u
    missing = y - ahead if known else 0.0
    s[at + 2] = settled(ahead + p[packed + CORRECT1] * missing)
    s[at + 3] = settled(v + p[packed + CORRECT2] * missing)
    return float(s[at + 3])
