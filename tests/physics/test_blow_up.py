"""Controllers that blow up, and the rest of the motion under noise."""

from __future__ import annotations

import math

import numpy as np
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.lab import do, inject, make, play, rms
from tests.physics.loop import KP, W0, effort


def test_trip_at_gain_30_and_recovery():
    board = make({"controller": {"kind": "mrac", "adaptation_gain": 30.0}})
    inject(board, stiffness=1.0)
    trace = play(board, 20_000)
    assert board.trip is not None and "mrac.voltage" in board.trip.reason
    assert board.trip.tick == board.tick == len(trace["plant.displacement"]) < 20_000
    assert np.all(np.isfinite(trace["plant.displacement"])) and np.all(np.isfinite(trace["drive.voltage"]))
    assert board.advance(10).count == 0
    do(board, {"set": {"controllers.mrac.adaptation_gain": 1.0}})
    do(board, {"reset_trip": True})
    assert board.trip is None
    trace = play(board, 10_000)
    assert board.trip is None
    error = trace["plant.displacement"] - trace["model.displacement"]
    assert rms(error[-2500:]) < 0.003
    assert trace["faults.stiffness"][-1] == 1.0  # the fault is still there


def test_an_unused_controller_that_blows_up_does_not_stop_the_board():
    values = {"controllers": {"mrac": {"adaptation_gain": 1e6}}}
    board, calm = make(values), make({})
    for one in (board, calm):
        inject(one, stiffness=1.0)
    trace, expected = play(board, 5000), play(calm, 5000)
    assert not np.all(np.isfinite(trace["mrac.voltage"]))
    assert board.trip is None
    for name in ("plant.displacement", "drive.voltage", "pid.voltage", "sensor.displacement"):
        assert np.array_equal(trace[name], expected[name]), name


def test_library_scenarios_keep_their_figures_under_noise():
    scenario = with_values(get("ch3-mrac-spring-x2"), {"sensor.noise_um": 0.01, "plant.thermal_noise": True})
    found = run(scenario).metrics
    assert found["control.tail_rms_error_um"] < 0.02
    assert found["control.effort_ratio"] == pytest.approx(effort(1.0, stiffness=2.0), rel=0.01)


def test_damped_model_has_the_same_resonance_and_its_own_damping():
    values = {"model": {"kind": "damped", "damping_ratio": 0.5}, "reference": {"kind": "step", "amplitude_v": 10.0}}
    trace = play(make({**values, "sample_rate_khz": 1000}), 1500)["model.displacement"]
    assert -trace.min() / (10 * abs(KP)) - 1 == pytest.approx(math.exp(-math.pi * 0.5 / math.sqrt(0.75)), rel=1e-4)
    assert np.argmin(trace) * 1e-3 == pytest.approx(math.pi / (W0 * math.sqrt(0.75)), abs=1.5e-3)
    direct = play(make({"model": {"kind": "direct"}}), 100)
    np.testing.assert_allclose(direct["model.displacement"], KP * direct["reference.voltage"], rtol=1e-12)
