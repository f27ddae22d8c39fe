"""Noise: normal, white, and a function of seed, stream and tick alone."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import special, stats
from scipy.linalg import expm, solve_discrete_lyapunov

from core.noise import key, normal, uniform
from tests.lab import RICH, make, play

N = 100_000


def stream(seed: int, name: str, first: int = 0, n: int = N) -> np.ndarray:
    one = key(seed, name)
    return np.array([normal(one, float(tick)) for tick in range(first, first + n)])


def sensor(seed: int, n: int = 20_000) -> np.ndarray:
    values = {"seed": seed, "sensor.noise_um": 1.0, "reference": {"kind": "constant", "amplitude_v": 0.0}}
    return play(make(values), n)["sensor.displacement"]


@pytest.fixture(scope="module")
def sample() -> np.ndarray:
    return stream(1, "sensor")


def test_normal(sample):
    assert stats.kstest(sample, "norm").pvalue > 1e-3
    assert abs(sample.mean()) < 4 / np.sqrt(N)
    assert abs(sample.var() - 1) < 4 * np.sqrt(2 / N)
    assert abs(stats.skew(sample)) < 4 * np.sqrt(6 / N)
    assert abs(stats.kurtosis(sample)) < 4 * np.sqrt(24 / N)
    # the tails exist
    assert np.sum(np.abs(sample) > 3) == pytest.approx(N * 0.0026998, abs=4 * np.sqrt(N * 0.0027))
    assert np.abs(sample).max() > 3.8


def test_normal_is_the_inverse_distribution_of_uniform():
    one = key(5, "x")
    u = np.array([uniform(one, float(i)) for i in range(20_000)])
    z = np.array([normal(one, float(i)) for i in range(20_000)])
    np.testing.assert_allclose(z, special.ndtri(u), rtol=2e-13, atol=1e-15)


def test_uniform_bits():
    one = key(2, "plant.drive")
    u = np.array([uniform(one, float(i)) for i in range(N)])
    assert u.min() > 0 and u.max() < 1
    assert stats.chisquare(np.histogram(u, 256, (0, 1))[0]).pvalue > 1e-3
    low = np.floor(u * 2**40) % 256  # bits well below the leading ones
    assert stats.chisquare(np.bincount(low.astype(int), minlength=256)).pvalue > 1e-3
    pairs = np.histogram2d(u[:-1:2], u[1::2], 16, [(0, 1), (0, 1)])[0]
    assert stats.chisquare(pairs.ravel()).pvalue > 1e-3


def test_white(sample):
    spectrum = np.fft.rfft(sample - sample.mean())
    acf = np.fft.irfft(np.abs(spectrum) ** 2)[1:200] / (sample.var() * N)
    assert np.abs(acf).max() < 5 / np.sqrt(N)
    # 200 lags of white noise have a chi-square of 200
    assert stats.chi2.sf(N * np.sum(acf**2), len(acf)) > 1e-3
    power = np.abs(spectrum[1:-1]) ** 2 / (N * sample.var())
    assert stats.kstest(power, "expon").pvalue > 1e-3


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ((1, "sensor"), (2, "sensor")),
        ((1, "sensor"), (1, "plant.drive")),
        ((1, "plant.thermal"), (1, "plant.drive")),
        ((0, "sensor"), (2**53, "sensor")),
        ((1, "a"), (1, "b")),
    ],
)
def test_streams_and_seeds_are_independent(first, second):
    a, b = stream(*first, n=20_000), stream(*second, n=20_000)
    for lag in (-3, -2, -1, 0, 1, 2, 3):
        assert abs(np.corrcoef(np.roll(a, lag), b)[0, 1]) < 4.5 / np.sqrt(20_000)
        assert abs(np.corrcoef(np.roll(a, lag) ** 2, b**2)[0, 1]) < 4.5 / np.sqrt(20_000)


@given(seed=st.integers(0, 2**53), tick=st.integers(0, 2**52), name=st.text(max_size=12))
def test_pure_function_of_seed_stream_and_tick(seed, tick, name):
    assert normal(key(seed, name), float(tick)) == normal(key(seed, name), float(tick))
    assert normal(key(seed, name), float(tick)) != normal(key(seed, name), float(tick + 1))
    assert normal(key(seed, name), float(tick)) != normal(key(seed + 1, name), float(tick))
    assert key(seed, name) == float(int(key(seed, name))) < 2**53


def test_no_block_changes_the_noise_of_another():
    plain = sensor(7, 2000)
    again = make(
        {
            "seed": 7,
            "sensor.noise_um": 1.0,
            "reference": {"kind": "constant", "amplitude_v": 0.0},
            "diagnosers": RICH["diagnosers"],
            "controllers.mrac.adaptation_gain": 7.0,
        }
    )
    assert np.array_equal(plain, play(again, 2000)["sensor.displacement"])
    assert stats.kstest(sensor(7), "norm").pvalue > 1e-3


def test_twins_share_their_noise_and_seeds_do_not():
    def noise(seed: int, volts: float) -> np.ndarray:
        values = {"seed": seed, "sensor.noise_um": 0.1, "reference.amplitude_v": volts, "plant.drive_noise_v": 0.0}
        trace = play(make(values), 500)
        return trace["sensor.displacement"] - trace["plant.displacement"]

    np.testing.assert_allclose(noise(4, 1.0), noise(4, 9.0), atol=1e-14)
    assert abs(np.corrcoef(noise(4, 1.0), noise(5, 1.0))[0, 1]) < 0.2


def test_drive_noise_is_white_voltage_on_the_drive():
    values = {
        "plant.drive_noise_v": 0.5,
        "reference": {"kind": "constant", "amplitude_v": 0.0},
        "sample_rate_khz": 50.0,
    }
    x = np.concatenate([play(make({**values, "seed": seed}), 20_000)["plant.displacement"] for seed in range(1, 6)])
    # variance of a sampled oscillator under held white noise: the discrete Lyapunov equation
    a = np.array([[0, 1], [-243.5491, -3.209597]])
    phi = expm(a * 0.02)
    gamma = (np.eye(2) - phi) @ np.array([0.30093, 0.0])
    variance = solve_discrete_lyapunov(phi, np.outer(gamma, gamma) * 0.25)[0, 0]
    assert x.std() == pytest.approx(np.sqrt(variance), rel=0.02)
