"""Gyroscopes: a bench of one and of two, and the same plant by scipy and by numpy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from core.block import FloatArray
from core.board.board import CHUNK, Board
from core.device.two_axis import TwoAxis
from core.units import rate_rad_ms
from scenarios.speed.timing import cpu_ns

DEG_PER_S = 100.0
ONE: dict[str, Any] = {
    "device": {"id": "gyro-c"},
    "plant": {"model": "gyroscope", "thermal_noise": False},
    "rate": {"kind": "constant", "deg_per_s": DEG_PER_S},
    "slots": {"drive": "drive_loop"},
    "controller": {"kind": "force_to_rebalance"},
    "readouts": {"allan": {"kind": "allan"}},
    "sample_rate_khz": 100,
}
"""Drive loop and force to rebalance, with an Allan deviation of the rate."""

PAIR: dict[str, Any] = {
    "device": {"id": "gyro-4-5"},
    "plant": {"model": "gyroscope_pair"},
    "slots": {"drive": "drive_tracking"},
    "controller": {"kind": "sense_axis_sync"},
    "sample_rate_khz": 100,
}
"""Two gyroscopes in step, with all their noise."""

ALIVE = ("plant", "effects", "sensor.x", "sensor.y", "rate", "drive_loop", "force_to_rebalance", "drive.x", "drive.y")
"""Blocks that keep every signal of a bench with two axes moving."""


def running(bench: dict[str, Any]) -> Board:
    """Return the board of a bench that has begun to swing."""
    board = Board(bench)
    board.advance(CHUNK)
    return board


def system_of(device: TwoAxis) -> FloatArray:
    r"""Return A of :math:`x'=Ax`, with :math:`x=(q,\dot q,F)` and a force that is held, 1/ms."""
    turning = 2.0 * device.coriolis_mass * rate_rad_ms(DEG_PER_S) * np.array([[0.0, -1.0], [1.0, 0.0]])
    inverse = np.diag(1.0 / np.diag(device.masses))
    a = np.zeros((6, 6))
    a[:2, 2:4] = np.eye(2)
    a[2:4] = inverse @ np.hstack([-device.stiffnesses, -device.dampings - turning, np.eye(2)])
    return a


def solved_sample(device: TwoAxis, dt_ms: float, samples: int = 100) -> Callable[[], float]:
    """Return the measurement of ``scipy.integrate.solve_ivp`` from sample to sample, as in a loop, ns per sample."""
    a, start = system_of(device), np.array([5.0, 0.0, 0.0, 0.0, 0.0, 1.0])

    def work() -> None:
        x = start
        for _ in range(samples):
            x = solve_ivp(lambda _, x: a @ x, (0.0, dt_ms), x, method="DOP853", rtol=1e-9, atol=1e-12).y[:, -1]

    return lambda: cpu_ns(work, samples)


def stepped_sample(device: TwoAxis, dt_ms: float, samples: int = 5000) -> Callable[[], float]:
    """Return the measurement of a numpy loop with the transition matrix known, ns per sample."""
    step, start = expm(system_of(device) * dt_ms), np.array([5.0, 0.0, 0.0, 0.0, 0.0, 1.0])

    def work() -> None:
        x = start
        for _ in range(samples):
            x = step @ x

    return lambda: cpu_ns(work, samples)
