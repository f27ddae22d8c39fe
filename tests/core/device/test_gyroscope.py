"""Figures of gyroscopes from their parameters in SI units, written out here once more."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.device.catalogue import device
from core.device.two_axis import TwoAxis
from core.errors import InputError

KT = 1.380649e-23 * 300.0
PER_DEG = math.pi / 180.0
K1, K2, D1, D2, M = 63.955, 95.92, 1.8e-6, 2.4e-6, 1.8e-7
"""Principal values of the dissertation's pair, N/m, N s/m and kg."""
SETS = {  # masses, Coriolis mass, K, D, amplitude; C from frequencies and quality factors as printed
    "gyro-a": (1.8e-7, 1.8e-7, 1.8e-7, (63.955, 95.92, 12.779), (1.8e-6, 1.8e-6, 3.6e-7), 1e-6),
    "gyro-b": (0.57e-8, 0.57e-8, 0.57e-8, (80.98, 71.62, 5.0), (4.29e-7, 6.87e-7, 4.29e-8), 1e-6),
    "gyro-c": (
        1.42e-6,
        1.58e-6,
        1.58e-6,
        (
            1.42e-6 * (2 * math.pi * 3925.29) ** 2,
            1.58e-6 * (2 * math.pi * 3978.45) ** 2,
            2 * 1.58e-6 * 2 * math.pi * 3925.29 * 200 * PER_DEG,
        ),
        (1.42e-6 * 2 * math.pi * 3925.29 / 4673, 1.58e-6 * 2 * math.pi * 3978.45 / 449, 0.0),
        5e-6,
    ),
}
QUOTED = {  # modes Hz, Q, k_xy and d_xy as rates in deg/s, floor deg/h/rtHz
    "gyro-a": ((2893.0, 3758.8), (2077, 2100), 1.08e5, 57.3, 7.4),
    "gyro-b": ((17568, 19222), (1023, 1374), 2.1e5, 215.6, 22.9),
    "gyro-c": ((3925.29, 3978.45), (4673, 449), 200.0, 0.0, 0.904),
}
every_set = pytest.mark.parametrize("name", SETS)


def symmetric(x: float, y: float, xy: float) -> np.ndarray:
    return np.array([[x, xy], [xy, y]])


def turned(first: float, second: float, angle_deg: float) -> np.ndarray:
    """6.1.3 as printed."""
    c, s = math.cos(angle_deg * PER_DEG), math.sin(angle_deg * PER_DEG)
    cross = (first - second) * s * c
    return symmetric(first * c * c + second * s * s, first * s * s + second * c * c, cross)


def figures(name: str) -> dict[str, float]:
    return device({"id": name}).metrics()


@every_set
def test_the_device_holds_the_numbers_of_its_set(name):
    mx, my, mc, stiffness, damping, _ = SETS[name]
    found = device({"id": name}).oscillator()
    assert isinstance(found, TwoAxis)
    # mg, uN/um, uN ms/um
    assert [found.mass, found.mass_y, found.coriolis_mass] == pytest.approx([1e6 * m for m in (mx, my, mc)], rel=1e-12)
    np.testing.assert_allclose(found.stiffnesses, symmetric(*stiffness), rtol=1e-5)  # C: as many digits in the file
    np.testing.assert_allclose(found.dampings, 1e3 * symmetric(*damping), rtol=1e-5)
    assert found.force == 1.0


@every_set
def test_modes_are_the_eigenvalues_of_the_coupled_system(name):
    mx, my, _, stiffness, damping, _ = SETS[name]
    inverse = np.diag([1 / mx, 1 / my])
    system = np.block(
        [[np.zeros((2, 2)), np.eye(2)], [-inverse @ symmetric(*stiffness), -inverse @ symmetric(*damping)]]
    )
    rates = sorted((rate for rate in np.linalg.eigvals(system) if rate.imag > 0), key=abs)
    found = figures(name)
    hertz, quality = QUOTED[name][:2]
    for n, rate in enumerate(rates, 1):
        assert found[f"gyro.mode_hz.{n}"] == pytest.approx(abs(rate) / (2 * math.pi), rel=1e-6)
        assert found[f"gyro.quality_factor.{n}"] == pytest.approx(-abs(rate) / (2 * rate.real), rel=1e-5)
        assert found[f"gyro.mode_hz.{n}"] == pytest.approx(hertz[n - 1], rel=3e-5)
        assert found[f"gyro.quality_factor.{n}"] == pytest.approx(quality[n - 1], rel=1.5e-3)
    assert found["gyro.split_hz"] == pytest.approx((abs(rates[1]) - abs(rates[0])) / (2 * math.pi), rel=1e-4)


