"""LQG against python-control: gains, the covariance they predict, and a device that moves as another model."""

from __future__ import annotations

from typing import Any

import control
import numpy as np
import pytest
from scipy.linalg import solve_discrete_lyapunov

from core.control.lqg import Lqg
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from tests.physics.loop import sampled

NOISY = {"controller.kind": "lqg", "plant.drive_noise_v": 1.0, "plant.thermal_noise": False, "duration_ms": 500.0}


def packed(scenario: Scenario, **values: float) -> Any:
    return Lqg.Packed(Lqg.packed(Lqg.Params(**values), scenario.spec.context(1)))


@pytest.mark.parametrize(("rate_khz", "cost", "drift", "noise"), [(100, 0.03, 1.0, 0.05), (20, 1.0, 0.1, 0.2)])
def test_gains_are_the_gains_of_python_control(rate_khz: float, cost: float, drift: float, noise: float) -> None:
    scenario = with_values(get("first-look"), {"sample_rate_khz": rate_khz})
    own = packed(scenario, voltage_cost_um_v=cost, process_noise_v=drift, sensor_noise_um=noise)
    a, b = sampled(scenario.spec.nominal, scenario.spec.dt_ms)
    c = np.array([[1.0, 0.0]])
    regulator, *_ = control.dlqr(a, b, c.T @ c, [[cost**2]])
    np.testing.assert_allclose(own.regulate, regulator[0], rtol=1e-9)
    # dlqe returns the gain of the predictor, A times the gain of the filter
    predictor, *_ = control.dlqe(a, b, c, [[drift**2]], [[noise**2]])
    np.testing.assert_allclose(a @ own.correct, np.ravel(predictor), rtol=1e-9)


def test_unless_given_the_noise_is_the_noise_of_the_sensor() -> None:
    scenario = with_values(get("first-look"), {"sensor.noise_um": 0.2})
    np.testing.assert_array_equal(packed(scenario).correct, packed(scenario, sensor_noise_um=0.2).correct)


def test_the_error_is_the_error_that_both_gains_predict() -> None:
    scenario = with_values(get("first-look"), NOISY)
    a, b = sampled(scenario.spec.nominal, scenario.spec.dt_ms)
    own, c = packed(scenario), np.array([[1.0, 0.0]])
    k, gain = own.regulate[None, :], own.correct[:, None]
    drift, noise = 1.0, scenario.spec.context(1).sensor_noise_um ** 2
    # tracking error d and error of the estimate: d' = (A - BK) d + BK eps + Bw, eps' = (I - LC)(A eps + Bw) - Lv
    keep = np.eye(2) - gain @ c
    loop = np.block([[a - b @ k, b @ k], [np.zeros((2, 2)), keep @ a]])
    enters = np.block([[b, np.zeros((2, 1))], [keep @ b, -gain]])
    covariance = solve_discrete_lyapunov(loop, enters @ np.diag([drift, noise]) @ enters.T)
    error = run(scenario).metrics["control.tail_rms_error_um"]
    assert error == pytest.approx(np.sqrt(covariance[0, 0]), rel=0.05)
    open_loop = solve_discrete_lyapunov(a, drift * b @ b.T)
    assert covariance[0, 0] < 0.3 * open_loop[0, 0]


def test_a_device_moves_as_another_model_moves() -> None:
    """u = (m a + b v + k y) / F about the model, whose a is its own; without noise the estimate is exact."""
    model = {"kind": "transfer_function", "numerator": [0.2], "denominator": [1.0, 1.4, 2.0]}
    values = {"controller": {"kind": "lqg"}, "model": model, "events": [], "expect": [], "printed": []}
    scenario = with_values(get("ch3-case1-aged-mass"), values)
    spec = scenario.spec
    device, wanted = spec.nominal, spec.context(1).model
    assert wanted.stiffness / wanted.mass == pytest.approx(2.0 * device.stiffness / device.mass)
    gains = np.array(packed(scenario).regulate)
    hz = scenario.document["reference"]["frequency_hz"]
    z = np.exp(2j * np.pi * 1e-3 * hz * spec.dt_ms)

    def phasors(a: Any, b: Any) -> Any:
        return np.linalg.solve(z * np.eye(2) - a, b)[:, 0]

    motion, follows = phasors(*sampled(device, spec.dt_ms)), phasors(*sampled(wanted, spec.dt_ms))
    y, v = follows
    acceleration = (wanted.force - wanted.damping * v - wanted.stiffness * y) / wanted.mass
    asked = (device.mass * acceleration + device.damping * v + device.stiffness * y) / device.force
    left = abs(motion[0] * (asked + gains @ follows) / (1.0 + gains @ motion) - follows[0])
    error = 10.0 * left / np.sqrt(2.0)
    assert run(scenario).metrics["control.tail_rms_error_um"] == pytest.approx(error, rel=5e-3)
    assert error < 0.05 * 10.0 * abs(motion[0] - follows[0]) / np.sqrt(2.0), "open loop"
