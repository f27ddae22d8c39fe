"""Weighted estimates of a bank of two axes, and of a moving bank, against filters written here and closed forms."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.lab import inject, make, play, rms
from tests.physics.bank import K, M, model, signals
from tests.two_axis import DAMPING, GYRO, MASS, OMEGA, STIFFNESS, TURN, held

H = 0.01
NOISE_UM = 0.1e-6 * np.sqrt(0.5e5)
THERMAL = 2.0 * 1.380649e-23 * 300.0 / 1e-5 * 1e12 * 1e-3
"""2 k T / h, in uN^2 per uN ms/um."""
DPS = np.degrees(1.0) * 1e3
FACTORS = {"healthy": 1.0, "sense+1": 1.01}
PORTS = ("x", "y", "x_velocity", "y_velocity", "rate")


def steady(stiffness: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return transition, effect of the forces, gain, residual covariance and corrected covariance, by scipy."""
    phi, gamma = held(stiffness, DAMPING, MASS, H)
    assumed = (DAMPING[0, 0] * OMEGA * np.array([0.02, 0.003])) ** 2
    size = NOISE_UM * np.array([1.0, 1.0, OMEGA, OMEGA])
    noise = gamma @ (THERMAL * DAMPING + np.diag(assumed)) @ gamma.T / np.outer(size, size) + 1e-12 * np.eye(4)
    prior = solve_discrete_are((phi * size / size[:, None]).T, np.eye(4)[:, :2], noise, np.eye(2))
    prior *= np.outer(size, size)
    psi = prior[:2, :2] + NOISE_UM**2 * np.eye(2)
    gain = prior[:, :2] @ np.linalg.inv(psi)
    return phi, gamma, gain, psi, prior - gain @ prior[:2]


