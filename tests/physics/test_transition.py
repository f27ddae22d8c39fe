"""The exact transition of an oscillator against the matrix exponential, and its limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import linalg

from core.device.oscillator import transition


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


def test_critical_damping_is_exact():
    np.testing.assert_allclose(
        np.array(transition(1.0, 2.0, 1.0, 0.7)).reshape(2, 2), linalg.expm([[0.0, 0.7], [-0.7, -1.4]]), rtol=1e-14
    )
