"""Faults of a device with two axes: its motion under the forces applied, by the matrix exponential."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.instances import faults_of
from core.errors import InputError
from tests.lab import do, fault, inject, make, play
from tests.two_axis import DAMPING, GYRO, OMEGA, STIFFNESS, STILL, rate_stiffness, replay

OWN = ("feed_through", "quadrature", "drive_loss", "sense_stiffness", "finger_pair_short", "package_leak")
UNCOUPLED = {"stiffness_xy_n_m": 0.0, "damping_xy_ns_m": 0.0}
CROSS = np.array([[0.0, 1.0], [1.0, 0.0]])


def moved(name: str, severity: float, **parameters: Any) -> tuple[dict[str, np.ndarray], np.ndarray]:
    board = make({**STILL, "plant.initial_y_um": 0.2}, base=GYRO)
    do(board, fault(name, severity, parameters=parameters))
    trace = play(board, 3000)
    assert np.all(trace[f"faults.{name}"] == severity)
    return trace, np.column_stack([trace["plant.x"], trace["plant.y"]])


@pytest.mark.parametrize(
    ("name", "severity", "parameters", "device"),
    [
        ("quadrature", 5e3, {}, {"stiffness": STIFFNESS + CROSS * rate_stiffness(5e3)}),
        ("drive_loss", 0.5, {}, {"gain": np.array([0.5, 1.0])}),
        ("sense_stiffness", 0.01, {}, {"stiffness": STIFFNESS * [[1.0, 1.0], [1.0, 1.01]]}),
        ("finger_pair_short", 5.0, {"pairs": 50}, {"gain": np.array([1.0, 0.9])}),
        ("finger_pair_short", 5.0, {"pairs": 50, "axis": "x"}, {"gain": np.array([0.9, 1.0])}),
        ("package_leak", 30.0, {"package_pa": 20.0, "gas_share": 0.6}, {"damping": DAMPING * (0.4 + 0.6 * 50 / 20)}),
    ],
)
def test_the_motion_is_that_of_the_changed_device(name, severity, parameters, device):
    trace, motion = moved(name, severity, **parameters)
    start = np.array([0.0, 0.2, 0.0, 0.0])
    np.testing.assert_allclose(motion, replay(trace, start=start, **device), atol=1e-11)
    assert abs(motion - replay(trace, start=start)).max() > 1e-4


def test_a_ramp_is_there_by_its_share():
    board = make(STILL, base=GYRO)
    do(board, fault("quadrature", 1000.0, profile={"kind": "ramp", "duration_ms": 10.0}))
    now = play(board, 2000)["faults.quadrature"]
    np.testing.assert_allclose(now[:1000], np.arange(1000.0), rtol=1e-12)
    assert np.all(now[1000:] == 1000.0)


def test_severity_0_is_bit_for_bit_no_fault_and_a_healed_one_leaves_none():
    healthy = make(base=GYRO)
    play(healthy, 200)
    for name, block in faults_of(("x", "y")).items():
        board = make(base=GYRO)
        inject(board, **{name: 0.0})
        play(board, 200)
        assert board.digest() == healthy.digest(), name
        inject(board, **{name: block.suggested})
        play(board, 5)
        do(board, {"heal": [name]})
        play(board, 1)
        for signal, place in board.wiring.index.items():
            if signal.startswith("effects."):
                assert board.wiring.w[place] == healthy.wiring.w[place], (name, signal)


def test_a_rebalanced_axis_reads_the_fault_as_quadrature():
    """gyro-c, rebalanced, reads 200 deg/s of its own, and then 500 more."""
    board = make({**STILL, "device.id": "gyro-c"}, base=GYRO)
    play(board, 60_000)
    inject(board, quadrature=500.0)
    trace = play(board, 60_000)
    assert trace["force_to_rebalance.quadrature"][0] == pytest.approx(200.0, rel=3e-3)
    assert trace["force_to_rebalance.quadrature"][-1] == pytest.approx(700.0, rel=3e-3)
    assert abs(trace["force_to_rebalance.rate"][-1]) < 0.5


def test_the_drive_is_seen_by_the_pick_off_of_the_sensing_axis_alone():
    board = make(STILL, base=GYRO)
    healthy = play(board, 50)
    do(board, fault("feed_through", 300.0))
    trace = play(board, 500)
    errors = trace["sensor.y.displacement"] - trace["plant.y"]
    # the sensor looks before the drive of this tick moves
    np.testing.assert_allclose(errors[1:], 300e-6 * trace["drive.x.force"][:-1], rtol=1e-9, atol=1e-15)
    assert (trace["sensor.x.displacement"] == trace["plant.x"]).all()
    assert (healthy["sensor.y.displacement"] == healthy["plant.y"]).all()


def test_feed_through_is_read_as_the_rate_of_the_closed_form():
    """-s d_xx (k_yy - m_y w^2)/4 m_c, times the cosine of half a sample, of the nominal sense axis of gyro-c."""
    base = {**GYRO, "controller": {"kind": "open_loop_rate"}}
    uncoupled = {"device.id": "gyro-c", "device.gyroscope": {"stiffness_xy_n_m": 0.0}}
    board = make({**STILL, **uncoupled}, base=base)
    do(board, fault("feed_through", 2000.0))
    read = play(board, 60_000)["open_loop_rate.rate"]
    omega = np.sqrt(863.7569 / 1.42)
    spring = 987.2898 - 1.58 * omega**2
    expected = -2000e-6 * 7.4945e-3 * spring / (4.0 * 1.58) * np.cos(0.5 * omega * 0.01)
    assert read[-1] == pytest.approx(np.degrees(1e3 * expected), rel=5e-3)


def test_half_the_drive_takes_twice_the_force():
    board = make({**STILL, "device.gyroscope": UNCOUPLED}, base=GYRO)
    play(board, 30_000)
    inject(board, drive_loss=0.5)
    force = play(board, 30_000)["drive_loop.force"]
    assert force[0] == pytest.approx(DAMPING[0, 0] * OMEGA * 1.0, rel=5e-3)
    assert force[-1] == pytest.approx(2.0 * force[0], rel=5e-3)


def test_no_fault_of_axes_is_on_a_bench_of_one_displacement():
    assert not set(OWN) & set(faults_of(()))
    assert set(OWN) <= set(faults_of(("x", "y")))
    board = make()
    with pytest.raises(InputError, match=r"needs x, y; linear has one displacement"):
        inject(board, quadrature=1.0)
    assert not board.faults


def test_no_more_pairs_are_shorted_than_there_are():
    board = make(base=GYRO)
    with pytest.raises(InputError, match="the comb has 50 pairs"):
        do(board, fault("finger_pair_short", 51.0, parameters={"pairs": 50}))
    assert not board.faults
