"""Estimation kernels against the closed forms they sample."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import cont2discrete, lfilter

from core import estimation
from core.record import Record, Vector, vector
from core.voltage import Motion

N = 3


class Estimate(Record):
    theta: Vector = vector(N)
    covariance: Vector = vector(6)
    product: Vector = vector(N)


def whole(s: Estimate) -> np.ndarray:
    return np.array([[s.covariance[estimation.entry(i, j)] for j in range(N)] for i in range(N)])


def start(trust: float) -> Estimate:
    s = Estimate.zeros()
    s.covariance[:] = estimation.diagonal(N, trust)
    return s


def feed(s, phi, z, *, noise=1.0, forgetting=1.0, limit=0.0):
    error = z - s.theta @ phi
    return estimation.estimate(s.theta, s.covariance, phi, s.product, N, error, noise, forgetting, limit)


@pytest.mark.parametrize("forgetting", [1.0, 0.97])
def test_least_squares_is_the_weighted_batch_solution(forgetting):
    """theta minimises sum mu^(n-k) (z - phi'theta)^2 + mu^n theta'theta / P0, and P is the inverse of its matrix."""
    rng = np.random.default_rng(1)
    phi, z = rng.normal(size=(60, N)), rng.normal(size=60)
    s = start(50.0)
    for row, value in zip(phi, z, strict=True):
        assert feed(s, row.copy(), value, noise=forgetting, forgetting=forgetting) > 0
    weight = forgetting ** np.arange(59, -1, -1)
    information = phi.T @ (phi * weight[:, None]) + forgetting**60 * np.eye(N) / 50.0
    np.testing.assert_allclose(np.linalg.inv(whole(s)), information, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(s.theta, np.linalg.solve(information, phi.T @ (weight * z)), rtol=1e-9)


def test_least_squares_samples_the_continuous_law():
    """P' = BP - P phi phi' P / m^2 and th' = P phi e / m^2 (3.3.2.8-11), constant phi, e^-Bt of the parameter error."""
    rate, h, n, m2 = 3.0, 1e-3, 500, 2.5
    phi, truth = np.array([1.0, -0.5, 0.3]), np.array([0.4, 1.2, -0.7])

    def law(_, state):
        p = state[N:].reshape(N, N)
        gain = p @ phi / m2
        return np.concatenate([gain * (phi @ (truth - state[:N])), (rate * p - np.outer(gain, phi @ p)).ravel()])

    exact = solve_ivp(law, (0, n * h), np.concatenate([np.zeros(N), 2 * np.eye(N).ravel()]), rtol=1e-10, atol=1e-12)
    s = start(2.0)
    for _ in range(n):
        feed(s, phi, phi @ truth, noise=m2 * np.exp(-rate * h) / h, forgetting=np.exp(-rate * h))
    np.testing.assert_allclose(s.theta, exact.y[:N, -1], rtol=2e-3, atol=1e-3)
    np.testing.assert_allclose(whole(s), exact.y[N:, -1].reshape(N, N), rtol=4e-3, atol=2e-3)


def test_trace_limit_stops_windup_and_learning_goes_on():
    free, held = start(10.0), start(10.0)
    one = np.array([1.0, 0.0, 0.0])
    for s, limit in ((free, 0.0), (held, 1e3)):
        for _ in range(2000):
            feed(s, one, 1.0, noise=0.98, forgetting=0.98, limit=limit)
    assert 1e9 < estimation.trace_of(free.covariance, N) <= estimation.HIGHEST
    assert 500 < estimation.trace_of(held.covariance, N) <= 1e3
    before = held.theta[0]
    feed(held, one, 5.0, noise=0.98, forgetting=0.98, limit=1e3)
    assert held.theta[0] > before + 0.01


def test_projection_is_the_nearest_in_the_metric_of_the_information():
    rng = np.random.default_rng(2)
    s = start(5.0)
    for row in rng.normal(size=(4, N)):
        feed(s, row, rng.normal())
    before, covariance = s.theta.copy(), whole(s)
    low = before[1] + 0.3
    estimation.project_onto(s.theta, s.covariance, N, 1, low, 9.0)
    assert s.theta[1] == low
    # minimise (x - before)' P^-1 (x - before) with x[1] = low: the gradient vanishes along the free directions
    gradient = np.linalg.solve(covariance, s.theta - before)
    np.testing.assert_allclose(gradient[[0, 2]], 0.0, atol=1e-10)
    kept = s.array.copy()
    estimation.project_onto(s.theta, s.covariance, N, 1, low - 1, 9.0)
    assert np.array_equal(s.array, kept)


@pytest.mark.parametrize(("method", "line"), [("zoh", False), ("foh", True)])
def test_state_filter_is_the_exact_discretisation(method, line):
    pole, h = 1.3, 0.156
    x = np.random.default_rng(3).normal(size=200)
    x[0] = 0.0
    packed, s = estimation.filter_of(pole, h), Motion.zeros()
    found = []
    for before, now in zip(np.concatenate([[0.0], x[:-1]]), x, strict=True):
        estimation.filter_input(packed, s, before, now if line else before)
        found.append([s.x, s.v, estimation.filtered_second_derivative(packed, s, now)])
    for column, numerator in zip(np.array(found).T, ([1.0], [1.0, 0.0], [1.0, 0.0, 0.0]), strict=True):
        b, a, _ = cont2discrete((numerator, [1.0, 2 * pole, pole**2]), h, method)
        np.testing.assert_allclose(column, lfilter(b.ravel(), a, x), atol=1e-10)
