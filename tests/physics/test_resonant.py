"""Resonant control: the internal model removes the error at its tones, with its rate, while the phases allow it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.board import Board
from tests.lab import inject, make, play
from tests.physics.loop import faulty, sampled


def bench(hz: float = 1000.0, **own: Any) -> Board:
    reference = {"kind": "sine", "amplitude_v": 4.0, "frequency_hz": hz}
    return make({"controller": {"kind": "resonant", **own}, "reference": reference})


def test_the_loop_is_the_loop_of_the_matrices() -> None:
    """One complex resonator over the response of the nominal device, by numpy alone."""
    board = bench(rate=0.3)
    context = board.spec.context(1)
    device, dt = context.device, board.dt_ms
    inject(board, added_mass=0.1)
    trace = play(board, 1500)
    over, push = sampled(device, dt)
    a, b = sampled(faulty(device, mass=1.1), dt)
    z = np.exp(2j * np.pi * 1e-3 * 1000.0 * dt)
    response = np.linalg.solve(z * np.eye(2) - over, push)[0, 0]
    rate = 0.3 * device.damping / (2.0 * device.mass)
    x, y, xi, found = np.zeros(2), np.zeros(2), 0j, []
    for r in trace["reference.voltage"]:
        xi = z * xi + dt * (y[0] - x[0])
        u = r + 2.0 * rate * (xi / response).real  # the model is the nominal device: its motion asks for r
        found.append((x[0], u))
        x, y = a @ x + b[:, 0] * u, over @ y + push[:, 0] * r
    for name, column in zip(("plant.displacement", "resonant.voltage"), np.transpose(found), strict=True):
        np.testing.assert_allclose(trace[name], column, atol=1e-9 * np.abs(column).max())


@pytest.mark.parametrize("hz", [300.0, 2000.0, 4000.0])
def test_the_error_decays_with_its_rate(hz: float) -> None:
    board = bench(hz, rate=0.05)
    device = board.spec.context(1).device
    rate = 0.05 * device.damping / (2.0 * device.mass)
    inject(board, damping=0.02)
    error = play(board, 8000)["resonant.error"]
    span = round(1e5 / hz) * max(1, round(hz / 500.0))  # whole periods
    sizes = [np.sqrt(np.mean(error[at : at + span] ** 2)) for at in (1500, 4500)]
    assert np.log(sizes[0] / sizes[1]) / (3000 * board.dt_ms) == pytest.approx(rate, rel=0.05)


@pytest.mark.parametrize("count", [1, 3, 8])
def test_a_square_wave_keeps_only_the_harmonics_without_a_resonator(count: int) -> None:
    reference = {"kind": "square", "amplitude_v": 4.0, "frequency_hz": 400.0}
    board = make({"controller": {"kind": "resonant", "harmonics": count}, "reference": reference})
    inject(board, damping=1.0)
    error = play(board, 8000)["resonant.error"][-2500:]
    lines = np.abs(np.fft.rfft(error))[10::10] / 1250
    odd = range(0, 10, 2)
    assert all(lines[i] < 1e-4 for i in odd if i < count)
    assert all(lines[i] > 1e-2 for i in odd if i >= count)


def test_a_reference_without_a_tone_has_an_integrator() -> None:
    board = make({"controller": {"kind": "resonant"}, "reference": {"kind": "step", "amplitude_v": 4.0}})
    inject(board, stiffness=0.3)
    trace = play(board, 6000)
    assert trace["plant.displacement"][-1] == pytest.approx(trace["model.displacement"][-1], rel=1e-6)


def test_nothing_winds_up_while_the_drive_is_at_its_limit() -> None:
    reference = {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 1000.0}
    board = make({"controller": {"kind": "resonant"}, "reference": reference, "drive": {"limit_v": 11.0}})
    inject(board, stiffness=0.5)
    play(board, 4000)
    inject(board, stiffness=0.0)
    trace = play(board, 600)
    assert np.abs(trace["resonant.correction"]).max() < 12.0
    assert np.abs(trace["resonant.error"][-100:]).max() < 0.2 * np.abs(trace["model.displacement"]).max()


def test_a_phase_that_turns_by_more_than_a_quarter_makes_the_loop_unstable() -> None:
    """The tone is below the resonance of the nominal device, and above the resonance of the heavy one."""
    for mass, is_stable in ((0.1, True), (1.5, False)):
        board = bench(2200.0, rate=0.1)
        device, z = board.spec.context(1).device, np.exp(2j * np.pi * 2.2 * board.dt_ms)

        def response(scale: float) -> complex:
            over, push = sampled(faulty(device, mass=scale), board.dt_ms)  # noqa: B023
            return complex(np.linalg.solve(z * np.eye(2) - over, push)[0, 0])  # noqa: B023

        assert ((response(1.0 + mass) / response(1.0)).real > 0.0) == is_stable
        inject(board, added_mass=mass)
        size = np.abs(play(board, 6000)["resonant.correction"])
        assert (size[-300:].max() < 1.1 * size[2000:2300].max()) == is_stable
