"""Sideways motion and rotation: heat, pull-in, folds, contact, exchange of plants."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.plant.equilibrium import bias_pull_in
from scenarios.measure.lateral import lateral_metrics
from tests.lab import do, play, rms
from tests.physics.plane import EPS, KT, XR, XS, G, N, T, bench, insides

SOFT_ADHESION = {
    "lateral_stiffness_n_m": 26.9,
    "lateral_reach_um": 40.0,
    "rotation_stiffness_nm": 8.05e-8,
    "rotation_reach_um": 1e6,
    "cubic_n_m3": 2.4e7,
    "sideways_per_m": 858.0,
    "turn_rad_m": 185.0,
    "turn_cubic_rad_m3": 1.28e11,
}
"""The suspension with thin trusses and an adhesion; its k1 of 0.0753 N/m goes to the device."""


# -- heat


@pytest.mark.long
@pytest.mark.parametrize("factor", [1.0, 5.0])
def test_thermal_motion_obeys_equipartition(factor):
    """kT/2 in each of x, y and theta, whatever the damping: 0.2775 nm, 4.49 pm, 95.8 nrad."""
    board = bench(0.0, thermal_noise=True)
    if factor != 1.0:
        do(board, {"fault": "damping", "severity": factor - 1})
    play(board, 2000)
    trace = play(board, 400_000 if factor == 1.0 else 200_000)
    assert rms(trace["plant.displacement"]) == pytest.approx(math.sqrt(KT / 0.0538) * 1e6, rel=0.03)
    assert rms(trace["plant.displacement"]) == pytest.approx(0.2775e-3, rel=0.03)
    assert rms(trace["plant.shift"]) == pytest.approx(math.sqrt(KT / 205.4) * 1e6, rel=0.04)
    assert rms(trace["plant.rotation"]) == pytest.approx(math.sqrt(KT / 4.51e-7) * 1e3, rel=0.04)
    assert rms(trace["plant.rotation"]) == pytest.approx(95.8e-6, rel=0.04)


# -- pull-in by the bias


def pull_in(board):
    p, s = insides(board)
    return bias_pull_in(p, s.suspension)


def test_pull_in_by_the_bias_alone():
    closed = math.sqrt(4.51e-7 * (G * 1e-6) ** 3 / (4 * N * EPS * T * 1e-6 * (XR**3 - XS**3) * 1e-18 / 3))
    assert closed == pytest.approx(28.08, rel=5e-3)
    assert pull_in(bench()) == pytest.approx(closed, rel=1e-4)
    for values, volts in (
        ({"misalignment_mrad": 0.1}, 26.85),
        ({"misalignment_mrad": 0.5}, 24.48),
        ({"misalignment_um": 0.1}, 27.79),
    ):
        assert pull_in(bench(**values)) == pytest.approx(volts, rel=0.01)
    # sideways alone, with the rotation held: k_y g^3 = 4 n eps t L V^2
    stiff = bench(rotation_stiffness_nm=1e-5)
    sideways = math.sqrt(205.4 * (G * 1e-6) ** 3 / (4 * N * EPS * T * 1e-6 * 40e-6))
    assert sideways == pytest.approx(87.8, rel=5e-3)
    assert pull_in(stiff) == pytest.approx(sideways, rel=1e-3)


def test_the_far_finger_is_told_where_the_shuttle_can_rest():
    """The trusses let it turn into the stators from 28.08 V of bias on: nothing rests at 1 um then."""
    for bias, rests in ((10.0, True), (27.9, True), (28.3, False), (40.0, False)):
        board = bench(bias, {"reference": {"kind": "constant", "amplitude_v": 0.0}})
        play(board, 10)
        assert ("lateral.far_ratio" in lateral_metrics(board)) == rests, bias


def test_fingers_further_apart_than_drawn_pull_in_later():
    """n eps0 t stays and the gap of the closed form is the one given: as of a device etched with that gap."""
    closed = math.sqrt(4.51e-7 * 3e-6**3 / (4 * N * EPS * T * 1e-6 * (XR**3 - XS**3) * 1e-18 / 3))
    assert pull_in(bench(gap_um=3.0)) == pytest.approx(closed, rel=5e-3)
    drawn = bench(values={"device.finger_gap_um": 3.0})
    assert pull_in(bench(gap_um=3.0)) == pytest.approx(pull_in(drawn), rel=1e-9)


def test_pull_in_of_a_perfect_device_waits_for_noise():
    quiet = bench(29.0)
    trace = play(quiet, 200)
    assert quiet.trip is None and np.all(trace["plant.lateral"] == 0.0)
    assert play(bench(27.5, thermal_noise=True), 500)["plant.contact"].max() == 0.0
    times = []
    for seed in range(1, 6):
        noisy = bench(29.0, {"seed": seed}, thermal_noise=True)
        play(noisy, 200)
        assert noisy.trip is not None and "touched" in noisy.trip.reason
        times.append(lateral_metrics(noisy)["lateral.contact_ms"])
    assert 0.1 < min(times) and max(times) < 0.6


# -- folds


def folded(bias, fault=None, parameters=None, **plant):
    board = bench(bias, **plant)
    if fault:
        do(board, {"fault": fault, "severity": 1.0, "parameters": parameters or {}})
    board.advance(2)
    return lateral_metrics(board)


@pytest.mark.parametrize(
    ("bias", "fault", "parameters", "volts", "travel"),
    [
        (10, None, None, 19.61, 10.70),
        (20, None, None, 9.67, None),
        (10, "point_adhesion", {}, 17.4, 7.66),
        (20, "point_adhesion", {}, 8.00, None),
        (10, "broken_truss", {}, 14.0, None),
        (20, "broken_truss", {}, 4.82, None),
        (10, "broken_truss", {"extent": "whole"}, 8.26, None),
    ],
)
def test_largest_drive_against_another_program(bias, fault, parameters, volts, travel):
    """Voltages by an independent prototype with the rows of its own frame program."""
    found = folded(bias, fault, parameters)
    assert found["lateral.fold_v"] == pytest.approx(volts, rel=0.025)
    if travel:
        assert found["lateral.fold_um"] == pytest.approx(travel, rel=0.01)


def test_lateral_displacement_at_the_fold_is_no_third_of_the_gap():
    found = folded(10, misalignment_mrad=0.1)
    assert found["lateral.fold_v"] == pytest.approx(18.5, rel=0.01)
    assert found["device.pull_in_v"] == pytest.approx(26.85, rel=0.01)
    assert 0.1 * G < found["lateral.fold_lateral_um"] < 0.2 * G < G / 3


def test_the_shuttle_goes_where_the_fold_says():
    """Held just below the fold it stays; just beyond, it touches."""
    at = folded(10, misalignment_mrad=0.1)["lateral.fold_v"]
    for volts, contact in ((0.985 * at, False), (1.02 * at, True)):
        reference = {"kind": "sine", "amplitude_v": -volts, "frequency_hz": 50.0}
        board = bench(10, {"reference": reference}, misalignment_mrad=0.1)
        play(board, 520)
        assert (board.trip is not None) == contact


# -- contact and short


def ramped(step_us: float, **values: Any):
    """4.75 V/ms on the device with thin trusses and an adhesion, at 5 V of bias."""
    ramp = {"kind": "sine", "amplitude_v": 475.0, "frequency_hz": 10.0 / (2 * math.pi)}
    return bench(
        5.0,
        {"device.stiffness_n_m": 0.0753, "reference": ramp, "drive.kind": "analogue", **values},
        step_us=step_us,
        near_step_us=min(step_us, 0.1),
        **SOFT_ADHESION,
    )


def test_contact_time_does_not_depend_on_the_step():
    times = []
    for step in (0.25, 0.1, 0.05):
        board = ramped(step)
        trace = play(board, 400)
        assert board.trip is not None and np.all(np.isfinite(trace["plant.lateral"]))
        times.append(lateral_metrics(board)["lateral.contact_ms"])
    assert np.ptp(times) < 1e-3
    assert times == pytest.approx([1.855] * 3, abs=0.01)  # the same ramp by an independent prototype
    fine = ramped(0.1, sample_rate_khz=1000)
    assert abs(play(fine, 4000)["plant.displacement"][-1]) == pytest.approx(2.40, rel=0.03)


def test_a_short_stays_until_the_board_is_reset():
    board = ramped(0.25, **{"guard.stop_on_contact": False})
    play(board, 250)
    assert board.value("plant.short") != 0.0
    do(board, {"set": {"reference": {"kind": "constant", "amplitude_v": 0.0}}})
    trace = play(board, 500)
    assert np.all(trace["plant.short"] == trace["plant.short"][0]) and trace["plant.short"][0] != 0.0
    assert np.all(np.isfinite(trace["plant.displacement"]))
    stopped = ramped(0.25)
    play(stopped, 400)
    do(stopped, {"reset_trip": True})
    assert stopped.value("plant.short") == 0.0


def test_insulated_fingers_stay_latched_without_any_drive():
    """Hysteresis: the bias alone holds the fingers that the drive has pulled in."""
    board = ramped(0.25, **{"guard.stop_on_contact": False, "plant.short_on_contact": False})
    play(board, 250)
    do(board, {"set": {"reference": {"kind": "constant", "amplitude_v": 0.0}}})
    trace = play(board, 500)
    assert trace["plant.contact"][-100:].min() == 1.0 and trace["plant.short"].max() == 0.0
    assert abs(trace["plant.lateral"][-1]) == pytest.approx(G - 0.15, abs=0.02)


# -- plants are exchanged while running


def test_plants_are_exchanged_while_running():
    values = {"reference": {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 2000.0}}
    board = bench(3.0, values, turn_rad_m=30.0)  # the slaved plant has no rest at 10 V
    first = play(board, 100)
    assert abs(first["plant.rotation"]).max() > 0.01
    for model in ("linear", "planar", "slaved_lateral", "nonlinear", "planar"):
        # what only the old plant has is left behind
        before = board.value("plant.displacement")
        do(board, {"set": {"plant.model": model}})
        trace = play(board, 40)
        assert abs(trace["plant.displacement"][0] - before) < 1.0
        if model in ("linear", "nonlinear"):
            for tap in ("lateral", "shift", "shift_velocity", "rotation", "rotation_velocity", "contact", "short"):
                assert np.all(trace[f"plant.{tap}"] == 0.0)
    assert board.trip is None
