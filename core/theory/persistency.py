r"""Persistency of excitation: whether an input lets the parameters be identified.

A regressor is persistently exciting when :math:`\alpha_1I\le\int_t^{t+\delta}\varphi\varphi^T\,d\tau\le\alpha_2I` for
every t (A.9.1): the smallest eigenvalue of its mean Gram matrix stays above zero. Each tone of the input adds two
directions, a constant adds one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray
from core.kernel import kernel
from core.record import Vector

SWEEPS = 10
ROUNDING = 1e-13
"""Eigenvalues below this share of the largest are taken for 0."""


@dataclass(frozen=True)
class RegressorExcitation:
    """The excitation of a regressor by an input.

    Parameters
    ----------
    eigenvalues : ndarray, shape (n,)
        Of the mean of phi phi', smallest first, in the units of the regressor.
    relative : float
        Smallest eigenvalue once every component has unit mean square: 1 at best, 0 when one is lost.
    """

    eigenvalues: FloatArray
    relative: float

    @property
    def smallest(self) -> float:
        """Level of excitation alpha_1 per unit of time."""
        return float(self.eigenvalues[0])

    @property
    def condition(self) -> float:
        """Largest over smallest eigenvalue; infinite without excitation."""
        least = max(self.smallest, 0.0)
        return float(self.eigenvalues[-1] / least) if least > 0.0 else math.inf


def excitation(gram: FloatArray) -> RegressorExcitation:
    """Judge a mean Gram matrix, shape (n, n)."""
    size = np.sqrt(np.diag(gram))
    # Divide by one size after the other: the product of two small sizes may underflow.
    relative = 0.0 if np.any(size == 0.0) else float(_eigenvalues(gram / size[:, None] / size)[0])
    return RegressorExcitation(_eigenvalues(gram), relative)


def _eigenvalues(matrix: FloatArray) -> FloatArray:
    """Return the eigenvalues, smallest first; rounding errors relative to the largest are set to 0."""
    values = np.asarray(np.linalg.eigvalsh(matrix), dtype=np.float64)
    return np.where(np.abs(values) < ROUNDING * np.abs(values[-1]), 0.0, values)


def gram_of_tones(
    tones: Sequence[tuple[float, float]], plant: tuple[float, float, float], pole: float = 1.0
) -> FloatArray:
    r"""Return the mean of :math:`\varphi\varphi^T` in the steady state under a sum of tones.

    .. math:: \varphi=\frac1{(s+\lambda)^2}[u,\,-sy,\,-y]^T,\quad y=\frac{k_p}{s^2+a_1s+a_2}u,\quad
        \overline{\varphi\varphi^T}=\sum_i\tfrac12A_i^2\,\mathrm{Re}\,v(j\omega_i)v(j\omega_i)^*

    Parameters
    ----------
    tones : sequence of tuple of float
        Amplitude (V) and frequency of each, distinct, in the unit of time of the plant; frequency 0 is a constant.
    plant : tuple of float
        kp, a1, a2.
    pole : float
        Pole of the filters.
    """
    gain, a1, a2 = plant
    total = np.zeros((3, 3))
    for amplitude, w in tones:
        s = 1j * w
        y = gain / (s * s + a1 * s + a2)
        v = np.array([1.0, -s * y, -y]) / (s + pole) ** 2
        total += (0.5 if w else 1.0) * amplitude * amplitude * np.real(np.outer(v, np.conj(v)))
    return total


@kernel
def add_outer_product(gram: Vector, regressor: Vector, n: int) -> None:
    """Add the outer product of a regressor to the lower triangle of a Gram matrix."""
    at = 0
    for i in range(n):
        for j in range(i + 1):
            gram[at] += regressor[i] * regressor[j]
            at += 1


@kernel
def smallest_eigenvalue(gram: Vector, scratch: Vector, n: int, relative: bool) -> float:
    r"""Return the smallest eigenvalue of a symmetric matrix, by cyclic Jacobi rotations.

    Parameters
    ----------
    gram, scratch : vectors
        The lower triangle, and :math:`n^2` scratch numbers.
    n : int
        Size.
    relative : bool
        Of the matrix with rows and columns scaled to a unit diagonal, which the rotations keep accurate in every
        digit; 0 when a diagonal element is 0.
    """
    for i in range(n):
        for j in range(n):
            low, high = min(i, j), max(i, j)
            value = gram[high * (high + 1) // 2 + low]
            if relative:
                size = gram[i * (i + 3) // 2] * gram[j * (j + 3) // 2]
                if size <= 0.0:
                    return 0.0
                value /= math.sqrt(size)
            scratch[i * n + j] = value
    for _ in range(SWEEPS):
        for i in range(n):
            for j in range(i + 1, n):
                off = scratch[i * n + j]
                if off == 0.0:
                    continue
                half = 0.5 * (scratch[j * n + j] - scratch[i * n + i]) / off
                t = 1.0 / (abs(half) + math.sqrt(half * half + 1.0))
                if half < 0.0:
                    t = -t
                c = 1.0 / math.sqrt(t * t + 1.0)
                for k in range(n):
                    a, b = scratch[i * n + k], scratch[j * n + k]
                    scratch[i * n + k] = c * (a - t * b)
                    scratch[j * n + k] = c * (b + t * a)
                for k in range(n):
                    a, b = scratch[k * n + i], scratch[k * n + j]
                    scratch[k * n + i] = c * (a - t * b)
                    scratch[k * n + j] = c * (b + t * a)
    least = scratch[0]
    for i in range(1, n):
        least = min(least, scratch[i * n + i])
    return float(max(least, 0.0))
