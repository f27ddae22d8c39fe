"""Controllers that take over from one another, and those that blow up."""

from __future__ import annotations

import math

import numpy as np
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.lab import do, inject, make, play, rms
from tests.physics.loop import KP, LABELS, W0, effort

AGED = {"added_mass": 0.05, "stiffness": 0.8}


def takeovers(first: str, order: tuple[str, ...], *, cold: bool = False, faults: dict[str, float] = AGED):
    """Switch between controllers; return the worst error within 5 ms and the jump of voltage of each switch."""
    board = make({"controller.kind": first})
    inject(board, **faults)
    trace = play(board, 6000)
    found = []
    for name in order:
        before = trace["drive.voltage"][-1]
        do(board, {"kind": "switch", "controller": name, "cold": cold})
        trace = play(board, 2000)
        worst = np.abs(trace["plant.displacement"] - trace["model.displacement"])[:500].max()
        found.append((worst, abs(trace["drive.voltage"][0] - before)))
    assert board.trip is None
    return np.array(found)


def test_controllers_that_ran_in_shadow_take_over_without_a_bump():
    shadow = takeovers("mrac", ("pid", "mrac", "pid", "mrac"))
    assert shadow[:, 0].max() < 0.2
    assert shadow[:, 1].max() < 1.0  # of 18 V
    cold = takeovers("mrac", ("pid", "mrac", "pid", "mrac"), cold=True)
    assert cold[:, 0].max() > 0.8 > 4 * shadow[:, 0].max()
    assert cold[:, 1].max() > 5.0


def test_round_from_open_loop_to_mrac_to_pid_and_back_on_a_healthy_device():
    found = takeovers("open_loop", ("mrac", "pid", "open_loop"), faults={})
    assert found[:, 0].max() < 0.1 and found[:, 1].max() < 0.5
    assert found[0, 0] < 1e-9


def test_pid_takes_over_an_aged_device_with_the_voltage_that_was_there():
    (_, jump), *_ = takeovers("mrac", ("pid",))
    slope = 18.0 * 1.0 * 0.01  # 18 V at 1 krad/s, one sample
    assert jump < 1.1 * slope


def test_a_shadow_that_adapts_is_ready():
    """MRAC learned the aged device while PID drove; without shadow adaptation it starts from the nominal gains."""
    board = make({"controller.kind": "pid"})
    inject(board, **AGED)
    trace = play(board, 10_000)
    ideal = np.array([trace[f"mrac.gain_ideal.{name}"][-1] for name in LABELS])
    assert not np.allclose([trace[f"mrac.gain.{name}"][-1] for name in LABELS], ideal * 0 + [1, 0, 0, 0], atol=0.05)
    assert rms(trace["mrac.augmented_error"][-2000:]) < 0.05 * rms(trace["mrac.augmented_error"][:500])


def test_trip_at_gain_30_and_recovery():
    board = make({"controller": {"kind": "mrac", "adaptation_gain": 30.0}})
    inject(board, stiffness=1.0)
    trace = play(board, 20_000)
    assert board.trip is not None and "mrac.voltage" in board.trip.reason
    assert board.trip.tick == board.tick == len(trace["plant.displacement"]) < 20_000
    assert np.all(np.isfinite(trace["plant.displacement"])) and np.all(np.isfinite(trace["drive.voltage"]))
    assert board.advance(10).count == 0
    do(board, {"kind": "set", "values": {"controllers.mrac.adaptation_gain": 1.0}})
    do(board, {"kind": "reset_trip"})
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
