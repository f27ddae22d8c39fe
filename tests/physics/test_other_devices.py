"""Controllers and identifiers away from the device, rate and noise they were tried out on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core import registry
from core.device.catalogue import devices
from tests.lab import inject, make, pairs, play, rms
from tests.loop import KRAD, tail

RESONATORS = [device.id for device in devices() if device.usual_plant == "linear"]
SOME = ["ch4", "lcr-350", "table-1-1-350-min", "table-1-1-500-max", "fabricated-2"]
FOLLOWERS = ["mrac", "mrac_velocity", "indirect_mrac", "stvsc", "self_sliding"]
IDENTIFIERS = ["gradient", "least_squares", "recursive_least_squares", "adaptive_forgetting"]
AGED = {"added_mass": 0.05, "stiffness": 0.8}


def bench(device: str, rate_khz: int = 100, noise_um: float = 0.0, **values: Any):
    """Return a bench that asks for 2 um at 1 krad/s, with as much voltage as that takes."""
    reference = {"kind": "sine", "amplitude_um": 2.0, "frequency_hz": KRAD}
    own = {"device.id": device, "sample_rate_khz": rate_khz, "sensor.noise_um": noise_um, "seed": 7}
    return make({"reference": reference, "drive.limit_v": 200, **own, **values})


@pytest.mark.parametrize(("kind", "device", "rate_khz"), pairs(FOLLOWERS, SOME, (50, 100, 200)))
def test_an_aged_device_is_followed(kind, rate_khz, device):
    """Relative to 2 um the error equals the error on the device of chapter 3: time scales with w0, volts with kp."""
    board = bench(device, rate_khz, 0.01, controller={"kind": kind})
    inject(board, **AGED)
    trace = play(board, 40 * rate_khz)
    assert board.trip is None
    assert all(np.all(np.isfinite(values)) for values in trace.values())
    assert rms(tail(trace)) < 0.02
    assert np.abs(trace["plant.displacement"] - trace["model.displacement"]).max() < 1.0


@pytest.mark.parametrize("device", RESONATORS)
def test_every_controller_may_drive_every_resonator(device):
    """Healthy, without noise: none leaves the model but the PID, which does not know it, lags by some percent, and
    swings where a sample is a quarter of 1/w0 and more. There the loop of `h_infinity`, which is designed in continuous
    time, has no margin left: its weaknesses say so.
    """
    for kind in bench(device).spec.controllers:
        if kind == "h_infinity" and bench(device).dt_ms * bench(device).spec.nominal.natural_frequency > 0.25:
            continue
        board = bench(device, controller={"kind": kind})
        trace = play(board, 2000)
        assert board.trip is None
        sample = board.dt_ms * board.spec.context().device.natural_frequency
        coarse = sample > 0.25
        most = (1.0 if coarse else 0.08) if kind == "pid" else 0.005 if coarse else 1e-3
        assert rms(tail(trace)) < most


@pytest.mark.parametrize(("kind", "device", "rate_khz"), pairs(IDENTIFIERS, SOME, (50, 100, 200)))
def test_four_tones_identify_any_device(kind, rate_khz, device):
    """The tones are at the same multiples of the resonance as for the device of chapter 3; the line between two samples
    of the displacement is off by its curvature, (w h)^2/12, so half the rate costs four times as much."""
    rate = bench(device).spec.context().device.natural_frequency
    tones = [{"frequency_hz": share * rate * KRAD} for share in (0.064, 0.186, 0.51, 1.03)]
    reference = {"kind": "multi_sine", "amplitude_um": 2.0, "tones": tones}
    own = {"kind": kind, "adaptation_gain": 3.0} if kind == "gradient" else {"kind": kind}
    board = bench(device, rate_khz, reference=reference, identifiers={"x": own, "monitor": {"kind": "excitation"}})
    inject(board, **AGED)
    trace = play(board, 60 * rate_khz)
    cost = 3 if rate_khz == 50 else 1
    for part, true, within in (("mass", 1.05, 0.02), ("stiffness", 1.8, 0.02), ("damping", 1.0, 0.1)):
        assert trace[f"x.estimate.{part}"][-1] == pytest.approx(true, abs=cost * within), part
    assert trace["monitor.identifiable"][-1] == 1.0


@pytest.mark.parametrize("device", SOME)
@pytest.mark.parametrize("reference", ["sine", "step", "noisy"])
def test_one_tone_and_a_step_are_flagged_on_any_device(reference, device):
    chosen: dict[str, Any] = {"kind": "step", "amplitude_um": 2.0}
    if reference != "step":
        chosen = {"kind": "sine", "amplitude_um": 2.0, "frequency_hz": 500.0}
    noise = 0.05 if reference == "noisy" else 0.0
    board = bench(device, noise_um=noise, reference=chosen, identifiers={"monitor": {"kind": "excitation"}})
    assert np.all(play(board, 8000)["monitor.identifiable"][4500:] == 0.0)


def test_a_bench_without_any_drive_or_noise_stays_finite():
    own = {name: {"kind": name} for name in registry.blocks("identify")}
    board = make({"reference.amplitude_v": 0.0, "identifiers": own})
    trace = play(board, 5000)
    assert all(np.all(np.isfinite(values)) for values in trace.values())
    assert math.isfinite(board.value("least_squares.error_pct"))
