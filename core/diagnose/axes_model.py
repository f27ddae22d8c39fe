r"""A device with two axes in a filter: over a tick under its forces, the effect of rotation, its steady gain."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from core.block import Context, FloatArray
from core.device.two_axis import TwoAxis
from core.diagnose.kalman import over_ticks
from core.matrix import exponential, product, riccati, solved
from core.record import Record, Vector, vector
from core.units import thermal_force_un

STATES, FORCES = 4, 6
SMALLEST = 1e-12
"""Added to the noise of every state, relative to the noise of a measurement: the Riccati equation then has a
solution."""


class AxesModel(Record):
    """Transition of (x, y, x', y') over a tick, its change with the rate, effect of the forces, gain, covariance.

    Matrices are stored row by row. The forces are the forces at the start of the tick and their changes until its
    middle and its end, first along x. The covariance of the residuals and the variances of the corrected states hold
    for a known rate.
    """

    phi: Vector = vector(STATES * STATES)
    turn: Vector = vector(STATES * STATES)
    push: Vector = vector(STATES * FORCES)
    gain: Vector = vector(STATES * 2)
    variance: Vector = vector(STATES)
    psi_x: float
    psi_xy: float
    psi_y: float


class AxesTick(NamedTuple):
    """A device over a tick: transition, its derivative by the rate, effect of forces."""

    phi: FloatArray
    turn: FloatArray
    push: FloatArray


def over_a_tick(device: TwoAxis, h: float) -> AxesTick:
    r"""Return a device over a tick.

    .. math:: \Phi=e^{Ah},\quad N=\frac{\partial}{\partial\Omega}e^{(A+\Omega A_\Omega)h}\Big|_0,\quad
        \Gamma_n=\int_0^he^{A(h-\tau)}B\,(\tau/h)^n\,d\tau

    A force that moves within the tick is the parabola :math:`f+4(f_m-f)(a-a^2)+(f_e-f)(2a^2-a)` of :math:`a=\tau/h`.

    Parameters
    ----------
    device : TwoAxis
        ``force`` is the gain along x.
    h : float
        Length of the tick, ms.
    """
    inverse = np.diag([1.0 / device.mass, 1.0 / device.mass_y])
    system, swirl = np.zeros((4, 4)), np.zeros((4, 4))
    system[:2, 2:] = np.eye(2)
    system[2:, :2], system[2:, 2:] = -product(inverse, device.stiffnesses), -product(inverse, device.dampings)
    swirl[2:, 2:] = -2.0 * device.coriolis_mass * product(inverse, np.array([[0.0, -1.0], [1.0, 0.0]]))
    # the force with its first and second derivative by a, two of each, in a chain behind the motion
    chain = np.zeros((10, 10))
    chain[:4, :4] = system * h
    chain[2:4, 4:6] = h * product(inverse, np.diag([device.force, 1.0]))
    chain[4:6, 6:8] = chain[6:8, 8:10] = np.eye(2)
    moved = exponential(chain)
    start, slope, bend = moved[:4, 4:6], moved[:4, 6:8], 2.0 * moved[:4, 8:10]
    middle, end = 4.0 * (slope - bend), 2.0 * bend - slope
    push = np.column_stack([part[:, axis] for axis in (0, 1) for part in (start, middle, end)])
    # the derivative of an exponential is a corner of the exponential of both (Van Loan 1978)
    both = np.block([[system * h, swirl * h], [np.zeros((4, 4)), system * h]])
    return AxesTick(moved[:4, :4], exponential(both)[:4, 4:], push)


def force_noise(device: TwoAxis, assumed_un: tuple[float, float], context: Context) -> FloatArray:
    r"""Return the covariance of the forces over a tick, uN^2: thermal, :math:`2k_BTD/h`, and the assumed noise."""
    per_root = thermal_force_un(context.temperature_k, context.dt_ms / context.every)
    covariance: FloatArray = per_root * per_root * device.dampings + np.diag(np.square(assumed_un))
    return covariance


class SteadyFilter(NamedTuple):
    """A filter in the limit: gain, covariance of the residuals, variances of the corrected states."""

    gain: FloatArray
    psi: FloatArray
    variances: FloatArray


def steady(tick: AxesTick, forces: FloatArray, noise_um: float, omega: float, ticks: int) -> SteadyFilter:
    r"""Return the filter in the limit, for displacements measured every ``ticks`` ticks.

    The Riccati equation is solved with displacements over the noise of a measurement and velocities over that times
    :math:`\omega`, where all its numbers are of similar size.

    Parameters
    ----------
    tick : Tick
    forces : array of shape (2, 2)
        Covariance of the forces over a tick, uN^2.
    noise_um : float
        Standard deviation of a measurement.
    omega : float
        Natural frequency, rad/ms.
    ticks : int
        Ticks between two measurements.
    """
    size = noise_um * np.array([1.0, 1.0, omega, omega])
    phi = tick.phi * size / size[:, None]
    held = tick.push[:, [0, 3]] / size[:, None]
    phi, noise = over_ticks(phi, product(held, forces, held.T), ticks)
    prior = riccati(phi, np.eye(4)[:2], noise + SMALLEST * np.eye(4), np.eye(2))
    psi = prior[:2, :2] + np.eye(2)
    gain = solved(psi, prior[:2]).T
    variances = np.diag(prior) - np.sum(gain * prior[:, :2], axis=1)
    return SteadyFilter(gain * size[:, None] / noise_um, psi * noise_um * noise_um, variances * size * size)


def fill(
    m: AxesModel,
    device: TwoAxis,
    nominal: TwoAxis,
    assumed_un: tuple[float, float],
    noise_um: float,
    context: Context,
) -> None:
    """Pack a device with its steady gain, and with the residual covariance of the nominal one."""
    noise, omega = force_noise(nominal, assumed_un, context), nominal.natural_frequency
    tick = over_a_tick(device, context.dt_ms / context.every)
    own = steady(tick, noise, noise_um, omega, context.every)
    m.phi[:], m.turn[:], m.push[:] = tick.phi.flat, tick.turn.flat, tick.push.flat
    m.gain[:], m.variance[:] = own.gain.flat, own.variances
    psi = steady(over_a_tick(nominal, context.dt_ms / context.every), noise, noise_um, omega, context.every).psi
    m.psi_x, m.psi_xy, m.psi_y = psi[0, 0], psi[0, 1], psi[1, 1]
