"""Where a controller that feeds back velocity has it from."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import Context, kernel, parameter, settled
from core.device.oscillator import held, within
from core.voltage import add_moved

KIND, DT, PHI11, PHI12, PHI21, PHI22, INPUT1, INPUT2, PUSH1, PUSH2, MOVED, CORRECT1, CORRECT2, CORRECT3 = (
    *range(11),
    *range(14, 17),
)
VELOCITY_SIZE = 17
"""Packed numbers of a velocity source."""
SOURCES = ("true", "difference", "observer")
Source = Literal["true", "difference", "observer"]
STATES = 5
"""Last measurement, whether there is one, and the observer's displacement, velocity and unmodelled acceleration."""
OBSERVER_POLE = 6.0
"""Triple pole of the observer over the rate of the device."""


def velocity_source() -> Any:
    """Declare the parameter."""
    return parameter("true", "velocity from the plant itself, from the difference of two samples, or from an observer")


def pack_velocity(source: Source, context: Context, rate: float) -> list[float]:
    r"""Pack the source; the observer's error has a triple pole at :math:`e^{-6\omega_0h}`, by Ackermann's formula.

    Its third state is an acceleration nobody told it of: a device that is not the nominal one does not mislead it.
    """
    h = context.dt_ms
    device = context.device
    phi11, phi12, phi21, phi22, first, second = held(device.mass, device.damping, device.stiffness, h)
    effect = (first * device.force, second * device.force)
    push = (first * device.mass, second * device.mass)
    moved = (0.0, 0.0, 0.0, 0.0)
    if context.analogue:
        moved = within(device.mass, device.damping, device.stiffness, h, device.force)
    own = [float(SOURCES.index(source)), h, phi11, phi12, phi21, phi22, *effect, *push, *moved]
    if device.mass == 0.0:
        return [0.0, *own[1:], 0.0, 0.0, 0.0]  # nothing here feeds back a velocity
    phi = np.array([[phi11, phi12, push[0]], [phi21, phi22, push[1]], [0.0, 0.0, 1.0]])
    shifted = phi - math.exp(-OBSERVER_POLE * rate * h) * np.eye(3)
    seen = np.array([phi[0], (phi @ phi)[0], (phi @ phi @ phi)[0]])
    try:
        correct = shifted @ shifted @ shifted @ np.linalg.solve(seen, np.array([0.0, 0.0, 1.0]))
    except np.linalg.LinAlgError:
        return [*own, 1.0, 0.0, 0.0]  # all motion dies within a sample, so that samples tell of the displacement alone
    return [*own, *correct.tolist()]


@kernel
def velocity(p: Any, packed: int, s: Any, at: int, true: float, y: float, u: float, middle: float, end: float) -> float:
    """Return the velocity now, um/ms; ``u`` was applied at the start of the interval that ends now.

    In its middle and at its end it was by ``middle`` and ``end`` more.
    """
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
    more = s[at + 4]
    s[at + 2] = p[packed + PHI11] * x + p[packed + PHI12] * v + p[packed + INPUT1] * u + p[packed + PUSH1] * more
    s[at + 3] = p[packed + PHI21] * x + p[packed + PHI22] * v + p[packed + INPUT2] * u + p[packed + PUSH2] * more
    add_moved(p, packed + MOVED, s, at + 2, middle, end)
    missing = y - s[at + 2] if known else 0.0
    s[at + 2] = settled(s[at + 2] + p[packed + CORRECT1] * missing)
    s[at + 3] = settled(s[at + 3] + p[packed + CORRECT2] * missing)
    s[at + 4] = settled(more + p[packed + CORRECT3] * missing)
    return float(s[at + 3])
