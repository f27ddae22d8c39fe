"""Sources of the velocity that a controller feeds back."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from core.block import Context, parameter
from core.device.oscillator import held, within
from core.elementary import exp
from core.errors import InputError
from core.kernel import flush_tiny, kernel
from core.matrix import product, solved
from core.record import Record, Vector, vector
from core.voltage import Motion, Tick, add_moves

SOURCES = ("true", "difference", "observer")
Source = Literal["true", "difference", "observer"]
TRUE, DIFFERENCE = SOURCES.index("true"), SOURCES.index("difference")
OBSERVER_POLE = 6.0
"""Triple pole of the observer, as a multiple of the rate of the device."""


class PackedVelocity(Tick):
    """The source, sample interval, rate of the device, and the observer.

    The observer holds the device over a sample, the effect on it of one unit of unmodelled acceleration, and the shares
    of the observer's error that it adds to displacement, velocity and that acceleration.
    """

    source: float
    dt_ms: float
    rate: float
    by_acceleration1: float
    by_acceleration2: float
    correct: Vector = vector(3)


class VelocityState(Record):
    """Last measurement, whether there is one, and the observer's displacement, velocity and unmodelled acceleration."""

    last: float
    known: float
    observed: Motion
    acceleration: float


def velocity_source() -> Any:
    """Declare the parameter that chooses the source."""
    return parameter("true", "velocity from the plant itself, from the difference of two samples, or from an observer")


def velocity_of(source: Source, context: Context) -> PackedVelocity:
    r"""Pack the source; the observer's error has a triple pole at :math:`e^{-6\omega_0h}`, by Ackermann's formula.

    Its third state is the acceleration that the nominal device does not explain, so a device that differs from the
    nominal one does not mislead it.
    """
    h, device = context.dt_ms, context.device
    p = PackedVelocity.zeros()
    p.source, p.dt_ms, p.rate = SOURCES.index(source), h, device.natural_frequency
    p.phi11, p.phi12, p.phi21, p.phi22, first, second = held(device.mass, device.damping, device.stiffness, h)
    p.push1, p.push2 = first * device.force, second * device.force
    p.by_acceleration1, p.by_acceleration2 = first * device.mass, second * device.mass
    if context.analogue:
        effects = within(device.mass, device.damping, device.stiffness, h, device.force)
        p.middle1, p.middle2, p.end1, p.end2 = effects
    if device.mass == 0.0:
        p.source = TRUE  # a law for a plant without mass feeds back no velocity
        return p
    phi = np.array([[p.phi11, p.phi12, p.by_acceleration1], [p.phi21, p.phi22, p.by_acceleration2], [0.0, 0.0, 1.0]])
    shifted = phi - exp(-OBSERVER_POLE * p.rate * h) * np.eye(3)
    seen = np.array([phi[0], product(phi, phi)[0], product(phi, phi, phi)[0]])
    try:
        p.correct[:] = product(shifted, shifted, shifted, solved(seen, np.array([[0.0], [0.0], [1.0]])))[:, 0]
    except InputError:
        p.correct[0] = 1.0  # all motion dies within a sample: samples show only the displacement
    return p


@kernel
def velocity(p: PackedVelocity, s: VelocityState, true: float, y: float, u: float, middle: float, end: float) -> float:
    """Return the velocity now, um/ms; ``u`` was applied at the start of the interval that ends now.

    In the middle of the interval the voltage was larger by ``middle``, and at its end by ``end``.
    """
    last = s.last
    known = s.known != 0.0
    s.last = y
    s.known = 1.0
    if p.source == TRUE:
        return true
    if p.source == DIFFERENCE:
        return (y - last) / p.dt_ms if known else 0.0
    x = s.observed.x
    v = s.observed.v
    acceleration = s.acceleration
    s.observed.x = p.phi11 * x + p.phi12 * v + p.push1 * u + p.by_acceleration1 * acceleration
    s.observed.v = p.phi21 * x + p.phi22 * v + p.push2 * u + p.by_acceleration2 * acceleration
    add_moves(p, s.observed, middle, end)
    missing = y - s.observed.x if known else 0.0
    s.observed.x = flush_tiny(s.observed.x + p.correct[0] * missing)
    s.observed.v = flush_tiny(s.observed.v + p.correct[1] * missing)
    s.acceleration = flush_tiny(acceleration + p.correct[2] * missing)
    return s.observed.v
