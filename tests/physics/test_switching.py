"""Switching while it runs: every controller has learned in shadow, so none begins anew."""

from __future__ import annotations

import numpy as np

from tests.lab import do, inject, make, play, rms

LABELS = ("r", "w1", "w2", "y")
NINE = ("pid", "mrac", "indirect_mrac", "stvsc", "self_sliding", "mrac", "stvsc", "pid", "indirect_mrac")

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


def test_nine_switches_among_controllers_that_ran_in_shadow():
    shadow = takeovers("self_sliding", NINE)
    assert shadow[:, 0].max() < 0.2
    assert shadow[:, 1].max() < 1.0  # of 18 V
    cold = takeovers("self_sliding", NINE, cold=True)
    assert cold[:, 0].max() > 0.8 > 4 * shadow[:, 0].max()
    assert cold[:, 1].max() > 5.0


def test_mrac_with_velocity_takes_over_as_well():
    found = takeovers("mrac", ("mrac_velocity", "stvsc", "mrac_velocity"))
    assert found[:, 0].max() < 0.2 and found[:, 1].max() < 1.0


def test_nine_switches_on_a_healthy_device():
    found = takeovers("mrac", NINE, faults={})
    assert found[:, 0].max() < 0.1 and found[:, 1].max() < 0.5


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
