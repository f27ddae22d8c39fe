"""Switching while it runs: every controller has learned in shadow, so none begins anew."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.board.commands import parse_command
from tests.lab import do, inject, make, play, rms

LABELS = ("r", "w1", "w2", "y")
NINE = ("pid", "mrac", "indirect_mrac", "stvsc", "self_sliding", "mrac", "stvsc", "pid", "indirect_mrac")

AGED = {"added_mass": 0.05, "stiffness": 0.8}


def takeovers(first: str, order: tuple[str, ...], *, cold: bool = False, faults: dict[str, float] = AGED, values=None):
    """Switch between controllers; return the worst error within 5 ms and the jump of voltage of each switch."""
    board = make({"controller.kind": first, **(values or {})})
    ms = round(1 / board.dt_ms)
    inject(board, **faults)
    trace = play(board, 60 * ms)
    found = []
    for name in order:
        before = trace["drive.voltage"][-1]
        do(board, {"switch": name, "cold": cold})
        trace = play(board, 20 * ms)
        worst = np.abs(trace["plant.displacement"] - trace["model.displacement"])[: 5 * ms].max()
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


@pytest.mark.parametrize("rate_khz", [100, 200])
@pytest.mark.parametrize("noise_um", [0.0, 0.01])
@pytest.mark.parametrize(
    "order",
    [
        ("self_sliding", *NINE),
        # each of the five after each of the others, in two stories that begin with the laggard
        (
            "pid",
            "self_sliding",
            "indirect_mrac",
            "self_sliding",
            "stvsc",
            "mrac",
            "self_sliding",
            "pid",
            "stvsc",
            "pid",
        ),
        ("stvsc", "indirect_mrac", "mrac", "pid", "self_sliding", "stvsc", "self_sliding", "mrac", "stvsc", "pid"),
    ],
)
def test_nine_switches_in_any_order(order, noise_um, rate_khz):
    """The error of a PID is 0.157 um at its peak on this device; no controller that takes over makes it worse."""
    values = {"sensor.noise_um": noise_um, "sample_rate_khz": rate_khz, "seed": 5}
    found = takeovers(order[0], order[1:], values=values)
    assert found[:, 0].max() < 0.2


def test_mrac_with_velocity_takes_over_as_well():
    found = takeovers("mrac", ("mrac_velocity", "stvsc", "mrac_velocity"))
    assert found[:, 0].max() < 0.2 and found[:, 1].max() < 1.0


def test_printed_auxiliary_error_spoils_the_shadow():
    """Taken from the voltage MRAC asked for, while PID drives with another, it accuses the device of the difference."""
    for auxiliary, bumpless in (("applied", True), ("printed", False)):
        (worst, _), *_ = takeovers("pid", ("mrac",), values={"controllers.mrac.auxiliary": auxiliary})
        assert (worst < 0.2) == bumpless and (worst > 1.0) != bumpless


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


def test_what_ran_away_in_shadow_takes_over_anew():
    """On the device of chapter 4 at resonance the self-sliding law, not driving, adapts without end."""
    bench = {
        "device": {"id": "ch4"},
        "sample_rate_khz": 50,
        "seed": 101,
        "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
        "sensor": {"kind": "ideal", "noise_um": 0.05},
        "controller": {"kind": "open_loop"},
    }
    board = make(bench)
    play(board, 4000)
    assert board.trip is None and not math.isfinite(board.value("self_sliding.voltage"))
    board.apply(parse_command({"switch": "self_sliding"}))
    warning, switched = list(board.log)[-2:]
    assert switched.kind == "switch" and "self_sliding had run away" in warning.text
    trace = play(board, 500)
    assert board.trip is None and np.all(np.isfinite(trace["self_sliding.voltage"]))