@every_set
def test_rates_and_thermal_floor_with_y_at_rest(name):
    mx, _, mc, (kx, _, kxy), (_, dy, dxy), reach = SETS[name]
    omega = math.sqrt(kx / mx)
    found, (_, _, quadrature, damping, floor) = figures(name), QUOTED[name]
    assert found["gyro.quadrature_dps"] == pytest.approx(kxy / (2 * mc * omega) / PER_DEG, rel=1e-5)
    assert found["gyro.quadrature_dps"] == pytest.approx(quadrature, rel=5e-3)
    assert found["gyro.damping_rate_dps"] == pytest.approx(dxy / (2 * mc) / PER_DEG, rel=1e-12)
    assert found["gyro.damping_rate_dps"] == pytest.approx(damping, abs=0.05)
    noise = math.sqrt(2) * math.sqrt(4 * KT * dy) / (2 * mc * omega * reach) / PER_DEG  # deg/s/rtHz
    assert found["gyro.floor_deg_per_h_rthz"] == pytest.approx(3600 * noise, rel=1e-5)
    assert found["gyro.floor_deg_per_h_rthz"] == pytest.approx(floor, rel=4e-3)
    assert found["gyro.arw_deg_per_rt_h"] == pytest.approx(60 * noise / math.sqrt(2), rel=1e-5)


def test_figures_quoted_of_single_sets():
    assert figures("gyro-a")["gyro.axis_deg"] == pytest.approx(-19.32, abs=0.005)
    c = figures("gyro-c")
    assert c["gyro.scale_pm_per_dps"] == pytest.approx(258.6, rel=2e-4)
    assert c["gyro.arw_deg_per_rt_h"] == pytest.approx(0.0107, abs=5e-5)
    # half bandwidths and decays, from what stays among the figures
    assert c["f0_hz"] / (2 * c["quality_factor"]) == pytest.approx(0.42, abs=0.005)
    assert c["gyro.mode_hz.2"] / (2 * c["gyro.quality_factor.2"]) == pytest.approx(4.43, abs=0.005)
    assert c["gyro.split_hz"] == pytest.approx(53.16, abs=0.02)
    assert c["decay_ms"] == pytest.approx(379, abs=0.5)
    assert c["gyro.quality_factor.2"] / (math.pi * c["gyro.mode_hz.2"]) == pytest.approx(0.0359, abs=5e-5)


def test_set_a_in_units_of_1000_rad_s_is_that_of_the_literature():
    a = device({"id": "gyro-a"}).oscillator()
    assert isinstance(a, TwoAxis)
    unit = a.mass * 1.0**2  # 1 rad/ms
    assert [a.stiffness / unit, a.stiffness_y / unit, a.stiffness_xy / unit] == pytest.approx(
        [355.3, 532.9, 70.99], rel=2e-4
    )
    assert [a.damping / a.mass, a.damping_xy / a.mass] == pytest.approx([0.01, 0.002], rel=1e-12)
    assert a.stiffness / (a.mass * (2 * math.pi) ** 2) == pytest.approx(355.3 / 39.48, rel=1e-3)  # with 1 kHz


