"""Banks of Kalman filters beside the plain one, each against its textbook form written here with matrices."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.block import FloatArray
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.lab import inject, make, play
from tests.physics.bank import BENCH, FACTORS, NAMES, K, M, model, of_bank

R = 0.05**2
START = np.diag([1.0, K / M * 1e-6])
MODELS = [model(factors) for factors in FACTORS.values()]


def bench(bank: dict[str, Any], n: int = 600, at: int = 300, values: dict[str, Any] | None = None, **faults: float):
    """Play a bank with least_drive 0, a fault on the way, and return its outputs."""
    told = {"process_noise_v": 0.1, "least_drive_v": 0.0, **bank}
    board = make({**BENCH, "sensor.noise_um": 0.05, **(values or {}), "diagnosers": {"kalman": told}})
    first = play(board, at)
    inject(board, **faults)
    second = play(board, n - at)
    return {name: np.concatenate([first[name], second[name]]) for name in first}


def density(residual: FloatArray, psi: FloatArray) -> float:
    """Logarithm of the normal density of a vector."""
    sign, log = np.linalg.slogdet(2 * np.pi * psi)
    assert sign > 0
    return float(-0.5 * residual @ np.linalg.solve(psi, residual) - 0.5 * log)


def filtered(x: FloatArray, p: FloatArray, i: int, u: float | None, z: FloatArray, h: FloatArray, r: FloatArray):
    """Predict by model i (not before the first sample), correct, and return the density too."""
    phi, gamma = MODELS[i]
    if u is not None:
        x = phi @ x + gamma[:, 0] * u
        p = phi @ p @ phi.T + gamma @ gamma.T * 0.01
    psi = h @ p @ h.T + r
    gain = p @ h.T @ np.linalg.inv(psi)
    residual = z - h @ x
    return x + gain @ residual, p - gain @ h @ p, density(residual, psi)


H1 = np.array([[1.0, 0.0]])


def test_imm_is_that_of_blom_and_bar_shalom():
    trace = bench({"kind": "imm", "switching": 0.01}, added_mass=0.05)
    n = len(NAMES)
    change = np.full((n, n), 0.01 / (n - 1)) + (0.99 - 0.01 / (n - 1)) * np.eye(n)
    weights, x, p = np.full(n, 1 / n), [np.zeros(2)] * n, [START] * n
    found = of_bank(trace, "probability")
    for t, z in enumerate(trace["sensor.displacement"]):
        u = trace["drive.voltage"][t - 1] if t else None
        if t:
            c = change.T @ weights
            share = change * weights[:, None] / c
            mean = [sum(share[i, j] * x[i] for i in range(n)) for j in range(n)]
            p = [
                sum(share[i, j] * (p[i] + np.outer(x[i] - mean[j], x[i] - mean[j])) for i in range(n)) for j in range(n)
            ]
            x, weights = mean, c
        logs = np.empty(n)
        for i in range(n):
            x[i], p[i], logs[i] = filtered(x[i], p[i], i, u, np.array([z]), H1, np.array([[R]]))
        weights = weights * np.exp(logs - logs.max())
        weights /= weights.sum()
        np.testing.assert_allclose(found[t], weights, atol=1e-7)
    assert NAMES[int(found[-1].argmax())] == "m+5"


def test_two_outputs_are_corrected_by_as_one_vector():
    values = {"sensors.velocimeter.always": True, "sensors.velocimeter.noise_um_ms": 0.8}
    trace = bench({"kind": "two_output", "probability_floor": 0.0}, values=values, stiffness=0.05)
    n = len(NAMES)
    x, p, log = [np.zeros(2)] * n, [START] * n, np.full(n, -math.log(n))
    found, noise = of_bank(trace, "probability"), np.diag([R, 0.8**2])
    for t in range(600):
        z = np.array([trace["sensor.displacement"][t], trace["velocimeter.velocity"][t]])
        u = trace["drive.voltage"][t - 1] if t else None
        for i in range(n):
            x[i], p[i], more = filtered(x[i], p[i], i, u, z, np.eye(2), noise)
            log[i] += more
        log -= np.logaddexp.reduce(log)
        np.testing.assert_allclose(found[t], np.exp(log), atol=1e-7)
    assert np.ptp(trace["velocimeter.velocity"]) > 10


def test_reseeding_copies_the_winner_into_the_hopeless():
    bank = {"kind": "reseed", "interval": 40, "sure": 0.8, "hopeless": 0.05}
    trace = bench(bank, added_mass=0.1)
    n = len(NAMES)
    x, p, log = [np.zeros(2)] * n, [START] * n, np.full(n, -math.log(n))
    found, copies = of_bank(trace, "probability"), 0
    for t, z in enumerate(trace["sensor.displacement"]):
        u = trace["drive.voltage"][t - 1] if t else None
        for i in range(n):
            x[i], p[i], more = filtered(x[i], p[i], i, u, np.array([z]), H1, np.array([[R]]))
            log[i] += more
        weight = np.maximum(np.exp(log - np.logaddexp.reduce(log)), 1e-3)
        log = np.log(weight / weight.sum())
        np.testing.assert_allclose(found[t], np.exp(log), atol=1e-7)
        if (t + 1) % 40 == 0 and np.exp(log).max() > 0.8:
            best = int(log.argmax())
            hopeless = [i for i in range(n) if np.exp(log[i]) < 0.05]
            copies += len(hopeless)
            for i in hopeless:
                x[i], p[i] = x[best].copy(), p[best].copy()
    assert copies > 20


def test_cumulative_sums_are_those_of_page():
    trace = bench({"kind": "cusum", "threshold": 12.0}, added_mass=0.05)
    residuals, nis = of_bank(trace, "residual"), of_bank(trace, "nis")
    psi = residuals**2 / nis
    logs = -0.5 * nis - 0.5 * np.log(psi)
    g = np.zeros(6)
    for t in range(600):
        g = np.maximum(g + logs[t] - logs[t, 0], 0.0)
        g[0] = 0.0
        g = np.maximum(g - max(g.max() - 24.0, 0.0), 0.0)
        np.testing.assert_allclose(of_bank(trace, "sum")[t], g, atol=1e-6)
        assert trace["kalman.alarm"][t] == (g.max() > 12.0)
    assert trace["kalman.alarm"][:300].sum() == 0 and trace["kalman.alarm"][-1] == 1


def test_a_moving_bank_follows_a_drift_that_a_fixed_one_cannot():
    """A spring 20 % stiffer within 0.8 s: five models of 5 % each see steps, the moving one the drift."""
    fixed = [{"name": f"k{i}", "stiffness": 1 + 0.05 * i} for i in range(5)]
    scenario = with_values(get("ch5-drift"), {"diagnosers.fixed": {"kind": "mmae", "hypotheses": fixed}})
    result = run(scenario, 4)
    truth = 1.0 + 0.2 * np.arange(result.samples) / 40_000
    estimate = result.signal("moving.estimate")
    steps = np.array([1 + 0.05 * i for i in range(5)])[result.signal("fixed.winner").astype(int)]
    late = slice(2000, None)
    error, coarse = (float(np.sqrt(np.mean((value - truth)[late] ** 2))) for value in (estimate, steps))
    assert error < 0.01 and coarse > 1.5 * error
    assert abs(estimate[-1] - 1.2) < 0.005
    # three neighbours and no more: the weights of the three are the estimate
    weights = np.column_stack([result.signal(f"moving.probability.{name}") for name in ("lower", "centre", "upper")])
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-12)


@pytest.mark.parametrize(
    "kind", ["mmae", "imm", "reseed", "lock_in", "two_output", "consistency", "cusum", "lock_in_glr"]
)
def test_without_drive_nothing_is_concluded(kind):
    values = {"reference": {"kind": "constant", "amplitude_v": 0.0}}
    board = make({**BENCH, **values, "plant.drive_noise_v": 0.0, "diagnosers": {"kalman": {"kind": kind}}})
    trace = play(board, 3000)
    weights = of_bank(trace, "probability")
    assert np.ptp(weights[5:], axis=0).max() < 1e-5 or kind == "consistency"
    if "kalman.alarm" in trace:
        assert trace["kalman.alarm"].sum() == 0
    if "kalman.verdict" in trace:
        assert np.all(trace["kalman.verdict"] == 0)
