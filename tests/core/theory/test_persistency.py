"""Excitation in closed form against signals filtered here, and the eigenvalue kernel against LAPACK."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.signal import lfilter

from core.theory.persistency import excitation, gram_of_tones, smallest_eigenvalue

A1, KP = 0.20566, 0.30093
W0 = 15.606


@pytest.mark.parametrize("n", [1, 2, 3, 4])
@pytest.mark.parametrize("relative", [False, True])
def test_smallest_eigenvalue_is_that_of_lapack(n, relative):
    rng = np.random.default_rng(n)
    for _ in range(50):
        factor = rng.normal(size=(n, n + 2)) * rng.uniform(0.01, 100, size=(n, 1))
        matrix = factor @ factor.T
        gram = matrix[np.tril_indices(n)]
        size = np.sqrt(np.diag(matrix))
        expected = np.linalg.eigvalsh(matrix / np.outer(size, size) if relative else matrix)
        found = smallest_eigenvalue(gram, np.zeros(n * n), n, relative)
        assert found == pytest.approx(expected[0], rel=1e-7, abs=1e-12 * expected[-1])


def test_a_direction_that_is_missing_has_eigenvalue_zero():
    gram = np.outer([1.0, 2.0, 3.0], [1.0, 2.0, 3.0])[np.tril_indices(3)]
    assert smallest_eigenvalue(gram, np.zeros(9), 3, True) < 1e-15
    gram = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    assert smallest_eigenvalue(gram, np.zeros(9), 3, True) == 0.0


def test_closed_form_is_the_mean_of_filtered_signals():
    """phi from bilinear filters at a very small step, averaged over whole periods."""
    from scipy.signal import bilinear

    tones, h, n = [(3.0, 0.5), (2.0, 1.0), (1.0, 0.0)], 2e-3, 400_000
    t = np.arange(n) * h
    u = sum(a * np.cos(w * t) for a, w in tones)
    over = np.polymul([1, A1, 1], [1, 2, 1])
    rows = [
        lfilter(*bilinear(top, over, 1 / h), u) for top in (np.array([1, A1, 1]), np.array([-KP, 0]), np.array([-KP]))
    ]
    period = round(4 * math.pi / h)
    phi = np.array(rows)[:, -30 * period :]
    np.testing.assert_allclose(phi @ phi.T / phi.shape[1], gram_of_tones(tones, (KP, A1, 1.0)), rtol=2e-3, atol=2e-3)


def judged(*tones):
    return excitation(gram_of_tones([(10.0 / len(tones), w / W0) for w in tones], (KP, A1, 1.0)))


def test_each_tone_gives_two_directions_and_a_constant_one():
    for w in (1.0, W0, 16.0):
        assert judged(w).smallest == 0.0 and judged(w).relative < 1e-12
        assert np.count_nonzero(judged(w).eigenvalues) == 2
    assert np.count_nonzero(judged(0.0).eigenvalues) == 1
    two, four = judged(1.0, 2.9), judged(1.0, 2.9, 8.0, 16.0)
    assert 0 < two.smallest < 1e-3 and two.condition > 1e4
    assert four.smallest > 1.0 and four.condition == pytest.approx(8.4, abs=0.1)
    assert 0 < two.relative < four.relative < 1
