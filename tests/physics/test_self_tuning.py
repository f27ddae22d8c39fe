"""Self-tuning estimators of 5.3: against batch least squares, and the result of each reading for the seven steps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from tests.lab import do, inject, make, play
from tests.physics.bank import BENCH, FACTORS, NAMES, model, of_bank
from tests.physics.seeds import HELD_OUT, seven_steps

A: dict[str, Any] = {"kind": "self_tuning"}
COEFFICIENTS = ("b0", "b1", "a1", "a2")


def difference_equation(name: str, dt: float) -> np.ndarray:
    """b0, b1, a1, a2 of a hypothesis from the transfer function of its held model."""
    phi, gamma = model(FACTORS[name], dt)
    a1, a2 = -np.trace(phi), np.linalg.det(phi)
    b0 = gamma[0, 0]
    return np.array([b0, (phi @ gamma)[0, 0] + a1 * b0, a1, a2])


def trace_of(n: int, rate: float, bank: dict[str, Any], **values: Any) -> tuple[Any, dict[str, np.ndarray]]:
    changed = {path.replace("__", "."): value for path, value in values.items()}
    board = make({**BENCH, "sample_rate_khz": rate, **changed, "diagnosers": {"kalman": bank}})
    return board, play(board, n)


def regressors(trace: dict[str, np.ndarray], denominator: tuple[float, float] = (0.0, 0.0)) -> tuple[Any, Any]:
    """Return h = [u_{i-1}, u_{i-2}, -z_{i-1}, -z_{i-2}] and z from rest, both behind 1/A(q)."""
    down = [1.0, *denominator]
    # the voltage of row i is held over the interval that ends at row i + 1
    u = lfilter([1.0], down, np.concatenate([[0.0], trace["drive.voltage"][:-1]]))
    z = lfilter([1.0], down, trace["sensor.displacement"])
    last_z, older_z = np.concatenate([[0.0], z[:-1]]), np.concatenate([[0.0, 0.0], z[:-2]])
    last_u = np.concatenate([[0.0], u[:-1]])
    return np.column_stack([u, last_u, -last_z, -older_z]), z


@pytest.mark.parametrize("prefilter", [False, True])
@pytest.mark.parametrize("forgetting", [0.9, 0.98])
def test_estimate_is_the_weighted_batch_solution(forgetting, prefilter):
    bank = {**A, "forgetting": forgetting, "prefilter": prefilter, "initial_covariance": 1e4}
    tones = [{"frequency_hz": 2000.0}, {"frequency_hz": 3300.0, "amplitude": 0.6}]
    reference = {"kind": "multi_sine", "amplitude_v": 8.0, "tones": tones}
    _, trace = trace_of(400, 20, bank, reference=reference)
    own = difference_equation("healthy", 0.05)
    h, z = regressors(trace, tuple(own[2:]) if prefilter else (0.0, 0.0))
    weight = forgetting ** np.arange(399, -1, -1)
    matrix = h.T @ (h * weight[:, None]) + forgetting**400 * np.eye(4) / 1e4
    expected = np.linalg.solve(matrix, h.T @ (weight * z))
    found = [trace[f"kalman.estimate.{name}"][-1] for name in COEFFICIENTS]
    np.testing.assert_allclose(found, expected, atol=1e-6 * np.abs(expected).max())


def test_likelihood_is_the_distance_in_the_metric_of_the_information():
    """(th - th_k)' eta^-1 (th - th_k) is the difference of the costs over the same memory."""
    board, trace = trace_of(300, 20, {**A, "forgetting": 0.95}, sensor__noise_um=0.05)
    covariance = np.zeros((4, 4))
    covariance[np.tril_indices(4)] = board.wiring.state("kalman").covariance
    information = np.linalg.inv(covariance + np.tril(covariance, -1).T)
    estimate = np.array([trace[f"kalman.estimate.{name}"][-1] for name in COEFFICIENTS])
    own = difference_equation("healthy", 0.05)
    variance = 0.05**2 * (1 + own[2] ** 2 + own[3] ** 2)
    logs = []
    for name in NAMES:
        apart = estimate - difference_equation(name, 0.05)
        logs.append(-0.5 * apart @ information @ apart / variance)
    expected = np.exp(np.array(logs) - max(logs))
    # the information is squeezed into two directions by the one tone: it is inverted to six digits or so
    np.testing.assert_allclose(of_bank(trace, "probability")[-1], expected / expected.sum(), atol=1e-4)
    h, z = regressors(trace)
    weight = 0.95 ** np.arange(299, -1, -1)
    costs = [weight @ (z - h @ difference_equation(name, 0.05)) ** 2 for name in NAMES]
    exact = np.exp(-0.5 * (np.array(costs) - min(costs)) / variance)
    np.testing.assert_allclose(of_bank(trace, "probability")[-1], exact / exact.sum(), atol=1e-9)


