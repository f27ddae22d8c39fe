from __future__ import annotations

import math

import numpy as np
import pytest

from core.ports import RESERVED
from core.sense.grating import level
from core.sense.peak_valley import PeakValley
from tests.core.sense.bench import errors, lost, make

COUNTER = {"sensor.kind": "peak_valley"}


def recover(x: np.ndarray, offset: float) -> np.ndarray:
    """Let the unit count a noiseless signal along any path that begins at zero."""
    context = make({"sensors.through_wafer.grating_offset_um": offset}).spec.context()
    p = PeakValley.Packed(PeakValley.packed(PeakValley.Params(), context))
    s = PeakValley.state(PeakValley.Params(), context)
    places = RESERVED + np.arange(len(PeakValley.Ports.declared))
    unit = PeakValley.Ports(np.zeros(places[-1] + 1), places)
    velocity = np.gradient(x)
    found = np.zeros((len(x), 3))
    for i, at in enumerate(x):
        unit.light, unit.true, unit.moving = level(p, at), at, velocity[i]
        PeakValley.step(p, s, unit)
        found[i] = unit.displacement, unit.direction, unit.wrong_way
    return found


def test_a_stroke_is_right_to_the_error_of_linear_interpolation():
    # over whole segments the error has the rms (L/2) sqrt(1/12 + 1/8 - 2/pi^2) = 151 nm and the peak 0.105 L/2
    x = np.linspace(0, 30, 20_001)
    error = recover(x, 0.0)[:, 0] - x
    assert np.sqrt(np.mean(error[2000:] ** 2)) == pytest.approx(0.1509, rel=0.03)
    assert np.abs(error[2000:]).max() < 0.215


def test_turns_between_extremes_are_seen_and_turns_on_them_are_not():
    x = 4.0 * np.sin(np.linspace(0, 8 * np.pi, 8001))
    right = recover(x, 1.0)  # extremes at odd places, turns at 4 um: half way between two
    assert np.abs(right[:, 0] - x).max() < 0.25
    assert right[200:, 2].mean() < 0.1  # wrong way only until the turn exceeds the hysteresis
    wrong = recover(x, 0.0)  # both turns exactly on an extreme
    assert np.abs(wrong[:, 0] - x).max() > 8.0
    assert wrong[200:, 2].mean() > 0.3


def test_loses_the_direction_in_more_than_a_quarter_of_the_places_of_a_grating():
    x = 4.0 * np.sin(np.linspace(0, 8 * np.pi, 4001))
    gone = [np.mean(np.abs(recover(x, offset)[:, 0] - x) > 2.0) > 0.02 for offset in np.arange(0, 4, 0.2)]
    assert 0.25 < np.mean(gone) < 0.9


@pytest.mark.parametrize("light", ["through_wafer", "doppler"])
def test_loses_the_direction_whatever_the_noise(light):
    quiet = {"sensors.through_wafer.snr_db": 60.0, "sensors.doppler.noise_um_ms": 0.0, "sensor.light": light}
    error = errors({**COUNTER, **quiet}, range(1, 16))
    assert lost(error).mean() > 0.25


def test_an_interpolated_count_tells_filters_its_error():
    assert make(COUNTER).spec.context().sensor_noise_um == pytest.approx(2.0 * math.sqrt(1 / 12 + 1 / 8 - 2 / np.pi**2))
