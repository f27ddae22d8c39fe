"""The extended Kalman filter of spring and damper: against numpy, against its own covariance, as a diagnoser."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from core.block import FloatArray, Oscillator
from core.board.board import Board
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.lab import do, inject, make, play

TONE = {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0}
NOISY = {"sensor.noise_um": 0.05, "plant.drive_noise_v": 0.01, "sample_rate_khz": 50, "reference": TONE}
RHO = (2e-3 * np.pi * 2000.0) ** 2 / (0.0538 / 2.2090e-10 * 1e-6)
STATES = ("displacement", "velocity", "stiffness", "damping")


def bench(values: dict[str, Any] | None = None, **own: Any) -> Board:
    return make({"identifiers": {"own": {"kind": "ekf", **own}}, **NOISY, **(values or {})})


def estimates(trace: dict[str, FloatArray]) -> FloatArray:
    names = ("own.displacement", "own.velocity", "own.estimate.stiffness", "own.estimate.damping")
    return np.column_stack([trace[name] for name in names])


def motion(device: Oscillator, z: FloatArray, force: tuple[float, float, float], h: float) -> FloatArray:
    """Return displacement and velocity after a tick under a force, its slope and its curvature, by an exponential."""
    chain = np.diag([1.0, 0.0, 1.0, 1.0], 1)
    chain[1, :3] = np.array([-device.stiffness * z[2], -device.damping * z[3], 1.0]) / device.mass
    moved: FloatArray = (expm(chain * h) @ np.array([z[0], z[1], *force]))[:2]
    # the filter takes what is within a tick from the nominal device
    rest, chain[1, :2] = moved, np.array([-device.stiffness, -device.damping]) / device.mass
    within: FloatArray = (expm(chain * h) @ np.array([0.0, 0.0, 0.0, *force[1:]]))[:2]
    chain[1, :2] = np.array([-device.stiffness * z[2], -device.damping * z[3]]) / device.mass
    own: FloatArray = (expm(chain * h) @ np.array([0.0, 0.0, 0.0, *force[1:]]))[:2]
    return rest - own + within


def by_the_line(device: Oscillator, z: FloatArray, after: FloatArray, h: float, _: Any) -> FloatArray:
    """Return the derivative by spring and damper as the docstring has it."""
    reach, push = motion(device, np.array([0.0, 0.0, *z[2:]]), (1.0, 0.0, 0.0), h)
    columns = []
    for scale, before, now in ((device.stiffness, z[0], after[0]), (device.damping, z[1], after[1])):
        columns.append([-scale * reach * (2.0 * before + now) / 3.0, -scale * push * (before + now) / 2.0])
    return np.array(columns).T


def by_differences(device: Oscillator, z: FloatArray, after: FloatArray, h: float, force: Any) -> FloatArray:
    """Return the derivative by spring and damper, by differences of the exponential."""
    steps = [np.eye(4)[at] * 1e-6 for at in (2, 3)]
    return np.array([(motion(device, z + d, force, h) - motion(device, z - d, force, h)) / 2e-6 for d in steps]).T


def in_numpy(
    board: Board, trace: dict[str, FloatArray], every: int, derivative: Callable[..., FloatArray]
) -> FloatArray:
    """Return the estimates of the filter at its turns, in matrices."""
    device, h = board.spec.nominal, board.dt_ms
    params = board.spec.identifiers["own"].params
    z, r = np.array([0.0, 0.0, 1.0, 1.0]), 0.05**2
    first = np.array([1.0, device.natural_frequency**2, 0.09, 0.09])
    p = np.diag(first)
    share, level = np.exp(-h * device.damping / (2.0 * device.mass)), 0.0
    walk = np.array([0.0, 0.0, params.stiffness_walk**2 * h, params.damping_walk**2 * h])
    found, ahead = [], np.arange(3) / 2.0 if board.spec.is_analogue else np.zeros(3)
    for tick, y in enumerate(trace["sensor.displacement"]):
        if tick:
            u, middle, end = 10.0 * np.sin(2e-3 * np.pi * 2000.0 * h * (tick - 1 + ahead))
            level = share * level + (1.0 - share) * u * u
            middle, end = middle - u, end - u
            force = tuple(device.force * one for one in (u, (4 * middle - end) / h, (4 * end - 8 * middle) / h**2))
            after, still = motion(device, z, force, h), np.array([0.0, 0.0, *z[2:]])
            j = np.eye(4)
            j[:2, :2] = np.column_stack([motion(device, still + np.eye(4)[at], (0.0, 0.0, 0.0), h) for at in (0, 1)])
            j[:2, 2:] = derivative(device, z, after, h, force)
            volt = np.append(motion(device, still, (0.01 * device.force, 0.0, 0.0), h), [0.0, 0.0])
            p = j @ p @ j.T + np.outer(volt, volt) + np.diag(np.where(np.diag(p) < first, walk, 0.0) * (level >= 1e-4))
            z = np.append(after, z[2:])
        if tick % every == 0:
            gain = p[:, 0] / (p[0, 0] + r) * ([1.0, 1.0, 0.0, 0.0] if level < 1e-4 else 1.0)
            z = z + gain * (y - z[0])
            keep = np.eye(4) - np.outer(gain, np.eye(4)[0])
            p = keep @ p @ keep.T + r * np.outer(gain, gain)
        found.append(z)
    return np.array(found)[::every]


@pytest.mark.parametrize(("every", "drive"), [(1, "held"), (3, "held"), (1, "analogue"), (2, "analogue")])
def test_it_is_the_filter_of_numpy(every: int, drive: str) -> None:
    board = bench({"drive": {"kind": drive}}, every=every)
    inject(board, stiffness=0.3, damping=0.5)
    trace = play(board, 300)
    wanted = in_numpy(board, trace, every, by_the_line)
    np.testing.assert_allclose(estimates(trace)[::every], wanted, rtol=1e-9, atol=1e-9)


def test_the_exact_derivative_gives_the_same_estimates_within_a_tenth_of_their_deviation() -> None:
    board = bench()
    inject(board, stiffness=0.3, damping=0.5)
    trace = play(board, 400)
    away = np.abs(in_numpy(board, trace, 1, by_differences) - estimates(trace))[50:, 2:]
    deviation = np.column_stack([trace[f"own.deviation.{name}"] for name in STATES[2:]])[50:]
    assert (away < 0.1 * deviation).all()


def test_errors_are_as_large_as_the_covariance_says() -> None:
    """NEES of four states is 4 on average and NIS 1, over devices drawn from the uncertainty of the start."""
    runs, ticks = 60, 250
    draws = 0.1 * np.random.default_rng(1).standard_normal((runs, 2))
    own = {"initial_stiffness_std": 0.1, "initial_damping_std": 0.1, "initial_std_um": 1e-3}
    squares, nis = [], []
    for seed, (stiffness, damping) in enumerate(draws, 1):
        board = bench({"seed": seed}, **own, stiffness_walk=0.0, damping_walk=0.0)
        inject(board, stiffness=stiffness, damping=damping)
        trace = play(board, ticks)
        true = [trace["plant.displacement"][-1], trace["plant.velocity"][-1], 1.0 + stiffness, 1.0 + damping]
        error, p = true - estimates(trace)[-1], covariance(board)
        squares.append(error @ np.linalg.solve(p, error))
        nis.append(trace["own.innovation_nis"][1:])
    assert np.mean(squares) == pytest.approx(4.0, abs=3.0 * np.sqrt(8.0 / runs))
    whole = np.array(nis)
    assert whole.mean() == pytest.approx(1.0, abs=3.0 * np.sqrt(2.0 / whole.size))


def covariance(board: Board) -> FloatArray:
    c = board.wiring.state("own").covariance
    rows = [[c.xx, c.xv, c.xk, c.xb], [c.xv, c.vv, c.vk, c.vb], [c.xk, c.vk, c.kk, c.kb], [c.xb, c.vb, c.kb, c.bb]]
    return np.array(rows)


def test_a_tone_shows_spring_and_damper_and_a_heavier_mass_as_a_softer_spring() -> None:
    for faults, wanted in (
        ({"stiffness": 0.5, "damping": 1.0}, (1.5, 2.0)),
        ({"added_mass": 0.1}, (1.0 - 0.1 * RHO, 1.0)),
        ({"drive_gain": -0.2}, ((1.0 - RHO) / 0.8 + RHO, 1.25)),
    ):
        board = bench()
        inject(board, **faults)
        trace = play(board, 4000)
        found = [trace[f"own.estimate.{name}"][2000:].mean() for name in STATES[2:]]
        np.testing.assert_allclose(found, wanted, rtol=5e-3)


def test_without_drive_the_factors_and_their_uncertainty_stay() -> None:
    board = bench()
    inject(board, stiffness=0.2)
    play(board, 1000)
    do(board, {"set": {"reference.amplitude_v": 0.0}})
    play(board, 1000)
    trace = play(board, 20_000)
    for name in ("estimate", "deviation"):
        assert all(np.ptp(trace[f"own.{name}.{factor}"]) == 0.0 for factor in STATES[2:])
    assert trace["own.estimate.stiffness"][-1] == pytest.approx(1.2, abs=0.1)
    assert trace["own.innovation_nis"].mean() == pytest.approx(1.0, abs=0.05)


def test_a_variance_does_not_grow_beyond_its_value_at_the_start() -> None:
    """A constant voltage shows the spring and not the damper."""
    trace = play(bench({"reference": {"kind": "constant", "amplitude_v": 10.0}}), 20_000)
    assert trace["own.deviation.damping"].max() == pytest.approx(0.3, rel=0.01)
    assert trace["own.deviation.stiffness"][-1] < 0.02


# -- as a diagnoser


def judged(values: dict[str, Any] | None = None, **own: Any) -> Board:
    return make({"diagnosers": {"own": {"kind": "ekf", **own}}, **NOISY, **(values or {})})


def test_it_finds_all_seven_steps() -> None:
    scenario = with_values(get("ch5-seven-step"), {"diagnosers": {"kalman": {"kind": "ekf"}}, "expect": []})
    metrics = run(scenario).metrics
    assert metrics["diagnosis.kalman.correct_fraction"] > 0.98
    assert metrics["diagnosis.kalman.nis"] == pytest.approx(1.0, abs=0.1)


def test_a_true_hypothesis_is_seldom_contradicted_and_the_distance_is_the_distance_of_its_covariance() -> None:
    board = judged({"sensor.noise_um": 0.02}, significance=1e-3)
    inject(board, added_mass=0.05)
    trace = play(board, 8000)
    settled = slice(500, None)
    assert trace["own.consistent.m+5"][settled].mean() > 0.998
    assert trace["own.distance.m+5"][settled].mean() < 2.5
    c = board.wiring.state("own").covariance
    away = np.array([trace["own.stiffness"][-1] - (1.0 - 0.05 * RHO), trace["own.damping"][-1] - 1.0])
    square = away @ np.linalg.solve([[c.kk, c.kb], [c.kb, c.bb]], away)
    assert trace["own.distance.m+5"][-1] == pytest.approx(square, rel=1e-9)
    np.testing.assert_array_equal(trace["own.consistent.m+5"] > 0.0, trace["own.distance.m+5"] <= -2.0 * np.log(1e-3))


def test_its_verdicts_are_normal_isolated_ambiguous_and_unknown() -> None:
    alike = 1.0 - 0.05 * RHO
    hypotheses = [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "k+10", "stiffness": 1.1}]
    for more, fault, verdict in (
        ([], {}, 0.0),
        ([], {"added_mass": 0.05}, 2.0),
        ([{"name": "alias", "stiffness": alike}], {"added_mass": 0.05}, 3.0),
        ([], {"stiffness": 0.3, "damping": 1.0}, 4.0),
    ):
        board = judged({"sensor.noise_um": 0.02}, hypotheses=hypotheses + more)
        inject(board, **fault)
        assert play(board, 2000)["own.verdict"][-1] == verdict


def test_a_fault_lasts_while_the_drive_is_off() -> None:
    board = judged()
    inject(board, stiffness=0.1)
    assert play(board, 2000)["own.verdict"][-1] == 2.0
    do(board, {"set": {"reference.amplitude_v": 0.0}})
    trace = play(board, 50_000)
    assert (trace["own.verdict"] > 0.0).all()
    do(board, {"set": {"reference.amplitude_v": 10.0}})
    do(board, {"heal": ["stiffness"]})
    assert play(board, 2000)["own.verdict"][-1] == 0.0
