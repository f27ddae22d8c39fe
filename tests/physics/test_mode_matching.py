"""Electrostatic tuning of a gyroscope: softening, pull-in, matched modes, and its read-out at three splits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import welch

from core.device.catalogue import device
from core.device.two_axis import TwoAxis
from core.errors import InputError
from tests.tuned import (
    BOLTZMANN,
    D_X,
    D_Y,
    GAP,
    K_X,
    K_XY,
    K_Y,
    MASS_X,
    MASS_Y,
    OMEGA,
    ran,
    softening,
    split_hz,
    stiffness_of_y,
    volts_for,
)
from tests.two_axis import held


def test_a_voltage_softens_the_spring_of_the_sense_axis() -> None:
    """The motion by the matrix exponential of a device with the softer spring, under the forces of the trace."""
    result = ran(20.0, {"controllers.tuning_voltage.voltage_v": 8.0, "sample_rate_khz": 100})
    mass = np.diag([1.0 / MASS_X, 1.0 / MASS_Y])
    spring = mass @ np.array([[K_X, K_XY], [K_XY, K_Y - softening(8.0)]])
    phi, gamma = held(spring, mass @ np.diag([D_X, D_Y]), 1.0, 0.01)
    late, _ = held(mass @ np.array([[K_X, K_XY], [K_XY, K_Y]]), mass @ np.diag([D_X, D_Y]), 1.0, 0.01)
    forces = np.column_stack([result.signal("drive.x.force") / MASS_X, result.signal("drive.y.force") / MASS_Y])
    q, seen = np.zeros(4), [np.zeros(4)]
    for force in forces[:-1]:
        q = phi @ q + gamma @ force
        seen.append(q)
    y = np.array(seen)[:, 1]
    assert np.abs(result.signal("plant.y") - y).max() < 1e-9 * np.abs(y).max()
    assert np.abs(late - phi).max() > 1e-4
    assert result.signal("plant.split")[-1] == pytest.approx(split_hz(8.0), rel=1e-9)


def test_the_device_says_where_its_modes_match_and_where_it_is_pulled_in() -> None:
    found = device({"id": "gyro-c", "electrodes": {"tuning": {}}}).metrics()
    assert found["gyro.split_hz"] == pytest.approx(split_hz(0.0), rel=1e-3)
    assert found["gyro.matching_v"] == pytest.approx(volts_for(0.0), rel=1e-9)
    free = K_Y - K_XY**2 / K_X
    assert found["gyro.pull_in_v"] == pytest.approx(np.sqrt(free / softening(1.0)), rel=1e-9)
    tuned = device({"id": "gyro-c", "electrodes": {"tuning": {}}}).oscillator()
    assert isinstance(tuned, TwoAxis)
    assert np.linalg.eigvalsh(tuned.tuned(0.9999 * found["gyro.pull_in_v"]).stiffnesses).min() > 0.0
    assert np.linalg.eigvalsh(tuned.tuned(1.0001 * found["gyro.pull_in_v"]).stiffnesses).min() < 0.0


@pytest.mark.parametrize("volts", [0.0, 5.0, 8.5])
def test_pilot_tones_measure_the_split_of_the_closed_form(volts: float) -> None:
    changes = {
        "slots.tuning": "mode_matching",
        "controllers.mode_matching": {"start_v": volts, "settle_ms": 250.0},
        "sample_rate_khz": 100,
        "device.gyroscope": {"stiffness_xy_n_m": 0.0},  # the carrier has the frequency of x alone
        "rate.deg_per_s": 50.0,
    }
    result = ran(360.0, changes)
    assert result.signal("mode_matching.split")[-1] == pytest.approx(split_hz(volts), rel=0.01)


@pytest.mark.parametrize("late", [0, 1])
def test_mode_matching_removes_the_split_whatever_the_delay(late: int) -> None:
    changes = {
        "slots.tuning": "mode_matching",
        "board.delay_samples": late,
        "sample_rate_khz": 50,  # a sample is 28 degrees
        "rate.deg_per_s": 20.0,
        "controllers.mode_matching": {"settle_ms": 130.0},
    }
    result = ran(1300.0, changes)
    assert abs(result.signal("plant.split")[-1]) < 0.01 * split_hz(0.0)
    assert result.signal("mode_matching.tuning")[-1] == pytest.approx(volts_for(0.0), rel=0.01)


def test_mode_matching_follows_a_spring_that_changes_and_keeps_the_scale() -> None:
    fault = {"at_ms": 1260.0, "fault": "sense_stiffness", "severity": 0.003}
    changes = {
        "slots.tuning": "mode_matching",
        "rate.deg_per_s": 20.0,
        "events": [fault],
        "device.gyroscope": {"stiffness_xy_n_m": 0.0},
    }
    result = ran(2490.0, changes)
    before, after = 1240 * 20, -1
    for at in (before, after):
        assert abs(result.signal("plant.split")[at]) < 0.01 * split_hz(0.0)
        assert result.signal("open_loop_rate.rate")[at] == pytest.approx(20.0, rel=0.01)
    assert result.signal("plant.split")[1270 * 20] > 5.0


def test_a_desired_split_is_held() -> None:
    changes = {"slots.tuning": "mode_matching", "controllers.mode_matching": {"split_hz": 20.0, "settle_ms": 130.0}}
    assert ran(1000.0, changes).signal("plant.split")[-1] == pytest.approx(20.0, rel=0.01)


def low_pass(hz: np.ndarray, corner: float) -> np.ndarray:
    return 1.0 / (1.0 + 1j * hz / corner) ** 2


def through(hz: np.ndarray, volts: float) -> np.ndarray:
    """Return the transfer from a rate to its reading: y is read at the carrier, the rate is beside it."""
    at = stiffness_of_y(np.array(OMEGA), volts)
    upper, lower = (at / stiffness_of_y(OMEGA + side * 2e-3 * np.pi * hz, volts) for side in (1.0, -1.0))
    found: np.ndarray = 0.5 * (upper + np.conj(lower)) * low_pass(hz, 20.0)
    return found


@pytest.mark.parametrize("split", [53.16, 15.0, 0.0])
def test_the_bandwidth_at_a_split_is_that_of_the_sense_axis_and_the_low_pass(split: float) -> None:
    changes = {
        "controllers.tuning_voltage.voltage_v": volts_for(split) if split < 53.0 else 0.0,
        "rate": {"kind": "step", "deg_per_s": 100.0, "start_ms": 500.0},
        "device.gyroscope": {"stiffness_xy_n_m": 0.0},
    }
    found = ran(2000.0, changes).metrics["rate.bandwidth_hz"]
    hz = np.linspace(0.01, 100.0, 10_000)
    below = hz[np.abs(through(hz, volts_for(split))) < np.sqrt(0.5)][0]
    assert found == pytest.approx(below, rel=0.03)


@pytest.mark.parametrize("split", [53.16, 15.0, 0.0])
def test_the_rate_noise_at_a_split_is_that_of_pick_off_and_damping(split: float) -> None:
    """Pick-off: n |D|/(sqrt 2 2 m w A); damping: sqrt 2 sqrt(4 k T d)/(2 m w A) times the share of y beside w."""
    volts = volts_for(split) if split < 53.0 else 0.0
    changes = {
        "controllers.tuning_voltage.voltage_v": volts,
        "plant.thermal_noise": True,
        "sensor.noise_pm_rthz": 0.5,
        "sample_rate_khz": 15,
        "device.gyroscope": {"stiffness_xy_n_m": 0.0},
    }
    read = ran(17_000.0, changes).signal("open_loop_rate.rate")[15_000:]
    hz, density = welch(read, fs=15_000.0, nperseg=30_000)
    used = (hz >= 1.0) & (hz <= 20.0)
    per_force = np.degrees(1e3 / (2.0 * MASS_Y * OMEGA * 5.0))
    at = stiffness_of_y(np.array(OMEGA), volts)
    pick_off = 0.5 * (per_force * abs(at) * 0.5e-6) ** 2
    sides = [np.abs(at / stiffness_of_y(OMEGA + side * 2e-3 * np.pi * hz, volts)) ** 2 for side in (1.0, -1.0)]
    thermal = (per_force * 1e6) ** 2 * 4.0 * BOLTZMANN * 300.0 * D_Y * 1e-3 * (sides[0] + sides[1])
    expected = (pick_off + thermal) * np.abs(low_pass(hz, 20.0)) ** 2
    assert np.sqrt((density[used] / expected[used]).mean()) == pytest.approx(1.0, abs=0.1)


def test_pull_in_is_refused_or_stops_the_board() -> None:
    with pytest.raises(InputError, match=r"56.01 V pulls the mass into the tuning electrode; its pull-in is at 56 V"):
        ran(1.0, {"controllers.tuning_voltage.voltage_v": 56.01})
    event = {"at_ms": 5.0, "fault": "sense_stiffness", "severity": -0.1}
    result = ran(20.0, {"controllers.tuning_voltage.voltage_v": 54.0, "events": [event]})
    assert result.trip is not None
    assert (result.trip.reason, result.trip.signal) == ("the tuning electrode pulled the mass in", "plant.pulled_in")
    assert result.trip.time_ms == pytest.approx(5.0, abs=0.2)


def test_a_swing_beyond_the_unstable_point_is_a_pull_in() -> None:
    """The electrode wins beyond g sqrt(1 - V/V_pi): pV^2 g y/(g^2 - y^2)^2 = k y, and so says the motion."""
    volts, limit = 30.0, np.sqrt((K_Y - K_XY**2 / K_X) / softening(1.0))
    y = GAP * np.sqrt(1.0 - volts / limit)
    pull = softening(volts) * GAP**3 * GAP * y / (GAP**2 - y**2) ** 2
    assert pull == pytest.approx((K_Y - K_XY**2 / K_X) * y, rel=1e-9)

    def motion(t: float, q: np.ndarray) -> list[float]:
        pulled = softening(volts) * GAP**3 * GAP * q[0] / (GAP**2 - q[0] ** 2) ** 2
        return [q[1], (pulled - (K_Y - K_XY**2 / K_X) * q[0] - D_Y * q[1]) / MASS_Y]

    def touches(t: float, q: np.ndarray) -> float:
        return float(q[0] - 0.999 * GAP)

    touches.terminal = True  # type: ignore[attr-defined]
    for start, stops in ((0.99 * y, False), (1.01 * y, True)):
        assert (solve_ivp(motion, (0.0, 2.0), [start, 0.0], events=touches, rtol=1e-8).status == 1) == stops
        changes = {"controllers.tuning_voltage.voltage_v": volts, "plant.initial_y_um": float(start)}
        assert (ran(0.003, changes | {"sample_rate_khz": 1000}).trip is not None) == stops


@pytest.mark.parametrize(
    ("changes", "field", "words"),
    [
        ({"device": {"id": "gyro-c"}}, "plant.model", "no tuning electrode"),
        ({"plant.model": "gyroscope"}, "slots.tuning", "tuning"),
        ({"slots.tuning": "drive_loop"}, "slots.tuning", "stands in slot drive"),
        ({"controllers.mode_matching": {"gain": 2.0}}, "controllers.mode_matching.gain", "1"),
    ],
)
def test_tuning_that_does_not_fit_is_refused(changes: dict[str, Any], field: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        ran(1.0, changes)
    assert caught.value.field == field and words in str(caught.value), caught.value
