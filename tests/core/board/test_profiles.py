"""Severity over time: step, ramp, intermittent, healed, several at once."""

from __future__ import annotations

import numpy as np
import pytest

from tests.lab import RICH, do, fault, inject, make, play, run_digest

FAST = {"reference.frequency_hz": 2000.0}


@pytest.mark.parametrize("name", ["added_mass", "stiffness", "damping"])
def test_ramp_is_exact_to_the_sample(name):
    profile = {"kind": "ramp", "duration_ms": 0.37}
    trace = play(make(FAST, [fault(name, 0.8, profile=profile, at_sample=21)]), 100)
    expected = np.clip((np.arange(100) - 21) / 37, 0, 1) * 0.8
    np.testing.assert_allclose(trace[f"faults.{name}"], expected, atol=1e-15)
    scale = {"added_mass": "mass"}.get(name, name)
    np.testing.assert_allclose(trace[f"effects.{scale}_scale"], 1 + expected, atol=1e-15)


def test_intermittent_is_exact_to_the_sample():
    profile = {"kind": "intermittent", "period_ms": 0.10, "duty": 0.3}
    trace = play(make(FAST, [fault("stiffness", -0.2, profile=profile, at_sample=13)]), 80)
    expected = [-0.2 if i >= 13 and (i - 13) % 10 < 3 else 0.0 for i in range(80)]
    assert trace["faults.stiffness"].tolist() == expected


@pytest.mark.parametrize("name", ["added_mass", "stiffness", "damping"])
@pytest.mark.parametrize("profile", ["step", "ramp", "intermittent"])
def test_severity_zero_is_bit_for_bit_no_fault(name, profile):
    plain = make({}, base=RICH)
    board = make({}, [fault(name, 0.0, profile={"kind": profile}, at_sample=11)], base=RICH)
    assert run_digest(board, 300) == run_digest(plain, 300)


def test_a_healed_device_is_the_nominal_one_again():
    board = make(FAST)
    inject(board, added_mass=0.2, stiffness=0.1, damping=3.0)
    do(board, fault("damping", 0.5, profile={"kind": "ramp", "duration_ms": 1.0}))
    play(board, 50)
    do(board, {"heal": ["damping"]})
    trace = play(board, 1)
    assert [trace[f"faults.{name}"][0] for name in ("added_mass", "stiffness", "damping")] == [0.2, 0.1, 0.0]
    do(board, {"heal": "all"})
    play(board, 2000)
    assert board.value("effects.mass_scale") == 1.0 and not board.faults
    late, plain = play(board, 500), make(FAST)
    play(plain, 2051)
    np.testing.assert_allclose(late["plant.displacement"], play(plain, 500)["plant.displacement"], atol=1e-9)


def test_two_faults_act_together():
    board = make(FAST)
    inject(board, added_mass=0.2, stiffness=0.1)
    play(board, 2)
    assert board.value("effects.mass_scale") == 1.2 and board.value("effects.stiffness_scale") == 1.1