@pytest.mark.parametrize(("name", "alpha", "gamma", "zero"), [("gyro-2-2", 2, 2, 10.00), ("gyro-4-5", 4, 5, 18.37)])
def test_the_dissertations_pair(name, alpha, gamma, zero):
    found = device({"id": name}).oscillator()
    assert isinstance(found, TwoAxis)
    k, d = turned(K1, K2, alpha), turned(D1, D2, gamma)
    np.testing.assert_allclose(found.stiffnesses, k, rtol=1e-12)
    np.testing.assert_allclose(found.dampings, 1e3 * d, rtol=1e-12)
    omega = math.sqrt(K1 / M)
    quoted = figures(name)
    assert quoted["gyro.mode_hz.1"] == pytest.approx(omega / (2 * math.pi), rel=1e-6)
    assert quoted["gyro.mode_hz.2"] == pytest.approx(math.sqrt(K2 / M) / (2 * math.pi), rel=1e-6)
    apart = k[1, 1] - M * omega**2
    assert quoted["gyro.zero_rate_dps"] == pytest.approx((d[0, 1] - k[0, 1] * d[1, 1] / apart) / (2 * M) / PER_DEG)
    assert quoted["gyro.zero_rate_dps"] == pytest.approx(zero, rel=1e-3)
    assert quoted["gyro.tilt_deg"] == pytest.approx(alpha, abs=5e-4)
    assert quoted["gyro.axis_deg"] == pytest.approx(alpha, abs=1e-9)
    scale = 2 * M * omega * 1e-6 * PER_DEG / abs(complex(apart, omega * d[1, 1]))
    assert quoted["gyro.scale_pm_per_dps"] == pytest.approx(1e12 * scale, rel=1e-6)
    # along its own axes, which the layout misses by alpha, the pair has 3.705 pm per deg/s
    assert quoted["gyro.scale_pm_per_dps"] == pytest.approx(3.705, rel=5e-3)
    straight = device({"id": name, "gyroscope": {"alpha_deg": 0, "gamma_deg": 0}}).metrics()
    assert straight["gyro.scale_pm_per_dps"] == pytest.approx(3.705, abs=5e-4)


def test_the_floor_of_the_pair():
    straight = device({"id": "gyro-2-2", "gyroscope": {"alpha_deg": 0, "gamma_deg": 0}}).metrics()
    assert straight["gyro.floor_deg_per_h_rthz"] == pytest.approx(8.57, abs=0.005)


def test_environment_scales_stiffness_and_damping_of_both_axes():
    plain = device({"id": "gyro-c"})
    found, cold = plain.metrics(1.21, 3.0), plain.metrics(temperature_k=75.0)
    once = plain.metrics()
    for n in (1, 2):
        assert found[f"gyro.mode_hz.{n}"] == pytest.approx(1.1 * once[f"gyro.mode_hz.{n}"], rel=1e-6)
        assert found[f"gyro.quality_factor.{n}"] == pytest.approx(1.1 / 3 * once[f"gyro.quality_factor.{n}"], rel=1e-3)
    assert cold["gyro.floor_deg_per_h_rthz"] == pytest.approx(0.5 * once["gyro.floor_deg_per_h_rthz"])


def test_matched_modes_have_no_zero_rate():
    """The rate is then in step with x itself, not with its velocity."""
    matched = {"stiffness_y_n_m": 63.955, "damping_y_ns_m": 1.8e-6, "stiffness_xy_n_m": 0.0, "damping_xy_ns_m": 0.0}
    found = device({"id": "gyro-a", "gyroscope": matched}).metrics()
    assert "gyro.zero_rate_dps" not in found
    # Q/w^2 of the Coriolis acceleration
    omega, quality = found["f0_hz"] * 2 * math.pi, found["quality_factor"]
    assert found["gyro.scale_pm_per_dps"] == pytest.approx(2 * PER_DEG * omega * 1e6 * quality / omega**2, rel=1e-9)


@pytest.mark.parametrize(
    ("values", "field", "words"),
    [
        ({"gyroscope": {"stiffness_xy_n_m": 90.0}}, "device.gyroscope", "outweigh the cross term"),
        ({"gyroscope": {"damping_xy_ns_m": -2e-6}}, "device.gyroscope", "outweigh the cross term"),
        ({"gyroscope": {"damping_y_ns_m": 1.0}}, "device.gyroscope", "both modes"),
        ({"gyroscope": {"alpha_deg": 91.0}}, "device.gyroscope.alpha_deg", "must be <= 90"),
        ({"gyroscope": {"alpha": 1.0}}, "device.gyroscope.alpha", "alpha_deg"),
        ({"gyroscope": {"mass_x_kg": 0.0}}, "device.gyroscope.mass_x_kg", "must be >= 1e-18"),
        ({"mass_kg": 1e-9}, "device", "leave out mass_kg"),
        ({"transfer_function": {"denominator": [1.0, 1.0]}}, "device", "leave out transfer_function"),
    ],
)
def test_a_gyroscope_that_cannot_be_is_refused(values, field, words):
    with pytest.raises(InputError, match=words) as error:
        device({"id": "gyro-a", **values})
    assert error.value.field == field
