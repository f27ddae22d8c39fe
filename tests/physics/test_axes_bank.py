"""Kalman bank of two axes: against the filter of all five states, and against faults put on a board."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.diagnose.axes_model import over_a_tick
from core.errors import InputError
from tests.lab import do, inject, make, play
from tests.two_axis import DAMPING, GYRO, MASS, OMEGA, STIFFNESS, TURN, held

H = 0.01
NOISE_UM = 0.1e-6 * np.sqrt(0.5e5)
THERMAL = 2.0 * 1.380649e-23 * 300.0 / 1e-5 * 1e12 * 1e-3
"""2 k T / h, in uN^2 per uN ms/um."""
STATES = ("x", "y", "x_velocity", "y_velocity", "rate")
STEP = {"kind": "step", "deg_per_s": 300.0, "start_ms": 300.0}


def bank(rate: dict[str, Any] | None = None, device: str = "gyro-a", **parameters: Any) -> Any:
    diagnosers = {"bank": {"kind": "axes_bank", **parameters}}
    return make({"device.id": device, "diagnosers": diagnosers, "rate": rate or {"kind": "constant"}}, base=GYRO)


def turning(omega: float) -> np.ndarray:
    """Return the transition at a rate in rad/ms."""
    return held(STIFFNESS, DAMPING + 2.0 * MASS * omega * TURN, MASS, H)[0]


def test_a_filter_is_that_of_all_five_states():
    """The rate does not walk; the covariances are iterated until they are steady, with the rate known, and then
    without."""
    board = bank({"kind": "constant", "deg_per_s": 300.0}, rate_walk_dps_rt_s=0.0)
    trace = play(board, 400)
    phi, gamma = held(STIFFNESS, DAMPING, MASS, H)
    turn = (turning(1e-3) - turning(-1e-3)) / 2e-3
    assumed = (DAMPING[0, 0] * OMEGA * np.array([0.02, 0.003])) ** 2
    noise = gamma @ (THERMAL * DAMPING + np.diag(assumed)) @ gamma.T
    seen, r = np.eye(5)[:2], NOISE_UM**2 * np.eye(2)
    p = np.eye(4) * 1e-6
    for _ in range(20_000):
        p = phi @ p @ phi.T + noise
        p -= p[:, :2] @ np.linalg.solve(p[:2, :2] + r, p[:2])
    covariance, state = np.zeros((5, 5)), np.zeros(5)
    covariance[:4, :4], covariance[4, 4] = p, np.radians(0.3) ** 2
    forces = np.column_stack([trace["drive.x.force"], trace["drive.y.force"]])
    measured = np.column_stack([trace["sensor.x.displacement"], trace["sensor.y.displacement"]])
    for i in range(400):
        whole = np.eye(5)
        whole[:4, :4], whole[:4, 4] = phi, turn @ state[:4]
        force = forces[i - 1] if i else np.zeros(2)
        state[:4] = phi @ state[:4] + gamma @ force + state[4] * turn @ state[:4]
        covariance = whole @ covariance @ whole.T
        covariance[:4, :4] += noise
        psi = seen @ covariance @ seen.T + r
        residual = measured[i] - state[:2]
        gain = np.linalg.solve(psi, seen @ covariance).T
        state, covariance = state + gain @ residual, covariance - gain @ seen @ covariance
        now = [trace[f"bank.{port}.healthy"][i] for port in ("residual_x", "residual_y")]
        np.testing.assert_allclose(now, residual, atol=1e-4 * NOISE_UM, err_msg=str(i))
        gains = [trace[f"bank.gain_{row}_{axis}.healthy"][i] for row in STATES for axis in "xy"]
        expected = np.vstack([gain[:4], np.degrees(gain[4:]) * 1e3])
        size = np.abs(expected).max(axis=1, keepdims=True) + 1e-300  # the rate's is 0 without rotation
        np.testing.assert_allclose(np.reshape(gains, (5, 2)) / size, expected / size, atol=1e-3, err_msg=str(i))
        assert trace["bank.nis.healthy"][i] == pytest.approx(0.5 * residual @ np.linalg.solve(psi, residual), rel=1e-3)
    assert trace["bank.rate.healthy"][-1] == pytest.approx(np.degrees(state[4]) * 1e3, rel=1e-4)
    assert abs(np.degrees(state[4]) * 1e3) > 1.0


def test_a_model_over_a_tick():
    """Forces that are a parabola over the tick, by an integrator; the turn by a difference."""
    device = bank().spec.nominal
    tick = over_a_tick(device, H)
    np.testing.assert_allclose(tick.phi, turning(0.0), rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(tick.turn, (turning(1e-3) - turning(-1e-3)) / 2e-3, atol=1e-9)
    start, middle, end = np.array([0.3, -0.2]), np.array([0.5, 0.1]), np.array([-0.1, 0.7])
    at = np.array([0.0, 0.5, 1.0]) * H
    parabola = [np.polyfit(at, [start[axis], middle[axis], end[axis]], 2) for axis in (0, 1)]

    def slope(t: float, q: np.ndarray) -> np.ndarray:
        force = np.array([np.polyval(shape, t) for shape in parabola])
        return np.concatenate([q[2:], (force - STIFFNESS @ q[:2] - DAMPING @ q[2:]) / MASS])

    moved = solve_ivp(slope, (0.0, H), np.zeros(4), rtol=1e-12, atol=1e-18).y[:, -1]
    forces = np.column_stack([start, middle - start, end - start]).ravel()
    np.testing.assert_allclose(tick.push @ forces, moved, rtol=1e-9)


def test_residuals_of_the_truth_are_as_large_as_they_should_be():
    """With exactly the noise of the model the squares are 1 on average: 0.7 % is three standard errors."""
    board = bank(drive_noise=0.0, sense_noise=0.0, rate_walk_dps_rt_s=0.0)
    play(board, 20_000)
    nis = play(board, 200_000)["bank.nis.healthy"]
    assert nis.mean() == pytest.approx(1.0, abs=0.007)
    assert nis.var() == pytest.approx(1.0, abs=0.03)


FAULTS = [
    ("quadrature", 500.0, "quadrature+500"),
    ("drive_loss", 0.5, "drive-50"),
    ("sense_stiffness", 0.01, "sense+1"),
    ("package_leak", 125.0, "damping-x2"),
]


@pytest.mark.parametrize(("fault", "severity", "name"), FAULTS)
def test_a_fault_is_found_and_kept_through_a_step_of_the_rate(fault, severity, name):
    board = bank(STEP)
    play(board, 20_000)
    inject(board, **{fault: severity})
    trace = play(board, 20_000)
    truth = board.scores()["bank"].names.index(name)
    assert np.all(trace["bank.truth"] == truth)
    assert (trace["bank.winner"] == truth).mean() > 0.98
    assert 0.0 < trace["bank.delay"][9000] < 100.0
    assert trace[f"bank.rate.{name}"][-1] == pytest.approx(300.0, abs=5.0)


def test_a_rate_is_no_fault():
    board = bank(STEP)
    play(board, 40_000)
    scores = board.scores()["bank"]
    assert scores.truth == scores.winner == 0 and scores.correct_fraction > 0.998
    assert board.value("bank.rate.healthy") == pytest.approx(300.0, abs=5.0)


def test_without_the_rate_as_a_state_a_rate_is_taken_for_faults():
    board = bank(STEP, rate_std_dps=0.0, rate_walk_dps_rt_s=0.0)
    play(board, 30_000)
    assert (play(board, 10_000)["bank.winner"] == 0.0).mean() < 0.8


def test_an_axis_at_rest_does_not_look_stiffer():
    """gyro-c, rebalanced for a second and a half: nothing moves along y but noise, which favours the stiffer model."""
    for least, believed in ((0.02, 0.0), (0.0, 3.0)):
        board = bank(device="gyro-c", least_evidence_nat=least)
        play(board, 100_000)
        assert np.all(play(board, 50_000)["bank.winner"] == believed)


def test_damping_that_is_taken_for_less_drive_without_coupling():
    board = bank(device="gyro-c")
    play(board, 20_000)
    inject(board, package_leak=125.0)
    winner = play(board, 20_000)["bank.winner"]
    assert 0.2 < (winner == 2.0).mean() == pytest.approx((winner != 4.0).mean(), abs=0.01)


def test_a_bank_that_looks_at_every_fifth_sample_follows_the_forces_of_all():
    board = bank(every=5)
    play(board, 20_000)
    inject(board, quadrature=500.0)
    trace = play(board, 10_000)
    assert (trace["bank.winner"] == 1.0).mean() > 0.98
    nis = trace["bank.nis.quadrature+500"][5000:]
    assert 0.7 < nis.mean() < 1.1


def test_the_truth_is_what_a_hypothesis_says_and_nothing_else():
    board = bank()

    def truth_with(**faults: float) -> float:
        inject(board, **faults)
        truth = play(board, 2)["bank.truth"][-1]
        do(board, {"heal": list(faults)})
        return float(truth)

    assert [truth_with(**{fault: severity}) for fault, severity, _ in FAULTS] == [1.0, 2.0, 3.0, 4.0]
    assert truth_with(quadrature=400.0) == -1.0
    assert truth_with(quadrature=0.5) == 0.0
    assert truth_with(quadrature=500.0, drive_loss=0.5) == -1.0
    assert truth_with(finger_pair_short=1.0) == -1.0
    assert truth_with(added_mass=0.05) == -1.0
    assert truth_with(stiffness=0.05) == -1.0
    assert play(board, 2)["bank.truth"][-1] == 0.0


def test_a_board_that_starts_anew_keeps_what_was_scored():
    board = bank()
    play(board, 2000)
    inject(board, quadrature=9e5)
    play(board, 20_000)
    assert board.trip is not None
    before = board.scores()["bank"]
    do(board, {"heal": "all"})
    do(board, {"reset_trip": True})
    assert board.scores()["bank"] == before
    play(board, 2000)
    assert board.trip is None and board.scores()["bank"].truth == 0


def test_what_does_not_fit_is_refused():
    with pytest.raises(InputError, match="needs x, y; linear has one displacement"):
        make({"diagnosers": {"bank": {"kind": "axes_bank"}}})
    with pytest.raises(InputError, match="is for one displacement"):
        make({"diagnosers": {"bank": {"kind": "mmae"}}}, base=GYRO)
    with pytest.raises(InputError, match="a occurs twice"):
        bank(hypotheses=[{"name": "a"}, {"name": "a", "mass": 1.1}])
