from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from core.sense.capacitive import Capacitive, squeezed
from tests.core.sense.bench import TICKS, make
from tests.lab import play

QUIET = {"sensor.kind": "capacitive", "sensor.noise_af_rthz": 0.0}
GRADIENT = 2 * 87 * 8.8541878128e-12 * 2.0 / 2.1 * 1e9  # fF/um, one side


def test_sum_is_constant_and_difference_is_the_displacement():
    trace = play(make(QUIET), 2000)
    x = trace["plant.displacement"]
    assert np.ptp(x) > 6.0
    np.testing.assert_allclose(trace["capacitive.sum"], 117.38, atol=0.01)
    assert np.ptp(trace["capacitive.sum"]) < 1e-9
    difference = trace["capacitive.positive"] - trace["capacitive.negative"]
    np.testing.assert_allclose(difference, 2.934 * x, atol=0.003)
    np.testing.assert_allclose(trace["sensor.displacement"], x, atol=1e-12)


def capacitances(x: float, y: float, theta: float) -> tuple[float, float]:
    """Both combs by adaptive integration along the overlap."""

    def density(xi: float) -> float:
        eta = y + theta * xi
        return 0.5 * GRADIENT * 2.1 * (1 / (2.1 - eta) + 1 / (2.1 + eta))

    return quad(density, 126.132, 166.132 + x)[0], quad(density, -166.132 + x, -126.132)[0]


@pytest.mark.parametrize(
    ("y", "theta", "more"), [(0.0, 1e-3, 0.57), (0.0, 3e-3, 5.4), (0.7, 0.0, 14.7), (0.1, -2e-3, None)]
)
def test_sum_sees_rotation_and_lateral_motion(y, theta, more):
    p = Capacitive.pack(Capacitive.Params(), make().spec.context())
    for x in (0.0, 4.0, -4.0):
        own = GRADIENT * squeezed(p, 1.0, 40.0 + x, y, theta), GRADIENT * squeezed(p, -1.0, 40.0 - x, y, theta)
        assert own == pytest.approx(capacitances(x, y, theta), rel=1e-6)
        if x == 0.0 and more is not None:
            assert sum(own) - 117.38 == pytest.approx(more, abs=0.06)


def test_noise_has_the_density_asked_for_and_filters_are_told():
    # 1 aF/rtHz is 0.34 nm/rtHz; white up to half of 518 kHz
    board = make({"sensor.kind": "capacitive", "sensor.noise_af_rthz": 1.0})
    expected = 0.34e-3 * math.sqrt(259e3)
    assert board.spec.context().sensor_noise_um == pytest.approx(expected, rel=0.01)
    trace = play(board, TICKS)
    assert np.std(trace["capacitive.error"]) == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("gap", [1.05, 4.2])
def test_capacitance_goes_with_one_over_the_gap(gap):
    r""":math:`C=2n\varepsilon_0tL/g` of each comb; the same noise density on half the slope is twice the noise."""
    board = make({**QUIET, "sensors.capacitive.gap_um": gap})
    trace = play(board, 1000)
    slope = 2 * 87 * 8.8541878128e-12 * 2.0 / gap * 1e9  # fF/um
    np.testing.assert_allclose(trace["capacitive.sum"], 2 * slope * 40.0, rtol=1e-9)
    difference = trace["capacitive.positive"] - trace["capacitive.negative"]
    np.testing.assert_allclose(difference, 2 * slope * trace["plant.displacement"], atol=1e-9)
    np.testing.assert_allclose(trace["sensor.displacement"], trace["plant.displacement"], atol=1e-12)
    noisy = make({"sensor.kind": "capacitive", "sensors.capacitive.gap_um": gap})
    told = 0.1e-3 * math.sqrt(259e3) / (2 * slope)
    assert noisy.spec.context().sensor_noise_um == pytest.approx(told, rel=1e-9)
    assert np.std(play(noisy, TICKS)["capacitive.error"]) == pytest.approx(told, rel=0.03)


def test_a_wider_gap_feels_less_of_what_is_lateral():
    """Both combs by integration, at twice the gap."""
    p = Capacitive.pack(Capacitive.Params(gap_um=4.2), make().spec.context())
    own = p.gradient * squeezed(p, 1.0, 40.0, 0.7, 1e-3)

    def density(xi: float) -> float:
        eta = 0.7 + 1e-3 * xi
        return 87 * 8.8541878128e-12 * 2.0 * 1e9 * (1 / (4.2 - eta) + 1 / (4.2 + eta))

    assert own == pytest.approx(quad(density, 126.132, 166.132)[0], rel=1e-6)
