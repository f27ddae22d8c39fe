"""The boundary of what cannot pull in, against potentials with a closed form."""

from __future__ import annotations

import numpy as np
import pytest

from core.plant.escape import boundary


def test_a_softening_spring_has_the_separatrix_of_its_potential():
    # F = -kx + ax^3: saddle at sqrt(k/a), U = kx^2/2 - ax^4/4
    k, a, mass = 2.0, 0.02, 0.5
    found = boundary(lambda q, _r, _l: np.array([-k * q[0] + a * q[0] ** 3]), mass, 0.0, 0.0, 1)
    saddle = np.sqrt(k / a)
    assert found.x_um[[0, -1]] == pytest.approx([-saddle, saddle], abs=1e-3)
    energy = 0.5 * k * found.x_um**2 - 0.25 * a * found.x_um**4
    expected = np.sqrt(2 * (0.25 * k * k / a - energy) / mass)
    # the energy is summed by trapezoids of 0.05 um
    assert found.speed_um_ms == pytest.approx(expected, rel=1e-3, abs=0.05)


def test_the_lower_of_two_barriers_counts():
    # F = -kx + bx^2 + ax^3 has its saddles at (-b +- sqrt(b^2 + 4ak)) / 2a, the near one at +x
    k, b, a = 1.0, 0.1, 0.01
    found = boundary(lambda q, _r, _l: np.array([-k * q[0] + b * q[0] ** 2 + a * q[0] ** 3]), 1.0, 0.0, 0.0, 1)
    near, far = (-b + np.sqrt(b * b + 4 * a * k)) / (2 * a), (-b - np.sqrt(b * b + 4 * a * k)) / (2 * a)

    def energy(x):
        return k * x**2 / 2 - b * x**3 / 3 - a * x**4 / 4

    assert energy(near) < energy(far)
    assert found.x_um[-1] == pytest.approx(near, abs=1e-3)
    # on the other side it ends where the slope is as high, short of the far saddle
    assert far < found.x_um[0] < 0.0
    assert energy(found.x_um[0]) <= energy(near) < energy(found.x_um[0] - 0.05)  # one step of the walk
    assert np.max(found.speed_um_ms) == pytest.approx(np.sqrt(2 * energy(near)), rel=1e-3)


def test_sideways_instability_is_a_barrier_too():
    # the stiffness sideways c - d x^2 is gone at sqrt(c/d), far before the spring along x gives way
    def force(q, _right, _left):
        return np.array([-q[0], -(4.0 - q[0] ** 2) * q[1], -q[2]])

    found = boundary(force, 1.0, 0.0, 0.0, 3)
    assert found.x_um[[0, -1]] == pytest.approx([-2.0, 2.0], abs=1e-3)
    assert np.max(found.speed_um_ms) == pytest.approx(2.0, rel=1e-3)


def test_a_linear_spring_has_none_and_an_unstable_rest_is_a_point():
    assert boundary(lambda q, _r, _l: -q, 1.0, 0.0, 0.0, 1) is None

    def unstable(q, _right, _left):
        return np.array([-q[0], 0.5 * q[1], -q[2]])

    assert boundary(unstable, 1.0, 0.0, 0.0, 3).x_um.tolist() == [0.0]
