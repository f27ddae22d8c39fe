"""How soon least squares forget where they began, by the equations alone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.signal import cont2discrete, lfilter

from tests.lab import play
from tests.physics.test_identify import TWO, W0, bench, settled_ms


@pytest.mark.parametrize(
    ("first", "second", "ms", "ratio"),
    [(10e3, 30e3, 6.0, 2.9), pytest.param(10.0, 30.0, 400.0, 2.4, marks=pytest.mark.long)],
)
def test_the_pace_of_forgetting_by_its_equations_alone(first, second, ms, ratio):
    """From theta = 0 the error of the coefficients is P e^(-B t) P0^-1 theta, and P^-1 follows from the regressor."""
    h, a1, n = 0.01 * W0, 7.09e-7 / math.sqrt(0.0538 * 2.209e-10), round(ms / 0.01)
    kp = -4 * 24 * 8.8541878128e-12 * 20 / 1.05 / 0.0538 * 1e6
    u = np.sum([10.0 * np.sin(w * 0.01 * np.arange(n)) for w in TWO], axis=0)
    delta = np.polymul([1.0, a1, 1.0], [1.0, 2.0, 1.0])
    # regressor of the true plant, continuous but for the held voltage: u/D, -y'/D, -y/D
    tops = (np.array([1.0, a1, 1.0]), np.array([-kp, 0.0]), np.array([-kp]))
    phi = np.column_stack([lfilter(b.ravel(), a, u) for b, a, _ in (cont2discrete((t, delta), h) for t in tops)])
    share = h / (1 + 10.0 * np.sum(phi * phi, axis=1))
    true = np.array([kp, a1, 1.0])

    def settled(rate):
        information, decay, last = np.eye(3), math.exp(-rate * 1e-5), 0
        for i in range(n):
            information = decay * information + share[i] * np.outer(phi[i], phi[i])
            error = np.linalg.solve(information, decay ** (i + 1) * true)
            last = i + 1 if np.max(np.abs(error / true)) > 0.1 else last
        return last * 0.01

    def measured(rate):
        own = {"kind": "least_squares", "start": "zero", "forgetting_rate": rate, "initial_covariance": 1.0}
        return settled_ms(play(bench({**own, "range_ratio": 0.0, "covariance_limit": 1e9}, TWO), n))

    times = [(measured(rate), settled(rate)) for rate in (first, second)]
    for found, theory in times:
        assert found == pytest.approx(theory, rel=0.1)
    assert times[0][0] / times[1][0] == pytest.approx(ratio, rel=0.05)
