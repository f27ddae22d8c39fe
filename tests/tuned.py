"""A bench whose sense axis has a tuning electrode, and its closed form: gyro-c with plates."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from scenarios.run import RunResult, run
from scenarios.schema import Scenario

EPSILON_0, BOLTZMANN = 8.8541878128e-12, 1.380649e-23
MASS_X, MASS_Y, K_X, K_Y, K_XY, D_X, D_Y = 1.42, 1.58, 863.7569, 987.2898, 0.272048, 7.4945e-3, 8.7964e-2
"""gyro-c in mg, uN/um, uN ms/um."""
AREA, GAP = 20 * 400.0 * 60.0, 3.0
OMEGA = np.sqrt(K_X / MASS_X)
TUNED: dict[str, Any] = {
    "sample_rate_khz": 20,
    "seed": 1,
    "device": {"id": "gyro-c", "electrodes": {"tuning": {}}},
    "plant": {"model": "tuned_gyroscope", "thermal_noise": False},
    "rate": {"kind": "constant", "deg_per_s": 0.0},
    "slots": {"drive": "drive_loop", "tuning": "tuning_voltage"},
    "controller": {"kind": "open_loop_rate", "correct_phase": True},
    "sensor": {"kind": "pick_off"},
}


def ran(duration_ms: float, changes: dict[str, Any] | None = None) -> RunResult:
    document = copy.deepcopy(TUNED) | {"duration_ms": duration_ms}
    for path, value in (changes or {}).items():
        table = document
        *parents, name = path.split(".")
        for parent in parents:
            table = table.setdefault(parent, {})
        table[name] = value
    return run(Scenario.load(document), taps=True)


def softening(volts: float) -> float:
    """Return 2 eps A V^2/g^3 of plates on both sides, uN/um."""
    return 2.0 * EPSILON_0 * AREA * 1e-12 * volts**2 / (GAP * 1e-6) ** 3


def split_hz(volts: float) -> float:
    return float(1e3 * (np.sqrt((K_Y - softening(volts)) / MASS_Y) - OMEGA) / (2.0 * np.pi))


def volts_for(split: float) -> float:
    return float(np.sqrt((K_Y - MASS_Y * (OMEGA + 2e-3 * np.pi * split) ** 2) / softening(1.0)))


def stiffness_of_y(omega: np.ndarray, volts: float) -> np.ndarray:
    return K_Y - softening(volts) - MASS_Y * omega**2 + 1j * omega * D_Y
