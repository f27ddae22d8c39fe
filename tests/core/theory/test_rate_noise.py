"""N, B and K from an Allan deviation: exact curves give them back, records do within their errors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.readout.allan import Allan
from core.theory.rate_noise import RateNoise, RateNoiseFigure, averaging_times, fit
from tests.rates import Row

TAUS = 0.01 * 2.0 ** np.arange(20)
N, B, K = 0.1, 3.0, 60.0
"""deg/rt h, deg/h, deg/h/rt h."""
NAMES = ("angle_random_walk", "bias_instability", "rate_random_walk")


def variance(n: float = 0.0, b: float = 0.0, k: float = 0.0) -> np.ndarray:
    n, b, k = n / 60.0, b / 3600.0, k / 3600.0 / 60.0
    return n**2 / TAUS + 2 * math.log(2) / math.pi * b**2 + k**2 * TAUS / 3


def pairs(record_s: float) -> np.ndarray:
    """Return how many pairs of means a record has, up to eight for each averaging time."""
    m = 2 ** np.arange(20)
    stride = np.maximum(1, m // 8)
    return np.maximum(0, round(record_s / 0.01) // stride + 1 - 2 * (m // stride))


def figures(noise: RateNoise) -> list[RateNoiseFigure]:
    return [getattr(noise, name) for name in NAMES]


def test_averaging_times_of_a_record():
    found = averaging_times(pairs(655.36))
    np.testing.assert_allclose(found[:14], 65536 / 2.0 ** np.arange(14))


def test_a_curve_of_the_three_noises_gives_them_back():
    noise = fit(TAUS, np.sqrt(variance(N, B, K)), pairs(40_000.0))
    for figure, true in zip(figures(noise), (N, B, K), strict=True):
        assert figure.value == pytest.approx(true, rel=1e-6) and 0 < figure.error < true / 4 and not figure.reason
    assert noise.from_s == 0.01 and 9 * noise.to_s <= 40_000 < 18 * noise.to_s


@pytest.mark.parametrize(("which", "true"), [(0, N), (1, B), (2, K)])
def test_one_noise_alone_is_that_one_and_the_others_are_bounded(which, true):
    alone = [0.0, 0.0, 0.0]
    alone[which] = true
    noise = figures(fit(TAUS, np.sqrt(variance(*alone)), pairs(1000.0)))
    assert noise[which].value == pytest.approx(true, rel=1e-6)
    for other in {0, 1, 2} - {which}:
        assert noise[other].value is None and noise[other].error > 0.0
        needs = "averages shorter than 0.010\u00a0s" if other == 0 else "a record longer than 1000\u00a0s"
        assert noise[other].reason.startswith("is below the noise, at most") and needs in noise[other].reason


def test_a_floor_that_the_record_does_not_reach_is_not_told():
    """White noise meets the floor at 9 s and the walk at about 43 s."""
    short, middle, long = (fit(TAUS, np.sqrt(variance(N, B, 10.0)), pairs(s)) for s in (100.0, 4000.0, 400_000.0))
    assert short.angle_random_walk.value == pytest.approx(N, rel=1e-3)
    assert short.bias_instability.value is None and B < short.bias_instability.error < 4 * B
    assert middle.bias_instability.value == pytest.approx(B, rel=0.05) and middle.rate_random_walk.value is None
    assert long.rate_random_walk.value == pytest.approx(10.0, rel=1e-3)


@pytest.mark.parametrize("record_s", [0.0, 0.3, 0.7])
def test_a_record_of_fewer_than_four_octaves_tells_nothing(record_s):
    noise = fit(TAUS, np.sqrt(variance(N)), pairs(record_s))
    assert all(f.value is None and "a record of 0.720\u00a0s" in f.reason for f in figures(noise))
    assert fit(TAUS, np.sqrt(variance(N)), pairs(0.73)).to_s == 0.08
    assert fit(TAUS, np.sqrt(variance(N)), pairs(1.45)).angle_random_walk.value == pytest.approx(N, rel=1e-6)


def test_a_constant_rate_has_no_noise_to_tell():
    noise = fit(TAUS, np.zeros(20), pairs(1000.0))
    assert all(f.value is None and "a rate that is not constant" in f.reason for f in figures(noise))


def test_octaves_below_the_filter_of_a_loop_are_left_out():
    """White noise through a lag of 50 ms: the Allan variance of a Markov process, which falls as N^2/tau only later."""
    x = TAUS / 0.05
    lagged = variance(n=0.5) * (1.0 - (3.0 - 4.0 * np.exp(-x) + np.exp(-2.0 * x)) / (2.0 * x))
    assert lagged[0] < 0.1 * variance(n=0.5)[0]
    noise = fit(TAUS, np.sqrt(lagged), pairs(2000.0))
    assert 0.1 < noise.from_s < 5.0
    assert noise.angle_random_walk.value == pytest.approx(0.5, rel=0.02)
    assert noise.bias_instability.value is None and noise.rate_random_walk.value is None


def test_what_is_no_noise_is_not_taken_for_noise():
    """A rate that swings once in 3 s: its Allan deviation is sin^2(pi f tau) / (pi f tau)."""
    swing = np.abs(np.sin(np.pi * TAUS / 3.0) ** 2 / (np.pi * TAUS / 3.0))
    noise = fit(TAUS, np.sqrt(variance(N)) + swing, pairs(300.0))
    assert all(
        f.value is None and f.reason == "no sum of the three noises is like this deviation" for f in figures(noise)
    )


# -- from records


def told(seed: int, seconds: int, **values: float) -> RateNoise:
    """Return the conclusion of a read-out from a rate with noise of its own, which is flat from 1 s on at 100 Hz."""
    row = Row(("rate", "noise", values), ("readout", "allan", {"interval_ms": 1000.0}), dt_ms=10.0, seed=seed)
    for _ in range(10):
        row.play(seconds * 10)
    taus = Allan.taus_s(row.params[1], row.context)
    return fit(taus, row.value("deviation", 20), row.value("averages", 20))


@pytest.mark.long
@pytest.mark.parametrize(
    ("n", "b", "k", "known"),
    [(N, 0.0, K, (0, 2)), (N, B, 0.0, (0, 1)), (N, 0.0, 0.0, (0,)), (0.0, B, 0.0, (1,)), (0.0, 0.0, K, (2,))],
)
def test_records_give_the_noise_that_went_in(n, b, k, known):
    """Over 16 seeds: each within its own errors, the mean within its own, and nothing that is not there."""
    values = {"angle_random_walk_deg_rt_h": n, "bias_instability_deg_h": b, "rate_random_walk_deg_h_rt_h": k}
    noises = [figures(told(seed, 10_000, **values)) for seed in range(1, 17)]
    for which, true in enumerate((n, b, k)):
        sure = [noise[which] for noise in noises if noise[which].value is not None]
        if which not in known:
            assert len(sure) <= 1
            continue
        values_of = np.array([figure.value for figure in sure])
        assert len(sure) >= 15
        ripple = 0.045 * true if which == 1 else 0.0  # the generator's floor is that flat
        assert np.mean([abs(figure.value - true) < 2.0 * figure.error + ripple for figure in sure]) >= 0.8
        assert abs(values_of.mean() - true) < 4.5 * values_of.std(ddof=1) / math.sqrt(len(sure)) + ripple
