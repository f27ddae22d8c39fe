"""A bench with two axes, and its device as matrices: motion by the matrix exponential."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import expm

MASS = 0.18
STIFFNESS = np.array([[63.955, 12.779], [12.779, 95.92]])
DAMPING = np.array([[1.8e-3, 3.6e-4], [3.6e-4, 1.8e-3]])
"""gyro-a in mg, uN/um, uN ms/um."""
OMEGA = float(np.sqrt(63.955 / MASS))
TURN = np.array([[0.0, -1.0], [1.0, 0.0]])

GYRO: dict[str, Any] = {
    "sample_rate_khz": 100,
    "seed": 1,
    "device": {"id": "gyro-a"},
    "plant": {"model": "gyroscope"},
    "slots": {"drive": "drive_loop"},
    "controller": {"kind": "force_to_rebalance"},
    "sensor": {"kind": "pick_off", "noise_pm_rthz": 0.1},
}
"""A gyroscope that is driven and rebalanced, with thermal noise and 22 pm of noise in a sample."""
STILL = {"plant.thermal_noise": False, "sensor.noise_pm_rthz": 0.0}


def rate_stiffness(dps: float) -> float:
    """Return 2 m w of a rate in deg/s, uN/um."""
    return 2.0 * MASS * OMEGA * np.radians(dps) * 1e-3


def held(stiffness: np.ndarray, damping: np.ndarray, mass: float, h: float) -> tuple[np.ndarray, np.ndarray]:
    """Return transition of (x, y, x', y') and effect of forces held over a sample."""
    whole = np.zeros((6, 6))
    whole[:2, 2:4] = np.eye(2)
    whole[2:4, :2], whole[2:4, 2:4], whole[2:4, 4:] = -stiffness / mass, -damping / mass, np.eye(2) / mass
    step = expm(whole * h)
    return step[:4, :4], step[:4, 4:]


def replay(
    trace: dict[str, np.ndarray],
    *,
    stiffness: np.ndarray = STIFFNESS,
    damping: np.ndarray = DAMPING,
    mass: float = MASS,
    gain: np.ndarray | float = 1.0,
    start: np.ndarray | None = None,
    h: float = 0.01,
) -> np.ndarray:
    """Return x and y of a device under the forces of a trace, which are held."""
    phi, gamma = held(stiffness, damping, mass, h)
    forces = np.column_stack([trace["drive.x.force"], trace["drive.y.force"]]) * gain
    q = np.zeros(4) if start is None else start
    found = [q]
    for force in forces[:-1]:
        q = phi @ q + gamma @ force
        found.append(q)
    return np.array(found)[:, :2]
