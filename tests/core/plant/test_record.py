"""A voltage between samples, against the motion of a device under the held voltage that comes later."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm

from core.plant.record import delayed

PERIOD = 12
"""Samples of a period of the device."""
STIFFNESS, DAMPING = (2 * np.pi / PERIOD) ** 2, 2 * np.pi / PERIOD / 8


def moved(drive: np.ndarray, delay: float) -> np.ndarray:
    """Return the displacement of an oscillator: each sample acts from its time plus the delay on."""
    dynamics = np.array([[0.0, 1.0, 0.0], [-STIFFNESS, -DAMPING, 1.0], [0.0, 0.0, 0.0]])
    whole, rest = int(delay), delay - int(delay)
    before, after = expm(dynamics * rest), expm(dynamics * (1.0 - rest))
    x, found = np.zeros(2), np.zeros(len(drive))
    for k in range(len(drive)):
        found[k] = x[0]
        for step, at in ((before, k - whole - 1), (after, k - whole)):
            x = (step @ [*x, drive[max(at, 0)]])[:2]
    return found


def chirp() -> np.ndarray:
    t = np.arange(600.0) / PERIOD
    return np.sin(2 * np.pi * (0.4 * t + 0.6 * t * t / t[-1]))


def steps() -> np.ndarray:
    return np.repeat(np.random.default_rng(3).choice([-1.0, 1.0], 200), 3)


@pytest.mark.parametrize(("drive", "most"), [(chirp(), 0.01), (steps(), 0.02)], ids=["chirp", "steps"])
@pytest.mark.parametrize("delay", [1.4, 2.5, 3.7])
def test_a_voltage_between_samples_moves_a_device_as_the_late_voltage_does(drive, most, delay):
    late = moved(drive, delay)
    error = np.abs(moved(delayed(drive, delay, 0, len(drive)), 0.0) - late)[40:].max() / np.abs(late).max()
    assert error < most


@pytest.mark.parametrize("delay", [0.3, 0.8])
def test_a_delay_below_a_sample_reads_no_later_sample(delay):
    drive = chirp()
    found = [delayed(drive[:end], delay, 0, end)[99] for end in (100, 600)]
    assert found[0] == found[1]
    late = moved(drive, delay)
    error = np.abs(moved(delayed(drive, delay, 0, len(drive)), 0.0) - late)[40:].max() / np.abs(late).max()
    assert error < 0.04


def test_parts_of_a_voltage_are_the_whole():
    drive = chirp()
    parts = np.concatenate([delayed(drive, 2.3, first, first + 200) for first in (0, 200, 400)])
    np.testing.assert_array_equal(parts, delayed(drive, 2.3, 0, 600))
