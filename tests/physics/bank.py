"""The bench of section 5.2.4 and its hypotheses, written out here once more."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import expm

from core.block import Oscillator
from tests.lab import inject, make, play

M, BETA, K, FORCE = 2.2090e-10, 7.09e-7, 0.0538, -6.375e-9
FACTORS = {
    "healthy": (1, 1, 1),
    "m+5": (1.05, 1, 1),
    "m+10": (1.1, 1, 1),
    "k+5": (1, 1.05, 1),
    "k+10": (1, 1.1, 1),
    "b+30": (1, 1, 1.3),
}
NAMES = list(FACTORS)
NOMINAL = Oscillator(mass=M * 1e6, damping=BETA * 1e3, stiffness=K, force=FORCE * 1e6)
BENCH: dict[str, Any] = {
    "sample_rate_khz": 50,
    "device": {"id": "ch3", "force_n_per_v": 6.375e-9, "bias_v": 6.0},
    "plant": {"model": "linear", "drive_noise_v": 0.010, "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
    "sensor": {"kind": "ideal", "noise_um": 0.05},
    "diagnosers": {"kalman": {"kind": "mmae", "process_noise_v": 0.3}},
}


def model(factors: tuple[float, float, float], dt: float = 0.02) -> tuple[np.ndarray, np.ndarray]:
    """Discrete model under a held voltage, um, ms, V."""
    m, k, b = factors
    a = np.array([[0, 1, 0], [-K * k / (M * m) * 1e-6, -BETA * b / (M * m) * 1e-3, FORCE / (M * m)], [0, 0, 0]])
    block = expm(a * dt)
    return block[:2, :2], block[:2, 2:]


def signals(n: int, values: dict[str, Any] | None = None, faults: dict[str, float] | None = None):
    board = make({**BENCH, **(values or {})})
    inject(board, **(faults or {}))
    return play(board, n)


def of_bank(trace: dict[str, np.ndarray], what: str, names: list[str] = NAMES) -> np.ndarray:
    return np.column_stack([trace[f"kalman.{what}.{name}"] for name in names])
