r"""A mass, damper and spring with delay, offset and gain, fitted to a record by output error.

.. math:: \ddot x+a_1\dot x+a_0x=g\,u(t-\tau),\qquad y_i=x(t_i)+c+v_i

The voltage is held between samples, so the motion at the samples is exact for every delay: within a sample the input
changes once, after the fraction of the delay. Gain, offset and the two numbers of the first motion enter the output
linearly and are solved for at each step (variable projection, Golub and Pereyra 1973); three numbers are searched.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.optimize import least_squares
from scipy.signal import lfilter

from core.device.oscillator import held
from scenarios.records.columns import Numbers

MOST_DELAY = 8
"""Longest delay that is searched, in samples."""
STIFFNESSES = (-0.8, -0.4, -0.2, 0.0, 0.2, 0.4, 0.8)
DAMPINGS = (-1.0, 0.0, 1.0)
DELAYS = (0.5, 2.5, 4.5, 6.5)
"""Starts of the search: logarithms of stiffness and damping over mass, over nominal, and delays in samples.

A search that begins at a bound may stay there, so every start is off the bounds.
"""
BEGUN = 600
"""Samples by which starts are compared."""
REFINED = 3
"""The best starts that are refined."""
LOWEST, HIGHEST = (-np.inf, -np.inf, 0.0), (np.inf, np.inf, float(MOST_DELAY))
"""Bounds of the searched numbers: logarithms of stiffness and damping, and the delay."""
STEPS = (1e-6, 1e-5, 1e-5)
"""Changes of these for a difference."""
SKIPPED = MOST_DELAY + 1
"""First samples whose voltage may have come before the record."""
NO_ZERO = 1e-100
"""Is added to sizes that may be zero: a number that the record does not tell then has a huge variance, not none."""


@dataclass(frozen=True)
class Fit:
    """The numbers of the fit, their covariance, and the residual of each sample after the first ``SKIPPED``.

    Parameters
    ----------
    stiffness, damping : float
        Over mass, 1/ms^2 and 1/ms.
    delay : float
        In samples.
    gain : float
        Of the voltage on the acceleration, um/(ms^2 V).
    offset : float
        um.
    known : array of bool, shape (samples,)
        Which samples were measured.
    residual : array, shape (known samples,)
        Measured minus fitted displacement, um.
    motion : array, shape (samples,)
        The fitted displacement without offset, at lost samples too, um.
    jacobian : array, shape (known samples, 7)
        Change of the output with each number: the numbers of ``spread``, then first displacement and velocity.
    """

    stiffness: float
    damping: float
    delay: float
    gain: float
    offset: float
    known: NDArray[np.bool_] = field(repr=False)
    residual: Numbers = field(repr=False)
    motion: Numbers = field(repr=False)
    jacobian: Numbers = field(repr=False)

    @property
    def variance(self) -> float:
        """Variance of the noise, um^2."""
        return float(self.residual @ self.residual) / max(len(self.residual) - 7, 1) + NO_ZERO

    @cached_property
    def spread(self) -> Numbers:
        """Covariance over ``variance``: logarithms of stiffness and damping, delay, logarithm of the gain, offset."""
        scale = self._scaled[0]
        sizes, directions = np.linalg.eigh((self.jacobian / scale).T @ (self.jacobian / scale))
        # a direction that the record does not tell has a large variance, and not none
        inverse = directions / np.maximum(sizes, 1e-14) @ directions.T / np.outer(scale, scale)
        return np.asarray(inverse[:5, :5])

    @property
    def covariance(self) -> Numbers:
        """Covariance of the numbers of ``spread``."""
        return self.variance * self.spread

    @property
    def searched(self) -> Numbers:
        """The numbers that are searched: logarithms of stiffness and damping, and the delay."""
        return np.array([math.log(self.stiffness), math.log(self.damping), self.delay])

    @cached_property
    def _scaled(self) -> tuple[Numbers, Numbers, Numbers]:
        scale = np.sqrt(np.sum(self.jacobian**2, axis=0)) + NO_ZERO
        return scale, *np.linalg.qr(self.jacobian / scale)

    def unseen(self, columns: Numbers) -> Numbers:
        """Return the part of columns, of the known samples, that no number of the fit could take up."""
        _, seen, _ = self._scaled
        return np.asarray(columns - seen @ (seen.T @ columns))

    def taken_up(self, column: Numbers) -> Numbers:
        """Return the changes of all numbers that come closest to a change of the output, at known samples."""
        scale, seen, triangle = self._scaled
        return np.asarray(np.linalg.lstsq(triangle, seen.T @ column)[0] / scale)

    def pushed(self, force: Numbers, dt_ms: float) -> Numbers:
        """Return the displacement under an acceleration that is held at every sample, from rest."""
        phi, push = transition(self.stiffness, self.damping, dt_ms)
        return response(phi, push, force)

    @property
    def noise(self) -> float:
        """Standard deviation of the residual, um."""
        return float(np.sqrt(np.mean(self.residual**2)))


def transition(stiffness: float, damping: float, dt_ms: float) -> tuple[Numbers, Numbers]:
    """Return the transition of displacement and velocity over some time, and the reach of a unit acceleration."""
    phi11, phi12, phi21, phi22, reach, push = held(1.0, damping, stiffness, dt_ms)
    return np.array([[phi11, phi12], [phi21, phi22]]), np.array([reach, push])


def responses(stiffness: float, damping: float, delay: float, drive: Numbers, dt_ms: float) -> Numbers:
    """Return the output of a unit gain, of the two first states and of a unit offset, one column for each."""
    whole = min(int(delay), MOST_DELAY)
    rest = (delay - whole) * dt_ms
    phi, both = transition(stiffness, damping, dt_ms)
    new = transition(stiffness, damping, dt_ms - rest)[1]
    old = both - new if rest > 0.0 else np.zeros(2)  # the voltage before acts first, then moves on with the rest
    count = len(drive) - SKIPPED
    now = drive[SKIPPED - whole : SKIPPED - whole + count]
    before = drive[SKIPPED - whole - 1 : SKIPPED - whole - 1 + count]
    denominator = _denominator(phi)
    columns = np.ones((count, 4))
    columns[:, 0] = lfilter(_numerator(phi, new), denominator, now)
    if rest > 0.0:
        columns[:, 0] += lfilter(_numerator(phi, old), denominator, before)
    impulse = np.zeros(count)
    impulse[0] = 1.0
    columns[:, 1] = lfilter([1.0, -phi[1, 1]], denominator, impulse)
    columns[:, 2] = lfilter([0.0, phi[0, 1]], denominator, impulse)
    return columns


def _numerator(phi: Numbers, push: Numbers) -> list[float]:
    """Return the polynomial from an acceleration to the displacement."""
    return [0.0, float(push[0]), float(phi[0, 1] * push[1] - phi[1, 1] * push[0])]


def _denominator(phi: Numbers) -> list[float]:
    return [1.0, -float(np.trace(phi)), float(np.linalg.det(phi))]


def response(phi: Numbers, push: Numbers, force: Numbers) -> Numbers:
    """Return the displacement under an acceleration that is held at every sample, from rest."""
    return np.asarray(lfilter(_numerator(phi, push), _denominator(phi), force), dtype=np.float64)


def slopes(numbers: Numbers, weights: Numbers, drive: Numbers, dt_ms: float) -> Numbers:
    """Return the change of the output with each of the searched numbers, one column for each.

    ``weights`` are of the responses: gain, first displacement and velocity, offset.
    """

    def output(of: Numbers) -> Numbers:
        return responses(math.exp(of[0]), math.exp(of[1]), of[2], drive, dt_ms) @ weights

    here, columns = output(numbers), []
    for i, step in enumerate(STEPS):
        moved = numbers.copy()
        moved[i] += step if numbers[i] + step <= HIGHEST[i] else -step
        columns.append((output(moved) - here) / (moved[i] - numbers[i]))
    return np.column_stack(columns)


def fit(
    drive: Numbers, displacement: Numbers, dt_ms: float, stiffness: float, damping: float, near: Fit | None = None
) -> Fit:
    """Return the fit; stiffness and damping over mass of the nominal device are where the search begins.

    A displacement that is no number is left out. The search begins at the fit to a part of the record instead, where
    one is given.
    """
    known = np.isfinite(displacement[SKIPPED:])
    y = displacement[SKIPPED:][known]

    def solved(numbers: Numbers, most: int | None = None) -> tuple[Numbers, Numbers, Numbers]:
        few = drive if most is None else drive[: SKIPPED + most]
        basis = responses(math.exp(numbers[0]), math.exp(numbers[1]), numbers[2], few, dt_ms)
        basis = basis[known[: len(basis)]]
        scale = np.sqrt(np.mean(basis**2, axis=0)) + 1e-300
        unit, triangle = np.linalg.qr(basis / scale)
        weights = solve_triangular(triangle, unit.T @ y[: len(basis)]) / scale
        return y[: len(basis)] - basis @ weights, weights, basis

    def residual(numbers: Numbers) -> Numbers:
        return solved(numbers)[0]

    def begun(numbers: Numbers) -> float:
        left = solved(numbers, BEGUN)[0]
        return float(left @ left)

    starts = [near.searched] if near else _starts(math.log(stiffness), math.log(damping))
    starts.sort(key=begun)
    found = [
        least_squares(
            residual,
            start,
            bounds=(LOWEST, HIGHEST),
            x_scale=(0.01, 0.1, 0.5),
            diff_step=np.array(1e-6),
            xtol=1e-12,
            ftol=1e-12,
        )
        for start in starts[:REFINED]
    ]
    best = min(found, key=lambda one: float(one.cost))
    numbers: Numbers = best.x
    left, weights, basis = solved(numbers)
    gain = float(weights[0])
    whole = responses(math.exp(numbers[0]), math.exp(numbers[1]), numbers[2], drive, dt_ms)
    jacobian = np.empty((len(y), 7))
    jacobian[:, :3] = slopes(numbers, weights, drive, dt_ms)[known]
    jacobian[:, 3], jacobian[:, 4:] = gain * basis[:, 0], basis[:, [3, 1, 2]]
    return Fit(
        stiffness=math.exp(numbers[0]),
        damping=math.exp(numbers[1]),
        delay=float(numbers[2]),
        gain=gain,
        offset=float(weights[3]),
        known=known,
        residual=left,
        motion=whole[:, :3] @ weights[:3],
        jacobian=jacobian,
    )


def _starts(stiffness: float, damping: float) -> list[Numbers]:
    return [
        np.array([stiffness + more, damping + slower, delay])
        for more in STIFFNESSES
        for slower in DAMPINGS
        for delay in DELAYS
    ]
