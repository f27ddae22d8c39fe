"""The super-twisting observer: its recursion in numpy, its errors by the sample interval, and the loop around it."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from tests.lab import inject, make, play, rms
from tests.physics.loop import faulty, sampled

HZ, VOLTS, BOUND = 461.5, 4.0, 100.0
BANDWIDTH = 2.0


def bench(rate_khz: float = 100.0, **values: Any) -> Board:
    reference = {"kind": "sine", "amplitude_v": VOLTS, "frequency_hz": HZ}
    law = {"kind": "sliding_observer"}
    board = make({"controller": law, "reference": reference, "sample_rate_khz": rate_khz, **values})
    inject(board, stiffness=0.2)
    return board


def test_it_is_the_recursion_in_numpy() -> None:
    board = bench()
    trace = play(board, 400)
    device, dt = board.spec.nominal, board.dt_ms
    measured, applied = trace["sensor.displacement"], trace["drive.voltage"]
    y, v, wanted = measured[0], 0.0, [(measured[0], 0.0)]
    for now, later, volt in zip(measured[:-1], measured[1:], applied[:-1], strict=True):
        force = device.force * volt - device.damping * v - device.stiffness * (now + later) / 2.0
        rise = dt * (force / device.mass + 1.1 * BOUND * np.sign(now - y))
        y += dt * (v + rise / 2.0 + 1.5 * np.sqrt(BOUND * abs(now - y)) * np.sign(now - y))
        v += rise
        wanted.append((y, v))
    got = np.column_stack([trace[f"sliding_observer.{name}"] for name in ("estimate", "velocity")])
    np.testing.assert_allclose(got, wanted, atol=1e-6)


def test_its_errors_are_the_sample_and_its_square() -> None:
    """Levant 1998: homogeneity makes the error of the velocity O(h), the error of the displacement O(h^2)."""
    worst = []
    for rate_khz in (100, 200, 400):
        trace = play(bench(rate_khz), rate_khz * 30)
        pairs = (("velocity", "velocity"), ("estimate", "displacement"))
        off = [np.abs(trace[f"sliding_observer.{own}"] - trace[f"plant.{true}"]) for own, true in pairs]
        worst.append([one[len(one) // 2 :].max() for one in off])
    velocity, displacement = np.array(worst).T
    np.testing.assert_allclose(velocity[:-1] / velocity[1:], 2.0, rtol=0.25)
    np.testing.assert_allclose(displacement[:-1] / displacement[1:], 4.0, rtol=0.25)


def test_the_loop_is_the_loop_with_the_true_velocity_within_the_error_of_the_estimate() -> None:
    board = bench(400)
    trace = play(board, 16_000)
    device, dt = board.spec.nominal, board.dt_ms
    z = np.exp(2j * np.pi * HZ * 1e-3 * dt)
    rate = BANDWIDTH * device.natural_frequency
    gains = np.array([device.mass * rate**2 - device.stiffness, 2.0 * device.mass * rate - device.damping])
    gains = gains / device.force

    def phasors(one: tuple[FloatArray, FloatArray], at: complex) -> FloatArray:
        found: FloatArray = np.linalg.solve(at * np.eye(2) - one[0], one[1])[:, 0]
        return found

    nominal, true = sampled(device, dt), sampled(faulty(device, stiffness=1.2), dt)
    wanted, motion = phasors(nominal, z), phasors(true, z)
    driven = (1.0 + gains @ wanted) / (1.0 + gains @ motion)
    error = VOLTS * abs(wanted[0] - motion[0] * driven) / np.sqrt(2.0)
    around = np.exp(1j * np.linspace(1e-3, np.pi, 2000))
    reach = max(abs(one[0] / (1.0 + gains @ one)) for one in (phasors(true, at) for at in around))
    tail = slice(8000, None)
    off = (trace["sliding_observer.velocity"] - trace["plant.velocity"])[tail]
    moved = reach * abs(gains[1]) * rms(off)
    left = rms((trace["model.displacement"] - trace["plant.displacement"])[tail])
    assert abs(left - error) <= moved < error
    assert error < 0.5 * VOLTS * abs(wanted[0] - motion[0]) / np.sqrt(2.0), "open loop"


def test_beyond_its_bound_the_estimate_is_lost() -> None:
    off = []
    for stiffness in (0.1, 1.5):
        board = bench()
        inject(board, stiffness=stiffness)
        trace = play(board, 4000)
        unexplained = stiffness * board.spec.nominal.natural_frequency**2 * np.abs(trace["plant.displacement"])
        assert (unexplained.max() > BOUND) == (stiffness == 1.5)
        off.append(np.abs(trace["sliding_observer.velocity"] - trace["plant.velocity"])[2000:].max())
    assert off[1] > 3.0 * off[0]
