"""An observer of displacement, velocity, and the acceleration that its model of the device does not explain."""

from __future__ import annotations

import math

import numpy as np

from core.block import Context, Oscillator
from core.control.nominal import over_sample
from core.device.oscillator import held
from core.elementary import exp
from core.errors import InputError
from core.kernel import flush_tiny, kernel
from core.matrix import product, solved
from core.record import Record, Vector, vector
from core.voltage import Motion, Tick, add_moves


class StateObserver(Record):
    """A device over a sample, its motion under one unit of unexplained acceleration, and the gains of the observer."""

    device: Tick
    by_acceleration1: float
    by_acceleration2: float
    correct: Vector = vector(3)


class Observed(Record):
    """Displacement and velocity, and the unexplained acceleration."""

    motion: Motion
    acceleration: float


def observer_of(device: Oscillator, context: Context, rate: float) -> StateObserver:
    r"""Pack an observer whose error has a triple pole at :math:`p=e^{-rh}` (Ackermann).

    .. math:: L=(\Phi-pI)^3\begin{bmatrix}C\Phi\\C\Phi^2\\C\Phi^3\end{bmatrix}^{-1}
        \begin{bmatrix}0\\0\\1\end{bmatrix}

    The third state follows an acceleration that the device does not explain, so a device that differs from it does not
    mislead the observer. Where all motion dies within a sample, the displacement is taken as measured.

    Parameters
    ----------
    device : Oscillator
        The device as the observer knows it, with a mass.
    context : Context
        Sample interval, and whether the drive is analogue.
    rate : float
        r, 1/ms.
    """
    p = StateObserver.zeros()
    p.device = over_sample(device, context)
    *_, first, second = held(device.mass, device.damping, device.stiffness, context.dt_ms)
    p.by_acceleration1, p.by_acceleration2 = first * device.mass, second * device.mass
    own = p.device
    phi = np.array(
        [[own.phi11, own.phi12, p.by_acceleration1], [own.phi21, own.phi22, p.by_acceleration2], [0.0, 0.0, 1.0]]
    )
    shifted = phi - exp(-rate * context.dt_ms) * np.eye(3)
    seen = np.array([phi[0], product(phi, phi)[0], product(phi, phi, phi)[0]])
    try:
        p.correct[:] = product(shifted, shifted, shifted, solved(seen, np.array([[0.0], [0.0], [1.0]])))[:, 0]
    except InputError:
        p.correct[0] = 1.0
    return p


@kernel
def observe(p: StateObserver, s: Observed, y: float, u: float, middle: float, end: float) -> None:
    """Predict by the voltage of the sample that ends now, as in `core.voltage.moves`; correct by the measurement."""
    x = s.motion.x
    v = s.motion.v
    acceleration = s.acceleration
    s.motion.x = p.device.phi11 * x + p.device.phi12 * v + p.device.push1 * u + p.by_acceleration1 * acceleration
    s.motion.v = p.device.phi21 * x + p.device.phi22 * v + p.device.push2 * u + p.by_acceleration2 * acceleration
    add_moves(p.device, s.motion, middle, end)
    missing = y - s.motion.x
    if not math.isfinite(missing):  # no measurement
        missing = 0.0
    s.motion.x = flush_tiny(s.motion.x + p.correct[0] * missing)
    s.motion.v = flush_tiny(s.motion.v + p.correct[1] * missing)
    s.acceleration = flush_tiny(acceleration + p.correct[2] * missing)
