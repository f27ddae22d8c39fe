"""Thermal noise of both axes of a gyroscope: equipartition, correlation, streams."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.block import Context
from core.device.catalogue import device
from core.device.two_axis import TwoAxis
from core.plant.gyroscope import Gyroscope
from core.plant.gyroscope_pair import GyroscopePair
from tests.plant_alone import PlantAlone

KT = 1.380649e-23 * 300.0 * 1e12
"""uN um."""
MOTION = ("x", "y", "x_velocity", "y_velocity")


def damped(cross: float = 0.8) -> TwoAxis:
    """Return device A with Q of 20 and a cross damping that is a share of the others."""
    nominal = device({"id": "gyro-a"}).oscillator()
    assert isinstance(nominal, TwoAxis)
    d = (nominal.stiffness * nominal.mass) ** 0.5 / 20.0
    return replace(nominal, damping=d, damping_y=d, damping_xy=cross * d)


def context(nominal: TwoAxis, khz: float = 100.0, seed: int = 1) -> Context:
    return Context(dt_ms=1.0 / khz, every=1, seed=seed, device=nominal, model=nominal)


@pytest.mark.long
@pytest.mark.parametrize("khz", [20.0, 100.0])
@pytest.mark.parametrize("deg_per_s", [0.0, 2e5])
def test_equipartition_on_both_axes(khz, deg_per_s):
    r"""Whatever the cross damping and the rate, :math:`\langle qq^T\rangle=k_BTK^{-1}` and
    :math:`\langle\dot q\dot q^T\rangle=k_BTM^{-1}`.

    At 20 kHz a sample is 0.9 and 1.2 over the frequencies of the modes: a force held that long, not made up for, would
    leave 7 and 11 % less. One decay is 4 ms, so 2e6 samples hold 1.6e4 of them and the variances are known to 1 %.
    """
    nominal = damped()
    plant = PlantAlone(Gyroscope, context(nominal, khz))
    plant["rate"] = deg_per_s
    ticks = int(2e4 * khz) if khz > 50 else int(1e6)
    found = plant.play(ticks, *MOTION)[:, int(50 * khz) :]
    inverse = np.linalg.inv(nominal.stiffnesses)
    for got, expected in ((np.cov(found[:2]), KT * inverse), (np.cov(found[2:]), KT * np.linalg.inv(nominal.masses))):
        scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
        np.testing.assert_allclose(got / scale, expected / scale, atol=0.05)


def test_cross_damping_correlates_the_forces():
    """From zero, with springs that do not matter yet, velocities after one sample come from the force alone."""
    nominal = damped(-0.6)
    force = []
    for seed in range(4000):
        plant = PlantAlone(Gyroscope, context(nominal, 1000.0, seed))
        force.append(plant.play(2, "x_velocity", "y_velocity")[:, 1])
    found = np.cov(np.array(force).T)
    dt = 1e-3
    expected = 2.0 * KT * nominal.dampings * dt / nominal.mass**2
    np.testing.assert_allclose(found / expected[0, 0], expected / expected[0, 0], atol=0.07)


def test_noise_is_a_function_of_seed_and_tick_alone():
    nominal = damped()
    first, again, late, other = (PlantAlone(Gyroscope, context(nominal, seed=seed)) for seed in (1, 1, 1, 2))
    straight = first.play(50, *MOTION)
    np.testing.assert_array_equal(again.play(50, *MOTION), straight)
    assert np.all(other.play(50, *MOTION)[:, 1:] != straight[:, 1:])
    # a plant that begins at another tick, in the state of the first, continues like it
    for name, value in zip(MOTION, straight[:, 29], strict=True):
        late[name] = value
    late.w[0] = 30.0
    np.testing.assert_array_equal(late.play(20, *MOTION), straight[:, 30:])


def test_axes_and_partner_have_streams_of_their_own():
    nominal, velocities = damped(0.0), []
    names = ("x_velocity", "y_velocity", "partner_x_velocity", "partner_y_velocity")
    for seed in range(800):
        pair = PlantAlone(GyroscopePair, context(nominal, 1000.0, seed))
        velocities.append(pair.play(2, *names)[:, 1])
    np.testing.assert_allclose(np.corrcoef(np.array(velocities).T), np.eye(4), atol=4.5 / 800**0.5)


def test_without_thermal_noise_rest_stays_rest():
    plant = PlantAlone(Gyroscope, context(damped()), thermal_noise=False)
    plant["rate"] = 100.0
    assert not plant.play(100, *MOTION).any()
