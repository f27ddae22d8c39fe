"""One comb has one gap: force, motion, sensing and pull-in agree on it."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import InputError
from scenarios.measure.lateral import lateral_metrics
from scenarios.measure.metrics import device_metrics
from tests.lab import do, make, play

EPS, N, T, L = 8.8541878128e-12, 87, 2.0, 40.0
STIFFNESS_N_M, BIAS_V, VOLTS = 0.0538, 10.0, 0.5
STILL = {
    "reference": {"kind": "constant", "amplitude_v": VOLTS},
    "sensor": {"kind": "capacitive", "noise_af_rthz": 0.0},
}


def bench(model: str, **values: object):
    quiet = {
        "device": {"id": "lcr-350", "stiffness_n_m": STIFFNESS_N_M},
        "plant": {"model": model, "thermal_noise": False},
    }
    return make({**quiet, **STILL, **{path.replace("__", "."): value for path, value in values.items()}})


def gradient(gap_um: float) -> float:
    """dC/dx of one comb, F/m."""
    return 2 * N * EPS * T / gap_um


@pytest.mark.parametrize("where", ["plant__gap_um", "device__finger_gap_um"])
@pytest.mark.parametrize("model", ["linear", "nonlinear", "planar"])
def test_what_is_told_is_what_moves_and_what_is_sensed(model, where):
    """F = 2 C' V_b v and x = -F/k at twice the gap; both undeflected capacitances are C' L."""
    board = bench(model, **{where: 4.2}, **({"plant__cubic_n_m3": 0.0} if model == "nonlinear" else {}))
    per_volt = 2 * gradient(4.2) * BIAS_V
    told = device_metrics(board.spec)
    assert told["device.force_n_per_v"] == pytest.approx(per_volt, rel=1e-9)
    assert told["device.static_gain_um_per_v"] == pytest.approx(-per_volt / STIFFNESS_N_M * 1e6, rel=1e-9)
    trace = play(board, 3000)
    assert trace["plant.displacement"][-1] == pytest.approx(-per_volt / STIFFNESS_N_M * 1e6 * VOLTS, rel=1e-4)
    assert trace["capacitive.sum"][-1] == pytest.approx(2 * gradient(4.2) * L * 1e9, rel=1e-6)
    # the model, which believes in the same device, moves as far
    assert trace["model.displacement"][-1] == pytest.approx(trace["plant.displacement"][-1], rel=1e-3)


def test_pull_in_is_that_of_the_gap_whatever_the_plant():
    r""":math:`V_b\propto g^{3/2}`."""
    found = {}
    for model in ("linear", "planar"):
        for gap in (2.1, 4.2):
            board = bench(model, plant__gap_um=gap)
            board.advance(2)
            found[model, gap] = lateral_metrics(board)["device.pull_in_v"]
        assert found[model, 4.2] / found[model, 2.1] == pytest.approx(2**1.5, rel=1e-3)
    assert found["linear", 4.2] == pytest.approx(found["planar", 4.2], rel=1e-4)


def test_a_plant_that_takes_over_keeps_the_gap_and_nobody_changes_it_in_motion():
    board = bench("planar", plant__gap_um=4.2)
    board.advance(2000)
    do(board, {"set": {"plant.model": "linear"}})
    trace = play(board, 2000)
    assert np.ptp(trace["plant.displacement"]) < 1e-4
    with pytest.raises(InputError, match="cannot change while the board runs") as refused:
        do(board, {"set": {"plant.gap_um": 3.0}})
    assert refused.value.field == "plant.gap_um"
