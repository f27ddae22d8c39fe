"""Definite matrices against their definition."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import InputError
from core.theory.definite import definiteness


def test_against_the_quadratic_form():
    rng = np.random.default_rng(3)
    seen = set()
    x = rng.normal(size=(4000, 3))
    for shift in np.linspace(-1.0, 4.0, 40):
        a = rng.normal(size=(3, 3)) + shift * np.eye(3)
        found = definiteness(a.tolist())
        least = float(np.min(np.einsum("ij,jk,ik->i", x, a, x) / np.sum(x * x, axis=1)))
        assert found.positive_definite == all(minor > 0 for minor in found.minors)
        if abs(found.eigenvalues[0]) > 0.05:
            assert found.positive_definite == (least > 0)
        assert least >= found.eigenvalues[0] - 1e-12
        seen.add(found.positive_definite)
    assert seen == {True, False}


def test_eigenvalues_of_an_unsymmetric_matrix_say_nothing():
    found = definiteness([[1, 4], [0, 1]])
    assert not found.positive_definite and not found.semidefinite and not found.symmetric
    assert found.eigenvalues == pytest.approx((-1, 3))


def test_semidefinite():
    found = definiteness([[1, 1], [1, 1]])
    assert found.semidefinite and not found.positive_definite and found.symmetric


@pytest.mark.parametrize("matrix", [[], [[1, 2]], [[1, 2], [3]], [[float("nan")]]])
def test_what_is_no_square_matrix_is_refused(matrix):
    with pytest.raises(InputError, match="matrix"):
        definiteness(matrix)
