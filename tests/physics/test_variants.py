"""Diagnosers on other devices, rates, noises and lists: finite, normalised, right where the drive tells enough."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core import registry
from core.errors import InputError
from tests.lab import inject, make, play

KINDS = sorted(name for name, block in registry.blocks("diagnose").items() if not block.axes)
LISTED = [name for name in KINDS if "hypotheses" in registry.blocks("diagnose")[name].Params.model_fields]
WITH_GAIN = [
    {"name": "healthy"},
    {"name": "m+10", "mass": 1.1},
    {"name": "k+10", "stiffness": 1.1},
    {"name": "gain-20", "gain": 0.8},
]
FAULTS = {"m+10": {"added_mass": 0.1}, "k+10": {"stiffness": 0.1}, "gain-20": {"drive_gain": -0.2}}
LISTS = {
    "gain": WITH_GAIN,
    "two": [{"name": "a"}, {"name": "b", "stiffness": 2.3, "damping": 1.83}],
    "sixteen": [{"name": f"h{i}", "mass": 1 + 0.01 * i, "gain": 1 + 0.02 * i} for i in range(16)],
    "extreme": [
        {"name": "a"},
        {"name": "b", "mass": 100.0},
        {"name": "c", "stiffness": 0.01},
        {"name": "d", "damping": 0.001},
    ],
}


def bench(device: str, rate: float, noise: float, diagnosers: dict[str, Any], **values: Any):
    return make(
        {
            "device": {"id": device},
            "sample_rate_khz": rate,
            "plant.thermal_noise": True,
            "reference": {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 2000.0},
            "sensor.noise_um": noise,
            "diagnosers": diagnosers,
            **values,
        }
    )


@pytest.mark.parametrize("hypotheses", LISTS)
@pytest.mark.parametrize(
    ("device", "rate", "noise"),
    [("lcr-350", 100, 0.05), ("fabricated-2", 20, 1.0), ("table-1-1-500-min", 200, 0.0), ("ch4", 50, 0.2)],
)
def test_all_side_by_side_are_finite_and_normalised(device, rate, noise, hypotheses):
    banks = {name: {"kind": name, **({"hypotheses": LISTS[hypotheses]} if name in LISTED else {})} for name in KINDS}
    board = bench(device, rate, noise, banks)
    parts = [play(board, 600)]
    inject(board, added_mass=0.1, drive_gain=-0.2, sensor_dropout=0.1)
    parts.append(play(board, 900))
    for trace in parts:
        for name in KINDS:
            own = [value for signal, value in trace.items() if signal.startswith(f"{name}.")]
            assert np.all(np.isfinite(own)), name
            weights = np.array([v for signal, v in trace.items() if signal.startswith(f"{name}.probability.")])
            if len(weights):
                np.testing.assert_allclose(weights.sum(axis=0), 1.0, atol=1e-9, err_msg=name)
                assert weights.min() >= 0.0, name


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize(
    ("device", "rate"), [("lcr-350", 50), ("lcr-350", 100), ("lcr-350", 200), ("table-1-1-400-std", 100), ("ch4", 100)]
)
def test_the_banks_find_a_fault_of_their_list_on_any_device(device, rate, fault):
    told = {"hypotheses": WITH_GAIN}
    banks = {"kalman": {"kind": "mmae", **told}, "imm": {"kind": "imm", **told}, "lock_in": {"kind": "lock_in", **told}}
    board = bench(device, rate, 0.02, banks)
    play(board, 20 * rate)  # 20 ms: settled in the rhythm of the drive
    assert all(board.value(f"{name}.winner") == 0 for name in banks)
    inject(board, **FAULTS[fault])
    trace = play(board, 40 * rate)
    wanted = [entry["name"] for entry in WITH_GAIN].index(fault)
    for name in banks:
        late = trace[f"{name}.winner"][-10 * rate :]
        assert np.mean(late == wanted) > 0.9, name


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("device", ["double-integrator", "first-order-gain", "unstable-first-order"])
def test_a_device_without_a_spring_has_no_hypotheses(kind, device):
    values = {"device": {"id": device}, "plant": {"model": "transfer_function"}, "diagnosers": {"x": {"kind": kind}}}
    with pytest.raises(InputError, match="mass and spring") as error:
        make(values, base={"sample_rate_khz": 100})
    assert error.value.field == "diagnosers.x.kind"


@pytest.mark.parametrize("kind", LISTED)
@pytest.mark.parametrize(
    ("hypotheses", "field"),
    [
        ([], "hypotheses"),
        ([{"name": "one"}], "hypotheses"),
        ([{"name": f"h{i}"} for i in range(17)], "hypotheses"),
        ([{"name": "a"}, {"name": "a"}], ""),
        ([{"name": "a"}, {"name": "b", "mass": 0.0}], "hypotheses.1.mass"),
        ([{"name": "a"}, {"name": "b", "gain": -1.0}], "hypotheses.1.gain"),
        ([{"name": "a"}, {"name": "b", "damping": float("nan")}], "hypotheses.1.damping"),
        ([{"name": "a"}, {"name": "b.c"}], "hypotheses.1.name"),
        ([{"name": "a"}, {"name": "b", "mas": 1.1}], "hypotheses.1.mas"),
    ],
)
def test_a_list_that_cannot_be_is_refused_by_its_field(kind, hypotheses, field):
    with pytest.raises(InputError) as error:
        make({"diagnosers": {"x": {"kind": kind, "hypotheses": hypotheses}}})
    assert error.value.field == ".".join(part for part in ("diagnosers.x", field) if part)
    assert "\n" not in str(error.value)
