"""The 1/f noise of a pick-off: its density, its Allan floor, its streams."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import welch

from tests.lab import make, play
from tests.two_axis import GYRO, STILL

DENSITY_PM = 100.0


def noise(axis: str, ticks: int, **more: Any) -> NDArray[np.float64]:
    board = make({**STILL, "sensor.flicker_pm_rthz": DENSITY_PM, **more}, base=GYRO)
    trace = play(board, ticks)
    found: NDArray[np.float64] = 1e6 * (trace[f"sensor.{axis}.displacement"] - trace[f"plant.{axis}"])
    return found


@pytest.mark.parametrize("seed", [1, pytest.param(7, marks=pytest.mark.long)])
def test_the_density_falls_with_the_frequency(seed: int) -> None:
    """S = c^2/f from 10 Hz to a hundredth of the sample rate."""
    hz, density = welch(noise("y", 100_000, seed=seed), fs=1e5, nperseg=20_000)
    used = (hz >= 10.0) & (hz <= 1000.0)
    ratio = density[used] * hz[used] / DENSITY_PM**2
    assert ratio.mean() == pytest.approx(1.0, abs=0.15)
    slope = np.polyfit(np.log(hz[used]), np.log(density[used]), 1)[0]
    assert slope == pytest.approx(-1.0, abs=0.12)


def allan(values: NDArray[np.float64], count: int) -> float:
    means = values[: len(values) // count * count].reshape(-1, count).mean(axis=1)
    return float(np.sqrt(0.5 * np.mean(np.diff(means) ** 2)))


def test_the_allan_deviation_is_flat_at_the_flicker_floor() -> None:
    values = np.concatenate([noise("x", 100_000, seed=seed) for seed in (1, 2)])
    floor = math.sqrt(2.0 * math.log(2.0)) * DENSITY_PM
    counts = (100, 200, 500, 1000)
    found = [allan(values, count) for count in counts]
    assert found == pytest.approx([floor] * 4, rel=0.12)
    assert np.polyfit(np.log(counts), np.log(found), 1)[0] == pytest.approx(0.0, abs=0.06)  # white noise: -1/2


def test_each_axis_has_a_stream_of_its_own_and_none_has_noise_without_a_density() -> None:
    x, y = noise("x", 20_000), noise("y", 20_000)
    assert abs(np.corrcoef(np.diff(x), np.diff(y))[0, 1]) < 0.05
    assert (noise("y", 200, **{"sensor.flicker_pm_rthz": 0.0}) == 0.0).all()


def test_the_noise_begins_as_if_it_had_gone_on_for_ever() -> None:
    """Nine processes of the variance c^2 ln 10 each."""
    first = np.array([noise("x", 1, seed=seed)[0] for seed in range(24)])
    expected = 9.0 * math.log(10.0) * DENSITY_PM**2
    assert np.mean(first**2) == pytest.approx(expected, rel=4.5 * math.sqrt(2.0 / len(first)))