def independent(factor: float, forces: np.ndarray, measured: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return states (samples, 5) and variances (samples, 5) of one filter of motion and rate, by Friedland's form.

    That this form is the filter of all five states is a test of the bank. As in the bank, the rate is weighed by the
    residual covariance of the nominal device.
    """
    stiffness = STIFFNESS * np.array([[1.0, 1.0], [1.0, factor]])
    phi, gamma, gain, _, known = steady(stiffness)
    psi = steady(STIFFNESS)[3]
    plus, minus = (held(stiffness, DAMPING + 2.0 * MASS * omega * TURN, MASS, H)[0] for omega in (1e-3, -1e-3))
    turn = (plus - minus) / 2e-3
    motion, slope, rate, doubt = np.zeros(4), np.zeros(4), 0.0, np.radians(0.3) ** 2
    states, variances = [], []
    for i, z in enumerate(measured):
        force = forces[i - 1] if i else np.zeros(2)
        slope = phi @ slope + turn @ motion
        motion = (phi + rate * turn) @ motion + gamma @ force
        residual, seen = z - motion[:2], slope[:2]
        told = np.linalg.solve(psi + doubt * np.outer(seen, seen), seen)
        change = doubt * told @ residual
        doubt -= doubt * doubt * told @ seen
        slope = slope - gain @ seen
        motion = motion + gain @ residual + slope * change
        rate += change
        states.append([*motion, rate])
        variances.append([*(np.diag(known) + slope * slope * doubt), doubt])
    return np.array(states), np.array(variances)


def on_axes(samples: int, dps: float = 300.0, **faults: float) -> dict[str, np.ndarray]:
    hypotheses = [{"name": name, "second_stiffness": factor} for name, factor in FACTORS.items()]
    bank = {"kind": "axes_bank", "rate_walk_dps_rt_s": 0.0, "hypotheses": hypotheses}
    rate = {"kind": "constant", "deg_per_s": dps}
    board = make({"device.id": "gyro-a", "diagnosers": {"bank": bank}, "rate": rate}, base=GYRO)
    inject(board, **faults)
    return play(board, samples)


def test_a_bank_of_two_axes_against_the_whole_filters():
    """Motion and rate as the mean of independent filters, variances as of their mixture."""
    trace = on_axes(400, sense_stiffness=0.004)
    forces = np.column_stack([trace[f"drive.{axis}.force"] for axis in "xy"])
    measured = np.column_stack([trace[f"sensor.{axis}.displacement"] for axis in "xy"])
    filters = [independent(factor, forces, measured) for factor in FACTORS.values()]
    states, own = (np.stack(parts, axis=1) for parts in zip(*filters, strict=True))
    weights = np.column_stack([trace[f"bank.probability.{name}"] for name in FACTORS])
    assert weights.min() < 0.1 and 0.2 < weights[-1].max()
    unit = np.array([1.0, 1.0, 1.0, 1.0, DPS])
    mean = np.einsum("sk,ski->si", weights, states)
    off = states - mean[:, None]
    variances = np.einsum("sk,ski->si", weights, own + off * off)
    for i, port in enumerate(PORTS):
        size = np.abs(mean[:, i]).max() * unit[i]
        found = trace[f"bank.weighted.{port}"]
        np.testing.assert_allclose(found / size, mean[:, i] * unit[i] / size, atol=1e-9, err_msg=port)
        std = trace[f"bank.weighted.{port}_std"]
        np.testing.assert_allclose(std, np.sqrt(variances[:, i]) * unit[i], rtol=1e-6, err_msg=port)
        by_model = np.column_stack([trace[f"bank.{'' if port == 'rate' else 'state_'}{port}.{n}"] for n in FACTORS])
        np.testing.assert_allclose(found / size, (weights * by_model).sum(axis=1) / size, atol=1e-12, err_msg=port)
    second = (weights * np.array([*FACTORS.values()])).sum(axis=1)
    np.testing.assert_allclose(trace["bank.weighted.second_stiffness"], second, atol=1e-14)


def test_a_matched_bank_of_two_axes_doubts_as_much_as_it_errs():
    """With exactly the noise of the model and no floor, each squared error over its variance is 1 on average."""
    bank = {
        "kind": "axes_bank",
        "drive_noise": 0.0,
        "sense_noise": 0.0,
        "rate_walk_dps_rt_s": 0.0,
        "probability_floor": 0.0,
    }
    board = make({"device.id": "gyro-a", "diagnosers": {"bank": bank}, "rate": {"kind": "constant"}}, base=GYRO)
    play(board, 20_000)
    trace = play(board, 40_000)
    for port in ("x", "y"):
        error = trace[f"bank.weighted.{port}"] - trace[f"plant.{port}"]
        assert np.mean((error / trace[f"bank.weighted.{port}_std"]) ** 2) == pytest.approx(1.0, abs=0.2), port


def test_figures_of_two_axes_are_the_errors_of_the_trace():
    """The device turns, y stiffens by 1 %, and a spring between the axes comes."""
    events = [
        {"at_ms": 20.0, "fault": "sense_stiffness", "severity": 0.01},
        {"at_ms": 40.0, "heal": ["sense_stiffness"], "fault": "quadrature", "severity": 500.0},
    ]
    values = {"duration_ms": 60.0, "events": events, "expect": [], "metrics.estimation": True}
    result = run(with_values(get("gyro-diagnosis"), values), seed=3, taps=True)
    trace, figures = result.trace, result.metrics
    names = [item.name for item in result.board.spec.diagnosers["bank"].params.hypotheses]
    truth = trace["bank.truth"].astype(int)
    true = {
        "x_um": trace["plant.x"],
        "y_um": trace["plant.y"],
        "rate_dps": trace["rate.rate"],
        "quadrature_dps": np.where(truth == names.index("quadrature+500"), 500.0, 0.0),
        "second_stiffness_pct": np.where(truth == names.index("sense+1"), 101.0, 100.0),
    }
    assert {*truth} == {0, names.index("sense+1"), names.index("quadrature+500")}
    for end, value in true.items():
        port, _, unit = end.rpartition("_")
        own = trace[f"bank.weighted.{port}"] * (100.0 if unit == "pct" else 1.0)
        assert figures[f"estimation.bank.rms_error_{end}"] == pytest.approx(rms(own - value), rel=1e-7), end
    edges = [0, *(np.flatnonzero(np.diff(truth)) + 1), len(truth)]
    ratios = []
    for start, stop in pairwise(edges):
        step = slice(start, stop)
        errors = {
            name: np.hypot(
                *(rms(trace[f"bank.state_{axis}.{name}"][step] - trace[f"plant.{axis}"][step]) for axis in "xy")
            )
            for i, name in enumerate(names)
            if i != truth[start]
        }
        own = np.hypot(*(rms(trace[f"bank.weighted.{axis}"][step] - trace[f"plant.{axis}"][step]) for axis in "xy"))
        ratios.append(own / min(errors.values()))
    assert len(ratios) == 3 and max(ratios) < 1.0
    assert figures["estimation.bank.worst_step_ratio"] == pytest.approx(max(ratios), rel=1e-7)


def three_filters(z: np.ndarray, u: np.ndarray, follows: str) -> dict[str, np.ndarray]:
    """Return weights, states, covariances and factors of a moving bank, sample by sample; written here."""
    spacing, reach, floor = 0.025, 16, 1e-3
    place = {"mass": 0, "stiffness": 1, "damping": 2}[follows]

    def of(k: int) -> tuple[np.ndarray, np.ndarray]:
        factors = [1.0, 1.0, 1.0]
        factors[place] = 1.0 + spacing * k
        return model(tuple(factors))

    models = {k: of(k) for k in range(-reach, reach + 1)}
    x = {k: np.zeros(2) for k in models}
    p = {k: np.diag([1.0, K / M * 1e-6]) for k in models}
    centre, log, kept = 0, np.full(3, -np.log(3.0)), []
    for i, value in enumerate(z):
        running = [centre - 1, centre, centre + 1]
        score = log.copy()
        for j, k in enumerate(running):
            phi, gamma = models[k]
            if i:
                x[k] = phi @ x[k] + gamma[:, 0] * u[i - 1]
                p[k] = phi @ p[k] @ phi.T + gamma @ gamma.T * 0.3**2
            psi = p[k][0, 0] + 0.05**2
            residual, gain = value - x[k][0], p[k][:, 0] / psi
            x[k] = x[k] + gain * residual
            p[k] = p[k] - np.outer(gain, p[k][0])
            score[j] -= 0.5 * (residual**2 / psi + np.log(psi))
        share = np.maximum(np.exp(score - score.max()) / np.exp(score - score.max()).sum(), floor)
        weight, log = share / share.sum(), np.log(share)
        kept.append((weight, [x[k].copy() for k in running], [p[k].copy() for k in running], running))
        step = 1 if weight[2] > 0.5 else -1 if weight[0] > 0.5 else 0
        if step and abs(centre + step) < reach:
            edge = centre + step
            x[edge + step], p[edge + step] = x[edge].copy(), p[edge].copy()
            log = np.array([log[1], log[2], np.log(floor)] if step > 0 else [np.log(floor), log[0], log[1]])
            centre = edge
    weights, states, covariances, running = (np.array(part) for part in zip(*kept, strict=True))
    return {"weights": weights, "states": states, "covariances": covariances, "factors": 1.0 + spacing * running}


@pytest.mark.parametrize(("follows", "fault"), [("stiffness", "stiffness"), ("mass", "added_mass")])
def test_a_moving_bank_against_three_filters_that_move(follows, fault):
    bank: dict[str, Any] = {"kind": "moving_bank", "follows": follows, "process_noise_v": 0.3, "least_drive_v": 0.0}
    trace = signals(1500, {"diagnosers": {"kalman": bank}}, {fault: 0.06})
    own = three_filters(trace["sensor.displacement"], trace["drive.voltage"], follows)
    assert len(np.unique(own["factors"][:, 1])) > 2  # the centre has moved more than once
    weights = np.column_stack([trace[f"kalman.probability.{name}"] for name in ("lower", "centre", "upper")])
    np.testing.assert_allclose(weights, own["weights"], atol=1e-8)
    mean = np.einsum("sk,ski->si", own["weights"], own["states"])
    off = own["states"] - mean[:, None]
    spread = np.einsum("sk,skij->sij", own["weights"], own["covariances"] + off[..., :, None] * off[..., None, :])
    for i, part in enumerate(("displacement", "velocity")):
        size = np.abs(mean[:, i]).max()
        np.testing.assert_allclose(trace[f"kalman.weighted.{part}"] / size, mean[:, i] / size, atol=1e-9)
        np.testing.assert_allclose(trace[f"kalman.weighted.{part}_std"] ** 2, spread[:, i, i], rtol=1e-7)
    np.testing.assert_allclose(trace["kalman.weighted.covariance"], spread[:, 0, 1], atol=1e-9)
    factor = (own["weights"] * own["factors"]).sum(axis=1)
    np.testing.assert_allclose(trace[f"kalman.weighted.{follows}"], factor, atol=1e-9)
    for part in {"mass", "stiffness", "damping", "gain"} - {follows}:
        assert np.all(trace[f"kalman.weighted.{part}"] == 1.0)


def test_figures_of_a_moving_bank_are_the_errors_of_the_trace():
    values = {"samples": 2000, "metrics.estimation": True, "expect": [], "diagnosers.moving.every": 3}
    result = run(with_values(get("ch5-drift"), values), seed=2, taps=True)
    trace, figures, turn = result.trace, result.metrics, slice(0, None, 3)
    for part, end in (("displacement", "um"), ("velocity", "um_ms")):
        error = (trace[f"moving.weighted.{part}"] - trace[f"plant.{part}"])[turn]
        assert figures[f"estimation.moving.rms_error_{end}"] == pytest.approx(rms(error), rel=1e-9)
    error = 100.0 * (trace["moving.weighted.stiffness"] - trace["effects.stiffness_scale"])[turn]
    assert figures["estimation.moving.rms_error_stiffness_pct"] == pytest.approx(rms(error), rel=1e-9)
    assert "estimation.moving.worst_step_ratio" not in figures
