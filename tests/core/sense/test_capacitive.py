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
