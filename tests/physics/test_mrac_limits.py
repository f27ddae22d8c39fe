"""How far direct MRAC carries: sample rate, gain, noise, quantum, limit of the drive, and what leakage is for."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tests.lab import inject, make, play, rms
from tests.loop import KP, W0, tail

AGED = {"added_mass": 0.05, "stiffness": 0.8}


def left(ms: float = 100.0, *, faults: dict[str, float] = AGED, law: dict[str, Any] | None = None, **values: Any):
    """Return the rms of the last quarter; infinite once the board has tripped."""
    board = make({"controller": {"kind": "mrac", **(law or {})}, "guard.rail_ms": 1e6, **values})
    inject(board, **faults)
    trace = play(board, round(ms / board.dt_ms))
    return math.inf if board.trip else rms(tail(trace))


@pytest.mark.parametrize("rate_khz", [20, 50, 200, 500, 1000])
def test_it_settles_at_any_sample_rate(rate_khz):
    assert left(sample_rate_khz=rate_khz) < 1e-3


@pytest.mark.parametrize("faults", [{"stiffness": 0.8}, {"stiffness": 1.0}, {"damping": 4.0}, AGED])
def test_the_gain_has_a_limit_between_10_and_25(faults):
    """A sample moves the gains by h g of what would be needed, so 2/h = 13 is where it begins to be too much."""
    assert 10.0 < 2.0 / (0.01 * W0) < 25.0
    assert left(faults=faults, law={"adaptation_gain": 10.0}) < 1e-3
    assert left(faults=faults, law={"adaptation_gain": 25.0}) == math.inf


@pytest.mark.parametrize("faults", [{"stiffness": 0.8}, {"damping": 4.0}, AGED])
def test_without_its_normaliser_gain_1_is_too_much(faults):
    """Then it is h g w'w that counts, and w'w is some hundred square volts."""
    assert left(faults=faults, law={"normalise": False}) == math.inf


@pytest.mark.parametrize(("noise_um", "most_um", "model"), [(0.01, 0.005, "copy"), (0.03, 0.02, "damped")])
def test_noise_costs_less_than_itself(noise_um, most_um, model):
    values = {"sensor.noise_um": noise_um, "model.kind": model}
    for seed in (1, 8):
        assert left(1000.0, seed=seed, **values) < most_um


def test_a_coarse_quantum_is_like_noise():
    """A quantum q is an error of q/sqrt(12), 0.029 um."""
    assert left(300.0, **{"sensor.quantum_um": 0.1}) < 0.1 / math.sqrt(12)


@pytest.mark.parametrize(("limit_v", "lost_um"), [(17.0, 0.1), (15.0, 0.3), (10.0, 0.85)])
def test_a_limit_below_the_voltage_needed_costs_what_it_cuts_off(limit_v, lost_um):
    """18 V are needed, and the missing part would have moved the shuttle by kp/1.8 a volt."""
    found = left(200.0, **{"drive.limit_v": limit_v})
    missing = np.maximum(18.0 * np.abs(np.sin(np.linspace(0, np.pi, 1000))) - limit_v, 0.0) * abs(KP) / 1.8
    assert 0.5 * rms(missing) < found < lost_um


def test_no_tracking_figure_tells_whether_alpha_adapts():
    """Only its trace does: it moves when it may, and does not go to 1/k*."""
    for faults in (AGED, {"stiffness": 1.0}):
        assert left(faults=faults, law={"adapt_alpha": False}) < 1e-3 > left(faults=faults)
    traces = []
    for adapt in (True, False):
        board = make({"controller": {"kind": "mrac", "adapt_alpha": adapt}})
        inject(board, **AGED)
        traces.append(play(board, 10_000)["mrac.alpha"])
    assert np.ptp(traces[1]) == 0.0 < np.ptp(traces[0])
    assert abs(traces[0][-1] - 1 / 1.05) > 0.01


def test_leakage_takes_back_gains_that_nothing_asks_for():
    """No reference: with noise alone the gains stay where they were, or go with e^(-1e-3 g w0 t)."""
    gains = {}
    for leakage in (0.0, 1e-3):
        law = {"kind": "mrac", "leakage": leakage}
        board = make({"controller": law, "sensor.noise_um": 0.03, "reference.amplitude_v": 0.0})
        gains[leakage] = play(board, 100_000)["mrac.gain.r"]
    assert gains[0.0][-1] == 1.0
    assert gains[1e-3][-1] == pytest.approx(math.exp(-1e-3 * W0 * 1000), rel=0.01)
