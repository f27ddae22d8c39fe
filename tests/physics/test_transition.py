"""The exact transition of an oscillator against the matrix exponential, and its limits."""

from __future__ import annotations

import itertools
import math

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import linalg

from core.block import Oscillator
from core.device.oscillator import SOFT, held, transition
from core.voltage import difference_equation, over_tick
from tests.lab import make, play


@given(
    mass=st.floats(1e-6, 1e-2),
    stiffness=st.floats(1e-4, 10.0),
    ratio=st.one_of(st.floats(0.0, 0.999), st.just(1.0), st.floats(1.001, 20.0)),
    share=st.floats(1e-3, 3.0),
)
def test_transition_is_the_matrix_exponential(mass, stiffness, ratio, share):
    omega = math.sqrt(stiffness / mass)
    damping = 2.0 * ratio * math.sqrt(stiffness * mass)
    h = share / omega
    # scaled so that both states count alike
    scaled = np.array([[0.0, 1.0], [-1.0, -2.0 * ratio]]) * share
    expected = linalg.expm(scaled) * np.array([[1.0, 1.0 / omega], [omega, 1.0]])
    found = np.array(transition(mass, damping, stiffness, h)).reshape(2, 2)
    scale = np.array([[1.0, 1.0 / omega], [omega, 1.0]])
    np.testing.assert_allclose(found / scale, expected / scale, rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize(("mass", "damping", "h"), [(0.01, 100.0, 0.1), (1.0, 1e5, 1.0), (1e-3, 1e4, 10.0)])
def test_far_beyond_critical_damping_only_the_slow_rate_is_left(mass, damping, h):
    """There the factors of the textbook form, exp(-sigma h) and cosh(omega h), are 0 and infinite."""
    slow, fast = 1.0 / damping, damping / mass  # of a unit spring, to the first order in their ratio
    found = np.array(transition(mass, damping, 1.0, h))
    left = math.exp(-slow * h)
    np.testing.assert_allclose(found[:3], [left, left / fast, -left / damping], rtol=3 * slow / fast + 1e-12)
    assert found[3] == pytest.approx(-left * slow / fast, rel=3 * slow / fast, abs=1e-15)


SPRINGS = [0.0, 1e-30, 1e-18, 1e-10, 4.9e-8, 5.1e-8, 1e-6, 1e-3, 0.3, -1e-18, -1e-9, -1e-3]
DAMPERS = [0.0, 1e-12, 1e-6, 1e-3, 0.3, 0.99, 1.01, 5.0, 40.0, 700.0, -1e-4, -0.5, -3.0]


@pytest.mark.parametrize("spring", SPRINGS)
def test_no_digits_are_lost_where_a_spring_or_a_damper_hardly_acts(spring):
    """Spring and damper as shares of the mass: their effect within an interval, against an exponential of 200 bits."""
    error = 3e-15 if abs(spring) < SOFT else 1e-8
    with mpmath.workprec(200):
        for damper, mass, h in itertools.product(DAMPERS, (3e-7, 5e4), (1e-5, 3.0)):
            device = Oscillator(mass, damper * mass / h, spring * mass / h / h, 2.0)
            m, b, k = map(mpmath.mpf, (device.mass, device.damping, device.stiffness))
            exact = mpmath.expm(mpmath.matrix([[0, h, 0], [-k / m * h, -b / m * h, h / m], [0, 0, 0]]))
            *_, reach, push = held(device.mass, device.damping, device.stiffness, h)
            assert abs(reach / exact[0, 2] - 1) < error, (damper, mass, h)
            assert abs(push / exact[1, 2] - 1) < 1e-12, (damper, mass, h)
            if k != 0:
                gained = difference_equation(device, device.static_gain, h)[0], over_tick(device, 2.0, h, False)[-2]
                assert all(abs(one / (2 * exact[0, 2]) - 1) < error for one in gained), (damper, mass, h)


@pytest.mark.parametrize("last", [1e-8, 1e-9])
def test_a_plant_whose_spring_is_nearly_nothing_moves_as_one_without(last):
    r"""Under one volt :math:`\ddot x+10\dot x=1` moves by :math:`(10t-1+e^{-10t})/100`."""
    device = {"transfer_function": {"denominator": [1.0, 10.0, last]}}
    still = {"kind": "constant", "amplitude_v": 1.0}
    board = make({"device": device, "plant": {"model": "transfer_function"}, "reference": still})
    x, t = play(board, 10_001)["plant.displacement"][-1], board.tick * board.dt_ms * 1e-3
    t -= board.dt_ms * 1e-3
    assert x == pytest.approx((10.0 * t - 1.0 + math.exp(-10.0 * t)) / 100.0, rel=1e-8)


def test_critical_damping_is_exact():
    np.testing.assert_allclose(
        np.array(transition(1.0, 2.0, 1.0, 0.7)).reshape(2, 2), linalg.expm([[0.0, 0.7], [-0.7, -1.4]]), rtol=1e-14
    )
