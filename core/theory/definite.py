"""Positive definite matrices (A.2)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydantic import BaseModel, Field

from core.errors import InputError

MOST = 50
TINY = 1e-12


class DefinitenessReport(BaseModel):
    """Whether x'Ax is positive for every x."""

    positive_definite: bool
    semidefinite: bool
    symmetric: bool
    eigenvalues: tuple[float, ...] = Field(description="Eigenvalues of the symmetric part, smallest first")
    minors: tuple[float, ...] = Field(description="Leading principal minors of the symmetric part")


def definiteness(matrix: Sequence[Sequence[float]]) -> DefinitenessReport:
    r"""Judge :math:`x^TAx` by the symmetric part :math:`\tfrac12(A+A^T)`.

    The eigenvalues of A itself do not decide: for [[1, 4], [0, 1]] both are 1, and x'Ax is -2 at [1, -1]. All leading
    principal minors of the symmetric part are positive when A is positive definite (Sylvester).

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
    return DefinitenessReport(
        positive_definite=bool(eigenvalues[0] > size),
        semidefinite=bool(eigenvalues[0] >= -size),
        symmetric=bool(np.array_equal(values, values.T)),
        eigenvalues=tuple(float(value) for value in eigenvalues),
        minors=tuple(float(np.linalg.det(half[:n, :n])) for n in range(1, len(half) + 1)),
    )
