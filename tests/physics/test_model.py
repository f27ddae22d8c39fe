"""The reference model under an analogue reference, against its response to a sine."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.lab import inject, make, phasor, play

M, K, FORCE = 2.2090e-10, 0.0538, -6.375e-9
HZ, VOLTS = 2000.0, 10.0


def bench(rate_khz, model, drive="analogue", device="ch3"):
    return make(
        {
            "sample_rate_khz": rate_khz,
            "device": {"id": device} if device != "ch3" else {"id": device, "force_n_per_v": 6.375e-9, "bias_v": 6.0},
            "plant": {"model": "linear", "drive": drive, "drive_noise_v": 0.0, "thermal_noise": False},
            "reference": {"kind": "sine", "amplitude_v": VOLTS, "frequency_hz": HZ},
            "model": model,
            "sensor": {"kind": "ideal", "noise_um": 0.0},
        }
    )


@pytest.mark.parametrize("rate_khz", [40, 80])
def test_a_damped_model_answers_a_sine_as_it_should(rate_khz):
    """F/(k - m w^2 + j w b) with b = 2 zeta sqrt(k m); a parabola over a sample is off by O((w dt)^4)."""
    trace = play(bench(rate_khz, {"kind": "damped", "damping_ratio": 0.7}), 10 * rate_khz)
    w = 2.0 * math.pi * HZ
    gain = 1e6 * FORCE / (K - M * w * w + 1j * w * 1.4 * math.sqrt(K * M))
    found = [
        phasor(trace[f"{name}"][5 * rate_khz :], HZ, 1.0 / rate_khz)
        for name in ("model.displacement", "reference.voltage")
    ]
    assert found[0] / found[1] == pytest.approx(gain, rel=(w * 1e-3 / rate_khz) ** 4)


@pytest.mark.parametrize("device", ["ch3", "lcr-350", "fabricated-1"])
@pytest.mark.parametrize("rate_khz", [10, 20, 100])
@pytest.mark.parametrize("drive", ["held", "analogue"])
def test_a_copy_of_a_healthy_device_is_where_the_device_is(rate_khz, drive, device):
    trace = play(bench(rate_khz, {"kind": "copy"}, drive, device), 20 * rate_khz)
    for state in ("displacement", "velocity"):
        size = np.abs(trace[f"plant.{state}"]).max()
        np.testing.assert_allclose(trace[f"model.{state}"], trace[f"plant.{state}"], atol=1e-9 * size)
        assert size > 0.0


def test_a_transfer_function_of_first_order_follows_an_analogue_sine():
    """1/(s/w0 + 1) in the unit of time of the device, 1/w0."""
    rate_khz = 40
    trace = play(bench(rate_khz, {"kind": "transfer_function", "numerator": [1.0], "denominator": [1.0, 1.0]}), 400)
    ratio = 2.0 * math.pi * HZ / math.sqrt(K / M)
    found = [phasor(trace[name][200:], HZ, 1.0 / rate_khz) for name in ("model.displacement", "reference.voltage")]
    assert found[0] / found[1] == pytest.approx(
        1.0 / (1.0 + 1j * ratio), rel=(2.0 * math.pi * HZ * 1e-3 / rate_khz) ** 4
    )


@pytest.mark.parametrize("kind", ["copy", "damped", "direct"])
def test_the_tracking_error_is_what_the_shuttle_is_away_from_the_model(kind):
    board = make({"device": {"id": "ch3"}, "model": {"kind": kind}, "controller": {"kind": "pid"}})
    inject(board, added_mass=0.05)
    trace = play(board, 500)
    error = trace["plant.displacement"] - trace["model.displacement"]
    assert np.array_equal(trace["model.tracking_error"], error) and np.ptp(error[100:]) > 0.0
