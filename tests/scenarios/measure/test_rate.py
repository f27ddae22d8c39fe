"""Figures of a gyroscope from traces whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import InputError
from scenarios.measure.rate import bandwidth_hz, levels
from scenarios.run import run
from scenarios.schema import Scenario

GYRO = {
    "schema": 1,
    "sample_rate_khz": 20,
    "duration_ms": 900,
    "device": {"id": "gyro-c"},
    "plant": {"model": "gyroscope", "thermal_noise": False},
}


def test_levels_of_a_rate():
    rate = np.repeat([0.0, 5.0, -3.0], [40, 50, 10])
    assert levels(rate) == [(0, 40), (40, 90), (90, 100)]
    assert levels(rate, 45) == [(45, 90), (90, 100)]
    assert levels(rate, 95) == [(95, 100)]


def test_a_ramp_is_no_level_and_noise_has_none():
    ramp = np.concatenate([np.zeros(300), np.linspace(0.0, 1.0, 400), np.ones(300)])
    assert levels(ramp) == [(0, 301), (699, 1000)]
    assert levels(np.random.default_rng(1).normal(size=500), 20) == [(20, 500)]


@pytest.mark.parametrize("corner", [3.0, 20.0, 110.0])
def test_bandwidth_of_a_lag(corner):
    t = 0.01 * np.arange(100_000)
    lag = 1.0 - np.exp(-2e-3 * np.pi * corner * t)
    assert bandwidth_hz(lag, 1.0, 0.01) == pytest.approx(corner, abs=0.3)
    twice = 1.0 - np.exp(-2e-3 * np.pi * corner * t) * (1.0 + 2e-3 * np.pi * corner * t)
    assert bandwidth_hz(twice, 1.0, 0.01) == pytest.approx(corner * np.sqrt(np.sqrt(2.0) - 1.0), abs=0.3)


def test_settling_is_that_of_two_lags():
    """The read-out of a step on an axis without quadrature is behind two lags; 5 % is left at a = ln 20 (1 + a)."""
    values = {
        "device": {"id": "gyro-a", "gyroscope": {"stiffness_xy_n_m": 0.0, "damping_xy_ns_m": 0.0}},
        "rate": {"kind": "step", "deg_per_s": -200.0, "start_ms": 700.0},
        "controller": {"kind": "open_loop_rate", "bandwidth_hz": 10.0, "correct_phase": True},
        "slots": {"drive": "drive_tracking"},
        "duration_ms": 1400,
    }
    found = run(Scenario.load({**GYRO, **values})).metrics
    a = 4.744  # (1 + a) exp(-a) = 0.05
    assert (1 + a) * np.exp(-a) == pytest.approx(0.05, rel=1e-3)
    assert found["rate.settling_ms"] == pytest.approx(a * 1e3 / (2 * np.pi * 10.0), rel=0.02)
    assert found["rate.zero_dps"] == pytest.approx(0.0, abs=0.01)
    assert found["rate.read_dps"] == pytest.approx(-200.0, rel=2e-3)
    assert found["rate.error_pct"] == pytest.approx(0.0, abs=0.2)


def test_nothing_is_said_of_what_never_happened():
    """No step, no settling; no rotation, no error; one displacement, no rate."""
    found = run(Scenario.load({**GYRO, "rate": {"kind": "constant"}})).metrics
    absent = {"rate.settling_ms", "rate.error_pct", "rate.scale_pm_per_dps", "rate.bandwidth_hz", "gyro.trusted"}
    assert not absent & set(found)
    assert not any(name.startswith(("control.", "sensing.")) for name in found)
    swinging = run(Scenario.load({**GYRO, "rate": {"kind": "sine", "frequency_hz": 5.0}})).metrics
    assert "rate.error_pct" not in swinging and swinging["rate.rms_error_dps"] > 1.0
    plain = run(Scenario.load({"schema": 1, "samples": 500})).metrics
    assert not any(name.startswith(("rate.", "gyro.", "sync.")) for name in plain)


def test_a_device_at_rest_and_a_single_sample():
    still = {**GYRO, "slots": {"drive": "forced_drive"}, "controllers": {"forced_drive": {"force_un": 0.0}}}
    found = run(Scenario.load(still)).metrics
    assert found["rate.amplitude_um"] == 0.0 and "rate.read_dps" in found
    for samples in (1, 2, 3):
        document = {key: value for key, value in GYRO.items() if key != "duration_ms"}
        assert run(Scenario.load({**document, "samples": samples})).metrics


def test_a_swept_sine_refuses_axes():
    with pytest.raises(InputError, match="one displacement") as refused:
        run(Scenario.load({**GYRO, "study": {"kind": "swept_sine"}}))
    assert refused.value.field == "plant.model"
