"""What theory says of the loop of chapter 3: response, effort, and a run of it with faults from the start."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.signal import cont2discrete

from core.block import FloatArray, Oscillator
from scenarios.run import run
from scenarios.schema import Scenario
from tests.lab import document

W0 = math.sqrt(0.0538 / 2.2090e-10) * 1e-3  # rad/ms
ZETA = 7.09e-7 / (2 * math.sqrt(0.0538 * 2.2090e-10))
A1 = 2 * ZETA
KP = -4 * 24 * 8.8541878128e-12 * (2.0 / 2.1) * 20.0 / 0.0538 * 1e6  # um/V
F1 = 1e3 / (2 * math.pi)  # 1 krad/s
LABELS = ("r", "w1", "w2", "y")


def response(w: float, mass: float = 1.0, stiffness: float = 1.0, damping: float = 1.0) -> complex:
    """Displacement per volt at w rad/ms."""
    s = 1j * w / W0
    return KP / (mass * s**2 + damping * A1 * s + stiffness)


def effort(w: float, **fault: float) -> float:
    return abs(response(w) / response(w, **fault))


def figures(values: dict[str, Any], faults: dict[str, float], ms: float = 100.0) -> dict[str, float]:
    """Run 100 ms with faults from the start and return the metrics."""
    events = [{"at_sample": 0, "fault": name, "severity": size} for name, size in faults.items()]
    return run(Scenario.load({**document(values), "duration_ms": ms, "events": events})).metrics


def sampled(device: Oscillator, dt_ms: float) -> tuple[FloatArray, FloatArray]:
    """Return displacement and velocity of a device over a sample under a held voltage, by scipy."""
    a = np.array([[0.0, 1.0], [-device.stiffness / device.mass, -device.damping / device.mass]])
    b = np.array([[0.0], [device.force / device.mass]])
    over, push, *_ = cont2discrete((a, b, np.eye(2), np.zeros((2, 1))), dt_ms)
    return over, push


def faulty(device: Oscillator, mass: float = 1.0, stiffness: float = 1.0, damping: float = 1.0) -> Oscillator:
    """Return a device with scaled coefficients."""
    return Oscillator(device.mass * mass, device.damping * damping, device.stiffness * stiffness, device.force)
