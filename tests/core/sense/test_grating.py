from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import erf

from core.sense.grating import BeamParams, Grating, level, pack_grating, series
from tests.core.sense.bench import TICKS, make
from tests.lab import play


def smoothed(x: np.ndarray, spot: float, x0: float = 0.0, transmission: float = 0.5) -> np.ndarray:
    """Bars and openings of 2 um convolved with the marginal of a Gaussian beam, opening by opening."""
    sigma = spot / 2.0  # intensity exp(-2 x^2 / w^2)
    opened = np.zeros_like(x)
    for n in range(-40, 41):
        centre = x0 + 4.0 * n
        a, b = centre - 1.0 - x, centre + 1.0 - x
        opened += 0.5 * (erf(b / (sigma * math.sqrt(2))) - erf(a / (sigma * math.sqrt(2))))
    return opened + (1.0 - opened) * transmission


@pytest.mark.parametrize(
    ("spot", "visibility"), [(1.0, 0.312), (1.5, 0.212), (2.0, 0.124), (3.0, 0.026), (4.6, 0.0006)]
)
def test_visibility_falls_with_the_spot(spot, visibility):
    # c1 / DC = (1 - T) (2/pi) exp(-(pi w/L)^2/2) / (D + (1 - D) T), the last one given to one digit only
    params = BeamParams(spot_um=spot)
    assert params.visibility == pytest.approx(visibility, rel=0.02 if visibility > 0.001 else 0.1)
    exact = 0.5 * (2 / math.pi) * math.exp(-((math.pi * spot / 4) ** 2) / 2) / 0.75
    assert params.visibility == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("spot", [0.3, 1.5, 3.0])
def test_series_is_the_convolution_of_bars_and_beam(spot):
    params = BeamParams(spot_um=spot, grating_offset_um=0.7)
    p = pack_grating(Grating, params.mean, 4.0, 0.7, params.harmonics)
    x = np.linspace(-9, 9, 101)
    np.testing.assert_allclose([level(p, at) for at in x], smoothed(x, spot, 0.7), atol=1e-8)


def test_slope_and_curvature_are_the_derivatives_of_the_level():
    params = BeamParams(spot_um=0.8, opening=0.4)
    p = pack_grating(Grating, params.mean, 4.0, 0.3, params.harmonics)
    for x in np.linspace(-5, 5, 23):
        before, now, after = (level(p, x + h) for h in (-1e-4, 0.0, 1e-4))
        value, slope, curvature = series(p, x)
        assert value == now
        assert slope == pytest.approx((after - before) / 2e-4, abs=1e-6)
        assert curvature == pytest.approx((after - 2.0 * now + before) / 1e-8, abs=1e-6)


def test_third_harmonic_is_below_three_percent():
    first, _, third = BeamParams().shape()[:3]
    assert abs(third / first) < 0.03


def test_eight_extremes_and_two_turns_a_cycle_at_four_um():
    params = BeamParams(grating_offset_um=0.5)
    p = pack_grating(Grating, params.mean, 4.0, 0.5, params.harmonics)
    phase = np.linspace(0.1, 0.1 + 2 * math.pi, 200_001)
    x = 4.0 * np.sin(phase)
    light = np.array([level(p, at) for at in x])
    at = x[1:-1][np.diff(np.sign(np.diff(light))) != 0]
    turns = np.abs(np.abs(at) - 4.0) < 1e-6
    assert turns.sum() == 2
    np.testing.assert_allclose(np.sort(at[~turns]), np.repeat([-3.5, -1.5, 0.5, 2.5], 2), atol=2e-4)


def test_extremes_of_the_signal_lie_two_um_apart():
    values = {"sensors.through_wafer.always": True, "sensors.through_wafer.snr_db": 200.0}
    trace = play(make({**values, "sensors.through_wafer.grating_offset_um": 0.9}), TICKS)
    x, light = trace["plant.displacement"][5180:], trace["through_wafer.intensity"][5180:]
    turn = np.abs(trace["plant.velocity"][5180:][1:-1]) < 10.0
    at = x[1:-1][(np.diff(np.sign(np.diff(light))) != 0) & ~turn]
    # between two samples the shuttle moves up to 0.1 um
    np.testing.assert_allclose((at - 0.9) / 2.0, np.round((at - 0.9) / 2.0), atol=0.05)
    assert set(np.round((at - 0.9) / 2.0)) == {-2.0, -1.0, 0.0, 1.0}


def test_noise_has_the_signal_to_noise_ratio_asked_for():
    values = {"sensors.through_wafer.always": True, "sensors.through_wafer.snr_db": 20.0}
    quiet = {**values, "sensors.through_wafer.snr_db": 200.0}
    noise = play(make(values), TICKS)["through_wafer.intensity"] - play(make(quiet), TICKS)["through_wafer.intensity"]
    amplitude = BeamParams().harmonics[0]
    assert 20 * math.log10(amplitude / math.sqrt(2) / np.std(noise)) == pytest.approx(20.0, abs=0.15)


def test_seed_places_the_grating_and_a_given_place_wins():
    places = [BeamParams().offset(seed) for seed in range(1, 201)]
    assert 0.0 <= min(places) and max(places) < 4.0
    assert np.histogram(places, 4, (0, 4))[0].min() > 30
    assert BeamParams(grating_offset_um=1.25).offset(7) == 1.25
