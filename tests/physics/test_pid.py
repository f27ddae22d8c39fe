"""PID against the poles it places; open loop against its closed form."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from tests.lab import do, inject, make, play
from tests.physics.loop import A1, KP, W0, ZETA, figures


def test_step_overshoot_and_rise():
    found = figures({"reference": {"kind": "step", "amplitude_v": 10.0}}, {}, ms=8.0)
    assert found["control.overshoot_pct"] == pytest.approx(
        100 * math.exp(-math.pi * ZETA / math.sqrt(1 - ZETA**2)), abs=0.5
    )
    assert found["control.overshoot_pct"] == pytest.approx(72.27, abs=0.5)
    values = {"reference": {"kind": "step", "amplitude_v": 10.0}, "sample_rate_khz": 1000}
    x = play(make(values), 1000)["plant.displacement"]
    assert np.argmin(x) * 1e-3 == pytest.approx(math.pi / (W0 * math.sqrt(1 - ZETA**2)), abs=0.002)
    assert np.argmin(x) * 1e-3 == pytest.approx(0.202, abs=0.002)


@pytest.mark.parametrize("amplitude_um", [1.5, -0.7])
def test_amplitude_in_micrometres_is_displacement_at_rest(amplitude_um):
    values = {"reference": {"kind": "constant", "amplitude_um": amplitude_um}}
    assert play(make(values), 2000)["plant.displacement"][-1] == pytest.approx(amplitude_um, rel=1e-6)


def pid_gains(values: dict[str, Any]) -> tuple[float, float, float, float]:
    """Recover the gains of a running PID from its signals alone."""
    board = make({"controller": {"kind": "pid", **values}, "reference.amplitude_v": 2.0, "sensor.noise_um": 0.01})
    inject(board, stiffness=0.3)
    trace = play(board, 3000)
    assert board.trip is None and np.abs(trace["pid.voltage"]).max() < 30
    e = trace["model.displacement"] - trace["sensor.displacement"]
    np.testing.assert_allclose(trace["pid.error"], e, atol=1e-12)
    decay = math.exp(-0.01 * W0 / values.get("derivative_filter", 0.2))
    slope = lfilter([1 - decay], [1, -decay], np.diff(e, prepend=e[0]) / 0.01)
    area = np.cumsum(e) * 0.01
    basis = np.column_stack([trace["reference.voltage"], e, area, slope])
    found, *_ = np.linalg.lstsq(basis, trace["pid.voltage"], rcond=None)
    np.testing.assert_allclose(basis @ found, trace["pid.voltage"], atol=1e-8)
    return tuple(found)


@pytest.mark.parametrize("pole", [0.8, 1.3])
def test_pid_places_a_triple_pole(pole):
    _, proportional, integral, derivative = pid_gains({"pole": pole})
    # s^3 + (a1 + kp Kd) s^2 + (a2 + kp Kp) s + kp Ki in 1/w0, without the derivative filter
    closed = [1.0, A1 + KP * derivative * W0, 1.0 + KP * proportional, KP * integral / W0]
    companion = np.array([[0, 1, 0], [0, 0, 1], [-closed[3], -closed[2], -closed[1]]])
    np.testing.assert_allclose(np.linalg.eigvals(companion), -pole, atol=2e-3 * pole)
    np.testing.assert_allclose(closed, np.poly([-pole] * 3), rtol=1e-7)


def test_pid_takes_gains_as_magnitudes_and_feeds_forward():
    own = {"proportional_v_um": 3.0, "integral_v_um_ms": 20.0, "derivative_v_ms_um": 0.2, "feedforward": 0.7}
    assert pid_gains(own) == pytest.approx((0.7, -3.0, -20.0, -0.2), rel=1e-6)


def test_pid_follows_with_the_published_error():
    found = figures({"controller": {"kind": "pid", "pole": 1.3}}, {})
    assert found["control.tail_rms_error_um"] == pytest.approx(0.062, abs=0.005)


def test_pid_has_little_room():
    """Poles further out, half the sample rate, or a mass outside its design, and it swings without end."""

    def left(values: dict[str, Any], **faults: float) -> float:
        law = {"kind": "pid", "pole": 1.3, **values.pop("controller", {})}
        return figures({"guard.rail_ms": 1e6, **values, "controller": law}, faults)["control.tail_rms_error_um"]

    assert left({"sensor.noise_um": 0.01}) == pytest.approx(0.062, abs=0.005)
    assert 0.06 < left({"controller": {"pole": 2.0}, "sensor.noise_um": 0.01}) < 0.13
    assert left({"controller": {"pole": 2.5}}) > 0.2
    assert left({"sample_rate_khz": 50}) == pytest.approx(0.32, abs=0.05)
    assert left({}, added_mass=9.0) == pytest.approx(1.26, abs=0.1)
    assert left({}, added_mass=-0.9) > 1.0


def test_pid_integral_does_not_wind_up():
    """The target is out of reach for 30 ms, then within reach: the voltage leaves the limit at once."""
    values = {
        "controller": {"kind": "pid"},
        "drive.limit_v": 5.0,
        "guard.rail_ms": 1000.0,
        "reference": {"kind": "constant", "amplitude_v": 10.0},
    }
    board = make(values)
    far = play(board, 3000)
    assert np.all(far["drive.voltage"][1000:] == 5.0)
    error = far["pid.error"][-1]
    assert abs(error) == pytest.approx(5 * abs(KP), rel=0.01)
    wound = 1.3**3 / abs(KP) * W0 * abs(error) * 30.0
    assert np.abs(far["pid.integral"]).max() < 40 < 0.02 * wound
    assert np.ptp(far["pid.integral"][1500:]) < 1e-9
    do(board, {"set": {"reference.amplitude_v": 2.0}})
    near = play(board, 1500)
    assert np.flatnonzero(np.abs(near["drive.voltage"]) < 5.0)[0] < 20
    assert abs(near["pid.error"][-1]) < 1e-3
    assert near["drive.voltage"][-1] == pytest.approx(2.0, abs=0.01)


def test_pid_integral_moves_out_of_the_limit_again():
    """While saturated, an error of the other sign is still integrated."""
    values = {"controller": {"kind": "pid"}, "drive.limit_v": 5.0, "guard.rail_ms": 1000.0}
    board = make({**values, "reference": {"kind": "square", "amplitude_v": 10.0, "frequency_hz": 50.0}})
    trace = play(board, 6000)
    halves = trace["drive.voltage"][1000 + np.arange(5) * 1000 - 5]
    assert np.array_equal(halves, [5.0, -5.0, 5.0, -5.0, 5.0])
