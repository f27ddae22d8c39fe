"""Positive definite matrices (A.2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.errors import InputError

MOST = 50
TINY = 1e-12


@dataclass(frozen=True)
class Definiteness:
    """Verdict on a matrix.

    Parameters
    ----------
    positive_definite, semidefinite : bool
        Whether x'Ax > 0, or >= 0, for every x that is not 0.
    symmetric : bool
        Whether it equals its transpose; only the symmetric part counts in x'Ax.
    eigenvalues : tuple of float
        Of the symmetric part, smallest first.
    minors : tuple of float
        Its leading principal minors: all positive when it is positive definite (Sylvester).
    """

    positive_definite: bool
    semidefinite: bool
    symmetric: bool
    eigenvalues: tuple[float, ...]
    minors: tuple[float, ...]


def definiteness(matrix: Sequence[Sequence[float]]) -> Definiteness:
    r"""Judge :math:`x^TAx` by the symmetric part :math:`\tfrac12(A+A^T)`.

    The eigenvalues of A itself do not decide: for [[1, 4], [0, 1]] both are 1, and x'Ax is -2 at [1, -1].

    Raises
    ------
    InputError
        If it is not a square matrix of finite numbers.
    """
    if not matrix or any(len(row) != len(matrix) for row in matrix):
        raise InputError("must be a square matrix", "matrix")
    values = np.array(matrix, dtype=np.float64)
    if len(values) > MOST or not np.all(np.isfinite(values)):
        raise InputError(f"must be of finite numbers, {MOST} rows at most", "matrix")
    half = 0.5 * (values + values.T)
    eigenvalues = np.linalg.eigvalsh(half)
    size = TINY * max(float(np.max(np.abs(eigenvalues))), 1e-300)
    return Definiteness(
        positive_definite=bool(eigenvalues[0] > size),
        semidefinite=bool(eigenvalues[0] >= -size),
        symmetric=bool(np.array_equal(values, values.T)),
        eigenvalues=tuple(float(value) for value in eigenvalues),
        minors=tuple(float(np.linalg.det(half[:n, :n])) for n in range(1, len(half) + 1)),
    )
