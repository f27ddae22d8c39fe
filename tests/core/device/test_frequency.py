"""Frequency response against scipy and against brute force."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import signal

from core.device.catalogue import device
from core.device.frequency import figures, response, tolerance_band

M, B, K = 2.2090e-10, 7.09e-7, 0.0538


@pytest.mark.parametrize("scale", [(1, 1, 1), (1, 5, 1), (10, 1, 1), (1, 1, 2), (1, 0.01, 1)])
def test_response_is_the_transfer_function(scale):
    m, b, k = M * scale[0], B * scale[1], K * scale[2]
    f = np.geomspace(10, 1e5, 200)
    _, oracle = signal.freqs([1.0], [m, b, k], 2 * np.pi * f)
    np.testing.assert_allclose(response(m, b, k, f), oracle, rtol=1e-10)


# note: figures of the devices, from an independent calculation
@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ((M, B, K), (2483.78, 2457.38, 4.862, 13.78, 2185.6, 2702.0)),
        ((M, 6.7851e-7, 0.037812), (2082.27, 2053.38, 4.259, 12.65, 1790.4, 2286.3)),
        ((M, 1.3 * B, K), (2483.8, 2439.0, 3.740, 11.54, 2077, 2754)),
        ((1.9203e-10, B, 0.1038), (3700.28, 3676.87, 6.297, 16.01, 3369, 3961)),
    ],
)
def test_figures_of_known_devices(values, expected):
    found = figures(*values)
    names = ("f0_hz", "f_peak_hz", "quality_factor", "peak_db", "half_power_low_hz", "half_power_high_hz")
    for name, value in zip(names, expected, strict=True):
        assert found[name] == pytest.approx(value, rel=4e-4), name


@pytest.mark.parametrize("damping", [0.01, 1.0, 4.0, 6.0])
def test_figures_are_those_of_the_curve(damping):
    found = figures(M, damping * B, K)
    f = np.linspace(1, 4000, 400_001)
    size = np.abs(response(M, damping * B, K, f))
    top = int(np.argmax(size))
    assert f[top] == pytest.approx(found["f_peak_hz"], abs=0.02)
    assert 20 * math.log10(size[top] * K) == pytest.approx(found["peak_db"], abs=1e-3)
    loud = f[size >= size[top] / math.sqrt(2)]
    assert loud[-1] == pytest.approx(found["half_power_high_hz"], abs=0.02)
    if found["half_power_low_hz"] > 1:
        assert loud[0] == pytest.approx(found["half_power_low_hz"], abs=0.02)
    at_resonance = response(M, damping * B, K, np.array([found["f0_hz"]]))
    assert math.degrees(np.angle(at_resonance)[0]) == pytest.approx(-90.0, abs=1e-6)


def test_without_a_peak_half_power_counts_from_rest():
    found = figures(M, 8 * B, K)
    assert found["f_peak_hz"] == 0.0 and found["peak_db"] == 0.0
    corner = response(M, 8 * B, K, np.array([found["half_power_high_hz"]]))
    assert abs(corner[0]) * K == pytest.approx(math.sqrt(0.5), rel=1e-9)


def test_far_above_the_resonance_it_falls_40_db_per_decade():
    far = 20 * np.log10(np.abs(response(M, B, K, np.array([25e3, 250e3]))) * K)
    assert far[0] == pytest.approx(-40.03, abs=0.05)
    assert far[1] - far[0] == pytest.approx(-40.0, abs=0.1)
    two = response(M, B, K, np.array([1000.0, 2000.0]))
    np.testing.assert_allclose(np.degrees(np.angle(two)), [-5.64, -25.22], atol=0.01)
    assert abs(two[1]) * K == pytest.approx(2.5729, rel=1e-4)


def test_more_mass_is_slower_more_stiffness_faster():
    base = figures(M, B, K)["f0_hz"]
    assert figures(1.05 * M, B, K)["f0_hz"] == pytest.approx(2423.9, abs=0.1)
    assert figures(1.05 * M, B, K)["f0_hz"] / base - 1 == pytest.approx(1 / math.sqrt(1.05) - 1, rel=1e-9)
    assert figures(M, B, 1.05 * K)["f0_hz"] == pytest.approx(2545.1, abs=0.1)


def test_band_holds_every_device_between_the_limits_and_no_more():
    f = np.geomspace(200, 2e4, 60)
    mass, damping, stiffness = (0.9 * M, M, 1.2 * M), (0.7 * B, B, 1.4 * B), (0.8 * K, K, 1.1 * K)
    band = tolerance_band(mass, damping, stiffness, f)
    low, high = np.full(len(f), np.inf), np.full(len(f), -np.inf)
    early, late = low.copy(), high.copy()
    for m in np.linspace(mass[0], mass[2], 41):
        for b in np.linspace(damping[0], damping[2], 5):
            for k in np.linspace(stiffness[0], stiffness[2], 41):
                h = response(m, b, k, f)
                db, deg = 20 * np.log10(np.abs(h) * K), np.degrees(np.angle(h))
                low, high = np.minimum(low, db), np.maximum(high, db)
                early, late = np.minimum(early, deg), np.maximum(late, deg)
    assert np.all(band.low_db <= low + 1e-9) and np.all(band.high_db >= high - 1e-9)
    np.testing.assert_allclose(band.low_db, low, atol=1e-6)
    np.testing.assert_allclose(band.high_db, high, atol=0.15)  # the peak may be between two of the grid
    np.testing.assert_allclose(band.low_deg, early, atol=1e-6)
    np.testing.assert_allclose(band.high_deg, late, atol=1e-6)
    np.testing.assert_allclose(band.nominal_db, 20 * np.log10(np.abs(response(M, B, K, f)) * K), atol=1e-12)


def test_metrics_of_a_device_hold_the_resonance():
    found = device({"id": "ch3"}).metrics()
    assert found["f_peak_hz"] == pytest.approx(2457.38, abs=0.01)
    assert found["decay_ms"] == pytest.approx(0.623, rel=1e-3)
    assert found["thermal_rms_nm"] == pytest.approx(0.2775, rel=1e-3)
    # logarithmic decrement of the free decay
    assert 1e3 / found["f_damped_hz"] / found["decay_ms"] == pytest.approx(0.64955, rel=1e-4)