def test_one_sine_does_not_identify_the_coefficients():
    """White noise and one tone: equation error goes to a1 = a2 = 0, behind 1/A to the truth."""
    plain = {**A, "forgetting": 0.9999}
    found = {}
    for name, bank in (("plain", plain), ("behind", {**plain, "prefilter": True})):
        board, _ = trace_of(10, 50, bank, sensor__noise_um=0.01)
        while board.tick < 120_000:  # the transient of the start, which does excite, is forgotten by then
            board.advance(512)
        found[name] = [board.value(f"kalman.estimate.{part}") for part in ("a1", "a2")]
    assert np.all(np.abs(found["plain"]) < 0.05), found
    np.testing.assert_allclose(found["behind"], [-1.844, 0.938], atol=0.02)


def test_true_coefficients():
    np.testing.assert_allclose(difference_equation("healthy", 0.05)[2:], [-1.31716, 0.85174], atol=1e-4)
    np.testing.assert_allclose(np.abs(difference_equation("healthy", 0.05)[:2]), [0.03254, 0.03081], atol=1e-4)
    np.testing.assert_allclose(difference_equation("healthy", 0.02)[2:], [-1.84423, 0.93783], atol=1e-4)


def test_fixed_bank_weighs_the_errors_of_the_difference_equations():
    _, trace = trace_of(300, 20, {"kind": "arx_bank"})
    h, z = regressors(trace)
    log = np.full(6, -np.log(6.0))
    equations = [difference_equation(name, 0.05) for name in NAMES]
    for i in range(300):
        for k, own in enumerate(equations):
            variance = 0.05**2 * (1 + own[2] ** 2 + own[3] ** 2)
            log[k] += -0.5 * (z[i] - h[i] @ own) ** 2 / variance - 0.5 * np.log(variance)
        weight = np.exp(log - np.logaddexp.reduce(log))
        log = np.log(np.maximum(weight, 1e-3) / np.maximum(weight, 1e-3).sum())
    np.testing.assert_allclose(of_bank(trace, "probability")[-1], np.exp(log), atol=1e-9)


def test_anchored_banks_solve_their_own_least_squares():
    _, trace = trace_of(200, 20, {"kind": "anchored", "forgetting": 0.9, "anchor": 100.0})
    h, z = regressors(trace)
    for i in (5, 60, 199):
        weight = 0.9 ** np.arange(i - 1, -1, -1)
        matrix = h[:i].T @ (h[:i] * weight[:, None]) + 100.0 * np.eye(4)
        for name in NAMES:
            target = h[:i].T @ (weight * z[:i]) + 100.0 * difference_equation(name, 0.05)
            residual = z[i] - h[i] @ np.linalg.solve(matrix, target)
            assert trace[f"kalman.residual.{name}"][i] == pytest.approx(residual, abs=1e-9)


def test_free_banks_become_the_device_and_one_another():
    board, trace = trace_of(3000, 20, {"kind": "free_banks"}, sensor__noise_um=0.02)
    residuals = of_bank(trace, "residual")
    assert np.ptp(residuals[2:6], axis=1).max() > 1e-3
    assert np.ptp(residuals[100:], axis=1).max() < 1e-6
    inject(board, stiffness=0.1)
    after = of_bank(play(board, 200), "residual")
    assert np.ptp(after, axis=1).max() < 1e-6  # the fault tears nothing apart


@pytest.mark.parametrize(
    "bank",
    [
        {"kind": "self_tuning"},
        {"kind": "self_tuning", "prefilter": True},
        {"kind": "free_banks"},
        {"kind": "reference_banks"},
    ],
    ids=["plain", "prefilter", "free_banks", "reference_banks"],
)
def test_a_long_single_sine_without_noise_winds_nothing_up(bank):
    board, _ = trace_of(10, 20, {**bank, "forgetting": 0.86}, sensor__noise_um=0.0, plant__drive_noise_v=0.0)
    own = [board.wiring.index[name] for name in board.signals.names if name.startswith("kalman.")]
    for _ in range(200):
        board.advance(512)
        assert np.all(np.isfinite(board.wiring.state_of("kalman"))) and np.all(np.isfinite(board.wiring.w[own]))
    if bank["kind"] == "self_tuning":
        matrix = np.zeros((4, 4))
        matrix[np.tril_indices(4)] = board.wiring.state("kalman").covariance
        assert np.linalg.eigvalsh(matrix + np.tril(matrix, -1).T)[0] > 0.0
        assert board.value("kalman.trace") <= 1e10


# -- the seven steps


