"""A control loop simulated from the equations alone: device, copied model, and a law given as a function."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.linalg import expm

W0 = math.sqrt(0.0538 / 2.2090e-10) * 1e-3
"""Resonance of the device of chapter 3, rad/ms."""
A1 = 7.09e-7 / math.sqrt(0.0538 * 2.2090e-10)
KP = -4 * 24 * 8.8541878128e-12 * (2.0 / 2.1) * 20.0 / 0.0538 * 1e6
"""Damping and um per volt of the device in units of 1/w0."""
KRAD = 1e3 / (2 * math.pi)
"""1 krad/s in Hz."""


def held(a1: float, a2: float, gain: float, h: float) -> tuple[np.ndarray, np.ndarray]:
    """Return transition and effect of a held volt of x'' + a1 x' + a2 x = gain u."""
    system = expm(np.array([[0, 1, 0], [-a2, -a1, gain], [0, 0, 0]]) * h)
    return system[:2, :2], system[:2, 2]


def simulate(
    law: Callable[..., float], n: int, h: float, *, mass: float = 1.0, stiffness: float = 1.0, limit: float = 30.0
) -> dict[str, np.ndarray]:
    """Run n samples at 1 krad/s and 10 V; the law is given r, (y, y'), (ym, ym') and the voltage applied before."""
    plant = held(A1 / mass, stiffness / mass, KP / mass, h)
    model = held(A1, 1.0, KP, h)
    x, m, u, r = np.zeros(2), np.zeros(2), 0.0, 0.0
    kept: dict[str, list[Any]] = {"y": [], "ym": [], "u": []}
    for i in range(n):
        if i:
            x = plant[0] @ x + plant[1] * u
            m = model[0] @ m + model[1] * r
        r = 10.0 * math.sin(1.0 / W0 * h * i)
        u = min(max(law(r, x, m, u), -limit), limit)
        for key, value in (("y", x[0]), ("ym", m[0]), ("u", u)):
            kept[key].append(value)
    return {key: np.array(values) for key, values in kept.items()}


def follow(signal: float, state: float, h: float, pole: float = 1.0) -> float:
    """Advance q' = -pole q + signal with a held signal."""
    decay = math.exp(-pole * h)
    return decay * state + (1.0 - decay) / pole * signal


def tail(board_trace: dict[str, np.ndarray], share: float = 0.25) -> np.ndarray:
    """Return the tracking error of the last part of a trace."""
    error = board_trace["plant.displacement"] - board_trace["model.displacement"]
    return error[int(len(error) * (1.0 - share)) :]
