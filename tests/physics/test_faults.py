"""Faults against their declared changes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.board.instances import faults_of
from tests.lab import RICH, do, inject, make, play

STILL = {"reference": {"kind": "constant", "amplitude_v": 0.0}}
PLANTS = ("linear", "nonlinear", "planar", "slaved_lateral")
LCR = {"device": {"id": "lcr-350"}}


@pytest.mark.parametrize("plant", PLANTS)
def test_severity_0_is_bit_for_bit_no_fault(plant):
    values = {"plant.model": plant, "device.id": "lcr-350"}
    healthy = make(values, base=RICH)
    play(healthy, 300)
    for fault in faults_of(()):
        board = make(values, base=RICH)
        do(board, {"fault": fault, "severity": 0.0})
        play(board, 300)
        assert board.digest() == healthy.digest(), fault


@pytest.mark.parametrize("plant", PLANTS)
def test_a_healed_fault_leaves_no_effect(plant):
    board = make({"plant.model": plant, "device.id": "lcr-350", "guard.stop_on_contact": False}, base=RICH)
    for fault, block in faults_of(()).items():
        do(board, {"fault": fault, "severity": block.suggested})
    play(board, 20)
    do(board, {"heal": "all"})
    play(board, 1)
    healthy = make({"plant.model": plant, "device.id": "lcr-350"}, base=RICH)
    play(healthy, 1)
    for name, place in board.wiring.index.items():
        if name.startswith("effects."):
            assert board.wiring.w[place] == healthy.wiring.w[place], name


@pytest.mark.parametrize("plant", ["linear", "nonlinear", "planar"])
def test_stiction_has_a_dead_band(plant):
    """F_s = 20 nN over k = 0.0538 N/m is 0.3717 um, which is 0.681 V at 545.5 nm/V."""
    values = {**LCR, "plant.model": plant, "plant.thermal_noise": False}
    if plant == "nonlinear":
        values["plant.cubic_n_m3"] = 0.0
    for volts, moves in ((0.66, False), (0.70, True)):
        board = make({**values, "reference": {"kind": "constant", "amplitude_v": volts}})
        inject(board, stiction=20.0)
        x = play(board, 600)["plant.displacement"]
        assert (abs(x[-1]) > 0.0) == moves
    # released at 1 um it stops within the dead band, for good, and not at zero
    board = make({**values, **STILL, "plant.initial_displacement_um": 1.0})
    inject(board, stiction=20.0)
    trace = play(board, 1500)
    x, v = trace["plant.displacement"], trace["plant.velocity"]
    assert 0.0 < abs(x[-1]) <= 0.3717 and np.all(x[-200:] == x[-1]) and np.all(v[-200:] == 0.0)


def test_friction_takes_four_times_the_dead_band_off_every_cycle():
    """Without damping, Coulomb friction lowers the amplitude by 4 F/k a cycle."""
    values = {**LCR, **STILL, "plant.thermal_noise": False, "device.damping_ns_m": 1e-30}
    values |= {"plant.initial_displacement_um": 8.0, "sample_rate_khz": 1000}
    for plant in ("linear", "planar"):
        board = make({**values, "plant.model": plant})
        inject(board, stiction=20.0)
        x = play(board, 2000)["plant.displacement"]
        tops = [x[i] for i in range(1, len(x) - 1) if x[i] > x[i - 1] and x[i] >= x[i + 1] and x[i] > 0.5]
        assert -np.diff([8.0, *tops]) == pytest.approx(4 * 0.02 / 0.0538, rel=0.01)


@pytest.mark.parametrize("plant", ["linear", "nonlinear", "planar"])
def test_shock_along_the_drive(plant):
    """A slow pulse is quasi-static: 40.3 nm per g, against the acceleration."""
    values = {**LCR, **STILL, "plant.model": plant, "plant.thermal_noise": False}
    if plant == "nonlinear":
        values["plant.cubic_n_m3"] = 0.0
    board = make(values)
    do(board, {"fault": "shock", "severity": 20.0, "parameters": {"pulse_ms": 40.0}})
    trace = play(board, 6000)
    static = 2.209e-10 * 9.80665 / 0.0538 * 1e6
    assert static == pytest.approx(0.0403, rel=2e-3)
    assert trace["plant.displacement"].min() == pytest.approx(-20 * static, rel=0.01)
    assert trace["faults.shock"].max() == pytest.approx(20.0, rel=1e-4)
    assert abs(trace["faults.shock"][4001:]).max() == 0.0
    assert abs(trace["plant.displacement"][-1]) < 1e-3


def test_shock_sideways_and_hard_shock():
    """10.6 pm per g sideways; 1000 g for 1 ms along the drive reaches the stop at 20 um, which holds."""
    still = {**LCR, **STILL, "device.bias_v": 0.0, "plant.model": "planar", "plant.thermal_noise": False}
    board = make(still)
    do(board, {"fault": "shock", "severity": 1e3, "parameters": {"axis": "y", "pulse_ms": 2.0}})
    trace = play(board, 300)
    assert trace["plant.shift"].min() == pytest.approx(-1e3 * 2.209e-10 * 9.80665 / 205.4 * 1e6, rel=0.02)
    assert np.all(trace["plant.displacement"] == 0.0)
    board = make(still)
    do(board, {"fault": "shock", "severity": 1e3, "parameters": {"pulse_ms": 1.0}})
    x = play(board, 200)["plant.displacement"]
    assert board.trip is None and 20.0 < abs(x).max() < 21.0


@pytest.mark.parametrize("plant", PLANTS)
def test_drive_gain(plant):
    """Twice the voltage at the comb is the response to twice the drive."""
    sine = {"kind": "sine", "amplitude_v": 2.0, "frequency_hz": 500.0}
    values = {**LCR, "device.bias_v": 2.0, "plant.model": plant, "plant.thermal_noise": False, "reference": sine}
    for kind in ("held", "analogue"):
        board = make({**values, "drive.kind": kind})
        inject(board, drive_gain=1.0)
        trace = play(board, 400)
        double = play(make({**values, "drive.kind": kind, "reference.amplitude_v": 4.0}), 400)
        np.testing.assert_allclose(trace["plant.displacement"][5:], double["plant.displacement"][5:], atol=2e-3)
        assert abs(trace["drive.voltage"]).max() == pytest.approx(2.0, rel=1e-3)


def test_stuck_drive_holds_the_voltage_of_the_moment():
    sine = {"kind": "sine", "amplitude_v": 4.0, "frequency_hz": 500.0}
    board = make({**LCR, "reference": sine})
    play(board, 130)
    held = board.value("drive.voltage")
    do(board, {"fault": "drive_gain", "severity": 1.0, "parameters": {"mode": "stuck"}})
    trace = play(board, 1500)
    assert abs(trace["drive.voltage"][-200:]).max() == pytest.approx(4.0, rel=1e-3)
    assert trace["plant.displacement"][-1] == pytest.approx(-0.5455 * held, rel=2e-3)
    do(board, {"heal": "all"})
    again = play(board, 600)["plant.displacement"][-300:]
    assert np.ptp(again) > 3.0


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize(("comb", "sign"), [("right", -1.0), ("left", 1.0), ("both", 0.0)])
def test_a_short_leaves_the_other_comb(plant, comb, sign):
    """The remaining comb pulls with C' V^2 / 2, and continues when the fault is healed."""
    values = {**LCR, **STILL, "plant.model": plant, "plant.thermal_noise": False, "guard.stop_on_contact": False}
    board = make(values)
    do(board, {"fault": "short_circuit", "severity": 1.0, "parameters": {"comb": comb}})
    play(board, 2)
    do(board, {"heal": "all"})
    x = play(board, 1500)["plant.displacement"][-1]
    gradient = 2 * 87 * 8.8541878128e-12 * 2.0 / 2.1 * 1e6
    if plant == "slaved_lateral":
        assert np.sign(x) == sign
    else:
        assert x == pytest.approx(sign * 0.5 * gradient * 100 / 0.0538, rel=1e-3, abs=1e-9)


