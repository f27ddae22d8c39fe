"""Identification from a sweep, against the device that was swept."""

from __future__ import annotations

import numpy as np
import pytest

from core.device.frequency import response
from core.device.identification import SweepTone, identify, tone
from core.errors import InputError

M, B, K, F = 2.2090e-10, 7.09e-7, 0.0538, -1.619e-8
GRID = np.concatenate([np.geomspace(600, 5000, 31), np.linspace(1720, 3250, 31)])


def tones(noise=0.0, seed=0, scale=1.0):
    generator = np.random.default_rng(seed)
    truth = response(M, scale * B, K, GRID) * F * 1e6
    jitter = noise * (generator.standard_normal(len(GRID)) + 1j * generator.standard_normal(len(GRID)))
    return [SweepTone(f, complex(h), noise, 1.0) for f, h in zip(GRID, truth + jitter, strict=True)]


@pytest.mark.parametrize("scale", [1.0, 0.2, 3.0])
def test_without_noise_it_is_exact(scale):
    found = identify(tones(scale=scale), F)
    zeta = scale * B / (2 * np.sqrt(K * M))
    assert (found.mass_kg, found.damping_ns_m, found.stiffness_n_m) == pytest.approx((M, scale * B, K), rel=1e-9)
    assert found.static_gain_um_per_v == pytest.approx(F / K * 1e6)
    assert found.read_f0_hz == pytest.approx(2483.78, abs=0.05)
    assert found.read_f_peak_hz == pytest.approx(2483.78 * np.sqrt(1 - 2 * zeta**2), rel=1e-4)
    if scale <= 1.0:
        assert found.read_quality_half_power == pytest.approx(0.5 / zeta, rel=3e-3)
    assert found.read_quality_phase_slope == pytest.approx(0.5 / zeta, rel=1e-3)


def test_standard_errors_are_the_scatter_of_repeated_sweeps():
    runs = [identify(tones(noise=0.005, seed=seed), F) for seed in range(200)]
    for name, truth in (("mass", M), ("damping", B), ("stiffness", K)):
        unit = {"mass": "kg", "damping": "ns_m", "stiffness": "n_m"}[name]
        values = np.array([getattr(run, f"{name}_{unit}") for run in runs])
        errors = np.array([getattr(run, f"{name}_error_{unit}") for run in runs])
        assert np.std(values, ddof=1) == pytest.approx(np.mean(errors), rel=0.2)  # 200 runs: 5 %
        assert abs(np.mean(values) - truth) < 4 * np.mean(errors) / np.sqrt(len(runs)), name


def test_errors_of_the_figures_are_the_scatter_of_repeated_sweeps():
    # the peak is at f0 sqrt(1 - 1 / 2Q^2)
    runs = [identify(tones(noise=0.005, seed=seed, scale=2.0), F) for seed in range(200)]
    for name, error in (
        ("f0_hz", "f0_error_hz"),
        ("f_peak_hz", "f_peak_error_hz"),
        ("quality_factor", "quality_factor_error"),
    ):
        scatter = np.std([getattr(run, name) for run in runs], ddof=1)
        assert scatter == pytest.approx(np.mean([getattr(run, error) for run in runs]), rel=0.12), name  # 200 runs: 5 %


def test_a_tone_with_noise_says_how_sure_it_is():
    dt, f, sigma = 0.01, 2000.0, 0.05
    t = np.arange(2000)
    wave = 2 * np.pi * f * 1e-3 * dt * t
    found = []
    for seed in range(100):
        noise = sigma * np.random.default_rng(seed).standard_normal(len(t))
        found.append(tone(f, dt, 2.0 * np.sin(wave), 1.5 * np.sin(wave - 0.7) + 0.3 + noise, held=False))
    mean = np.mean([entry.response for entry in found])
    assert mean == pytest.approx(0.75 * np.exp(-0.7j), abs=2e-3)
    assert np.std([entry.response.real for entry in found]) == pytest.approx(found[0].error, rel=0.25)
    # the tone has 1.5^2/2, the noise 0.05^2
    assert found[0].coherence == pytest.approx(1.125 / (1.125 + 0.0025), abs=1e-3)


def test_a_held_voltage_is_half_a_sample_late_and_smaller():
    dt, f = 0.01, 20_000.0
    t = np.arange(1000)
    wave = 2 * np.pi * f * 1e-3 * dt * t
    plain = tone(f, dt, np.sin(wave), np.sin(wave), held=False).response
    held = tone(f, dt, np.sin(wave), np.sin(wave), held=True).response
    assert plain == pytest.approx(1.0)
    assert held == pytest.approx(np.exp(1j * np.pi * 0.2) / np.sinc(0.2))


def test_nonsense_is_refused():
    with pytest.raises(InputError, match="four"):
        identify(tones()[:3], F)
    with pytest.raises(InputError, match="resonator"):
        identify(tones(), -F)  # a spring that pulls the wrong way
    with pytest.raises(InputError, match="no voltage"):
        tone(1000.0, 0.01, np.zeros(100), np.zeros(100), held=True)
