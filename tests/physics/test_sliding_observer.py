"""The super-twisting observer: its recursion in numpy, its errors by the sample interval, and the loop around it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from core.block import Context, FloatArray
from core.board.board import Board
from core.control.observer import Observed, observe, observer_of
from core.control.velocity import OBSERVER_POLE
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


def velocities(
    bound: float, layer: float | None, measured: FloatArray, volts: FloatArray, device: Any, dt: float
) -> FloatArray:
    """Return the velocity of the observer: implicit in the error without a layer, else with sat(e/layer) for the sign.

    Implicit means that the error after the correction decides: the observer then switches without chatter.
    """
    tick = np.zeros((3, 3))
    tick[0, 1] = 1.0
    tick[1] = np.array([-device.stiffness, -device.damping, device.force]) / device.mass
    moved = expm(tick * dt)
    y, v, found = measured[0], 0.0, [0.0]
    root, jump = 1.5 * np.sqrt(bound) * dt, 1.1 * bound * dt * dt
    for now, later, volt in zip(measured[:-1], measured[1:], volts[:-1], strict=True):
        if layer is None:
            y, v = moved[:2, :2] @ (y, v) + moved[:2, 2] * volt
            e = later - y
            if abs(e) <= jump:
                y, v = later, v + e / dt
            else:
                left = ((np.sqrt(root * root + 4.0 * (abs(e) - jump)) - root) / 2.0) ** 2
                y, v = later - np.sign(e) * left, v + np.sign(e) * jump / dt
        else:
            e = now - y
            way = float(np.clip(e / layer, -1.0, 1.0)) if layer else float(np.sign(e))
            force = device.force * volt - device.damping * v - device.stiffness * (now + later) / 2.0
            rise = dt * (force / device.mass + 1.1 * bound * way)
            y += dt * (v + rise / 2.0 + 1.5 * np.sqrt(bound * max(abs(e), layer)) * way)
            v += rise
        found.append(v)
    return np.array(found)


def test_no_sampled_form_of_it_is_as_good_a_velocity_as_the_linear_observer() -> None:
    """Unexplained acceleration d moves the shuttle by dh^2/2 in a sample, its velocity by dh: half of it is lost."""
    board = make(
        {"controller": {"kind": "open_loop"}, "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": HZ}}
    )
    inject(board, stiffness=0.8)
    trace = play(board, 4000)
    device, dt, tail = board.spec.nominal, board.dt_ms, slice(2000, None)
    measured, volts = trace["sensor.displacement"], trace["drive.voltage"]
    unexplained = 0.8 * device.stiffness / device.mass * trace["plant.displacement"]
    bound = 1.2 * float(np.abs(unexplained[tail]).max())

    def error(layer: float | None, scale: float = 1.0) -> float:
        own = velocities(scale * bound, layer, measured, volts, device, dt)
        return rms((own - trace["plant.velocity"])[tail])

    implicit = error(None)
    assert implicit == pytest.approx(0.5 * dt * rms(unexplained[tail]), rel=0.05)
    assert implicit == pytest.approx(1.2, abs=0.1)
    assert error(None, scale=8.0) == pytest.approx(implicit, rel=0.05)
    assert error(4.0 * bound * dt * dt) > 1.3 * error(0.0) > 2.0 * implicit
    context = Context(dt_ms=dt, every=1, seed=1, device=device, model=device)
    packed = observer_of(device, context, OBSERVER_POLE * device.natural_frequency)
    observed, own = Observed(np.zeros(Observed.layout.size)), []
    for i, value in enumerate(measured):
        observe(packed, observed, value, volts[i - 1] if i else 0.0, 0.0, 0.0)
        own.append(observed.motion.v)
    assert rms((np.array(own) - trace["plant.velocity"])[tail]) < 0.25 * implicit