def test_the_board_stops_on_a_short_unless_told_not_to():
    for fault, parameters in (("short_circuit", {}), ("debris", {"conductive": True})):
        board = make({"device.id": "lcr-350"})
        do(board, {"fault": fault, "severity": 0.1, "parameters": parameters})
        play(board, 10)
        assert board.trip is not None and board.trip.reason == "a comb is shorted"
        assert board.trip.signal == "plant.short" and board.trip.value == 1.0
        free = make({"device.id": "lcr-350", "guard.stop_on_contact": False})
        do(free, {"fault": fault, "severity": 0.1, "parameters": parameters})
        play(free, 10)
        assert free.trip is None


def test_debris_is_a_spring_off_the_axis():
    """Half k x^2: with the spring on the axis nothing turns; off it the shuttle turns as the springs say."""
    # little voltage: it softens the rotation
    values = {**LCR, "device.bias_v": 1.0, "plant.model": "planar", "plant.thermal_noise": False}
    values["reference"] = {"kind": "constant", "amplitude_v": 1.0}
    healthy = play(make(values), 1500)["plant.displacement"][-1]
    for place in (0.0, 300.0):
        board = make(values)
        do(board, {"fault": "debris", "severity": 0.5, "parameters": {"place_um": place}})
        trace = play(board, 1500)
        kd, kt = 0.5 * 0.0538, 4.51e5
        k = np.array([[0.0538 + kd, -kd * place], [-kd * place, kt + kd * place**2]])
        x, theta = np.linalg.solve(k, [0.0538 * healthy, 0.0])
        assert trace["plant.displacement"][-1] == pytest.approx(x, rel=1e-3)
        assert 1e-3 * trace["plant.rotation"][-1] == pytest.approx(theta, rel=5e-3, abs=1e-12)


# -- the truth a bank is scored by


def truth_under(fault, severity, hypotheses=None, **parameters):
    values = {"guard.stop_on_contact": False}
    if hypotheses:
        values["diagnosers"] = {"kalman": {"kind": "mmae", "hypotheses": hypotheses}}
    board = make(values, base=RICH)
    do(board, {"fault": fault, "severity": severity, "parameters": parameters})
    return play(board, 10)["kalman.truth"][-1]


def test_truth_under_faults_no_hypothesis_knows():
    assert truth_under("added_mass", 0.05) == 1
    for fault, severity, parameters in (
        ("stiction", 5.0, {}),
        ("shock", 1.0, {}),
        ("short_circuit", 1.0, {}),
        ("drive_gain", 0.1, {}),
        ("drive_gain", 0.5, {"mode": "stuck"}),
        ("point_adhesion", 1.0, {}),
        ("broken_truss", 1.0, {}),
        ("debris", 0.1, {"conductive": True}),
    ):
        assert truth_under(fault, severity, **parameters) == -1, fault


def test_truth_of_a_gain_is_the_hypothesis_with_that_gain():
    known = [{"name": "healthy"}, {"name": "gain-20", "gain": 0.8}, {"name": "k+5", "stiffness": 1.05}]
    assert truth_under("drive_gain", -0.2, known) == 1
    assert truth_under("stiffness_one_side", 0.1, known) == 2
    assert math.isclose(truth_under("drive_gain", -0.3, known), -1)