@pytest.mark.long
@pytest.mark.parametrize("first", [1, HELD_OUT])
def test_reading_a_is_slower_the_longer_its_memory(first):
    banks = {f"a{int(1000 * f)}": {**A, "forgetting": f} for f in (0.86, 0.9, 0.98, 0.995)}
    found = seven_steps(range(first, first + 25), banks, sensor__noise_um=0.01, sample_rate_khz=20)
    for name, delay in (("a860", 7.6), ("a900", 10.8), ("a980", 46.5), ("a995", 184.0)):
        assert found[name].later == pytest.approx(delay, rel=0.25), name
        assert found[name].false <= 0.1
    assert found["a980"].correct >= 0.95  # the text calls it dysfunctional


@pytest.mark.long
def test_with_noise_a_longer_memory_is_the_better_one():
    """The text's range 0.86 to 0.9 switches without end; 0.95 is best."""
    banks = {f"a{int(100 * f)}": {**A, "forgetting": f} for f in (0.86, 0.9, 0.95, 0.98)}
    found = seven_steps(range(1, 31), banks, sensor__noise_um=0.05, sample_rate_khz=20)
    assert found["a86"].false > 150 > 100 > found["a90"].false > 20 > 1.5 > found["a95"].false
    assert found["a95"].correct > 0.98 > found["a86"].correct
    filtered = {name: {**bank, "prefilter": True} for name, bank in banks.items()}
    found = seven_steps(range(1, 31), filtered, sensor__noise_um=0.2)
    assert max(found, key=lambda name: found[name].correct) == "a95"
    assert found["a95"].correct == pytest.approx(0.972, abs=0.006)


@pytest.mark.long
@pytest.mark.parametrize("first", [1, HELD_OUT])
def test_anchored_banks_have_the_order_of_the_text_and_its_thresholds_by_their_anchor(first):
    def bank(forgetting: float, anchor: float) -> dict[str, Any]:
        return {"kind": "anchored", "forgetting": forgetting, "anchor": anchor}

    factors = (0.86, 0.9, 0.98)
    banks = {f"r{rho}_{int(100 * f)}": bank(f, rho) for rho in (10, 100, 400, 1000) for f in factors}
    found = seven_steps(range(first, first + 25), banks, sensor__noise_um=0.02, sample_rate_khz=20)
    e86, e90, e98 = (found[f"r100_{int(100 * f)}"] for f in factors)
    assert 0.85 <= e86.correct <= 0.94 and 0.70 <= e90.correct <= 0.85 and e98.correct <= 0.35
    assert e86.right[1] - e90.right[1] >= 0.4  # distorted on the way from step 2 to 3
    assert e98.right[3] < 0.05 and e98.right[6] < 0.05
    for rho in (100, 400, 1000):
        shares = [found[f"r{rho}_{int(100 * f)}"].correct for f in factors]
        assert shares[0] > shares[1] > shares[2], rho
    # another anchor, other thresholds: 0.98 works, or 0.86 does not
    assert found["r1000_98"].correct > 0.9 and found["r10_86"].correct < 0.3


@pytest.mark.long
def test_the_other_readings_do_not_show_the_pattern():
    banks = {
        "fixed": {"kind": "arx_bank"},
        **{f"record{int(100 * f)}": {"kind": "reference_banks", "forgetting": f} for f in (0.86, 0.98)},
        **{f"free{int(100 * f)}": {"kind": "free_banks", "forgetting": f} for f in (0.86, 0.98)},
        **{
            f"winner{int(100 * f)}": {"kind": "free_banks", "adapting": "winner", "forgetting": f} for f in (0.86, 0.98)
        },
    }
    found = seven_steps(range(1, 31), banks, sensor__noise_um=0.01, sample_rate_khz=20)
    assert found["fixed"].correct == pytest.approx(0.997, abs=0.002)
    for factor in (86, 98):
        assert found[f"record{factor}"].correct == pytest.approx(0.992, abs=0.005)
        assert found[f"free{factor}"].correct <= 0.5
        assert found[f"winner{factor}"].correct <= 0.6


@pytest.mark.parametrize("kind", ["self_tuning", "arx_bank", "anchored", "reference_banks", "free_banks"])
def test_without_a_drive_nothing_is_evidence(kind):
    """At rest every equation explains nothing, and the one of the least variance would win."""
    values = {"sample_rate_khz": 20, "diagnosers": {"kalman": {"kind": kind}}}
    board = make({**BENCH, **values, "reference.amplitude_v": 0.0})
    quiet = of_bank(play(board, 2000), "probability")
    np.testing.assert_allclose(quiet, 1.0 / 6.0)
    do(board, {"set": {"reference.amplitude_v": 10.0}})
    driven = of_bank(play(board, 1000), "probability")
    do(board, {"set": {"reference.amplitude_v": 0.0}})
    play(board, 600)  # 30 ms, some 50 times the memory of the shuttle
    still = of_bank(play(board, 2000), "probability")
    assert np.abs(driven - 1.0 / 6.0).max() > 0.1
    np.testing.assert_array_equal(still, still[:1].repeat(2000, axis=0))
