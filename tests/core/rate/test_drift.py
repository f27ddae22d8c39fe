"""Noise of the rate: Allan variances of each process in closed form, and a function of seed and tick alone."""

from __future__ import annotations

import math

import allantools
import numpy as np
import pytest

from core.noise import key, normal
from tests.rates import Row

N, B, K = 0.6, 36.0, 2160.0
"""deg/rt h, deg/h, deg/h/rt h: 0.01 deg/rt s, 0.01 deg/s, 0.01 deg/s/rt s."""
SI = 0.01
DT_MS = 1.0
SEEDS = range(1, 25)
TICKS = 30_000
COUNTS = (1, 3, 10, 30, 100, 300, 1000)


def noise(seed: int, ticks: int = TICKS, dt_ms: float = DT_MS, **figures: float) -> np.ndarray:
    return Row(("rate", "constant", figures), dt_ms=dt_ms, seed=seed).play(ticks)[:, 0]


def variances(rate: np.ndarray, counts: tuple[int, ...] = COUNTS) -> np.ndarray:
    taus, deviations, _, _ = allantools.oadev(rate, rate=1.0, data_type="freq", taus=[float(m) for m in counts])
    assert len(taus) == len(counts)
    return deviations**2


def mean_and_error(counts: tuple[int, ...] = COUNTS, **figures: float) -> tuple[np.ndarray, np.ndarray]:
    rows = np.array([variances(noise(seed, **figures), counts) for seed in SEEDS])
    return rows.mean(axis=0), rows.std(axis=0, ddof=1) / math.sqrt(len(rows))


def markov_variance(count: int, hold: int, decay: float) -> float:
    """Allan variance of a unit Markov process of one step every ``hold`` samples, its phase unknown.

    Between its steps the covariance is a straight line; the covariance of two means is a sum over all pairs.
    """
    weights = np.repeat([-1.0, 1.0], count) / count
    pairs = np.correlate(weights, weights, "full")[2 * count - 1 :]
    steps, part = np.divmod(np.arange(2 * count), hold)
    covariance = decay**steps * (1.0 - part / hold * (1.0 - decay))
    return float(0.5 * (pairs[0] * covariance[0] + 2.0 * np.sum(pairs[1:] * covariance[1:])))


def test_white_noise_falls_by_the_root_of_time():
    mean, error = mean_and_error(angle_random_walk_deg_rt_h=N)
    assert np.all(np.abs(mean - SI**2 / (np.array(COUNTS) * DT_MS * 1e-3)) < 4.5 * error)


def test_the_rate_walks_by_the_root_of_time():
    mean, error = mean_and_error(rate_random_walk_deg_h_rt_h=K)
    m = np.array(COUNTS)
    # K^2 tau / 3, and exactly for a walk in steps
    expected = SI**2 * DT_MS * 1e-3 * (2 * m**2 + 1) / (6 * m)
    assert np.all(np.abs(mean - expected) < 4.5 * error)
    assert expected[-1] == pytest.approx(SI**2 * m[-1] * DT_MS * 1e-3 / 3, rel=1e-6)


def test_flicker_is_nine_markov_processes_a_decade_apart():
    mean, error = mean_and_error(bias_instability_deg_h=B)
    decay = math.exp(-0.1)  # the fastest is correlated over ten samples of 1 ms
    each = SI**2 * math.log(10.0) / math.pi
    expected = [each * sum(markov_variance(m, 10**i, decay) for i in range(9)) for m in COUNTS]
    assert np.all(np.abs(mean - expected) < 4.5 * error)


def floor(tau: float) -> float:
    """Allan deviation of nine continuous Markov processes over 0.664 B, tau in times of the fastest."""
    x = tau / 10.0 ** np.arange(9)
    unit = 2.0 / x * (1.0 - (3.0 - 4.0 * np.exp(-x) + np.exp(-2.0 * x)) / (2.0 * x))
    return float(np.sqrt(math.log(10.0) / math.pi * np.sum(unit) / (2.0 * math.log(2.0) / math.pi)))


def test_the_floor_is_flat_over_the_span_that_is_declared():
    whole = [floor(tau) for tau in np.logspace(1, 7, 1201)]
    assert 0.955 < min(whole) < max(whole) < 1.01
    inside = [floor(tau) for tau in np.logspace(2, 6, 801)]
    assert 0.985 < min(inside) < max(inside) < 1.015
    # the sampled process equals the continuous process
    decay = math.exp(-0.1)
    sampled = math.log(10.0) / (2 * math.log(2.0)) * sum(markov_variance(1000, 10**i, decay) for i in range(9))
    assert math.sqrt(sampled) == pytest.approx(floor(100.0), rel=2e-3)


@pytest.mark.long
def test_the_floor_of_long_records_is_0_664_b():
    counts = (100, 1000, 10_000)
    rows = np.array([variances(noise(seed, 1_000_000, bias_instability_deg_h=B), counts) for seed in range(1, 21)])
    floors = np.sqrt(rows.mean(axis=0)) / SI
    assert np.all(np.abs(floors / 0.664 - 1.0) < 0.05)


@pytest.mark.parametrize(("dt_ms", "samples"), [(0.01, 100.0), (1.0, 10.0)])
def test_process_i_takes_a_step_every_ten_to_the_i_samples(dt_ms, samples):
    row = Row(("rate", "constant", {"bias_instability_deg_h": B}), dt_ms=dt_ms, seed=5)
    decay, kick = math.exp(-1 / samples), math.sqrt(1 - math.exp(-2 / samples))
    for tick, moving in ((7, 1), (10, 2), (130, 2), (100, 3), (47_000, 4), (300_000_000, 9), (10**9, 9)):
        before = np.array(row.state(0).drift.flicker.processes)
        row.tick = tick
        shown = row.play(1)[0, 0]
        assert shown == pytest.approx(SI * math.sqrt(math.log(10) / math.pi) * before.sum(), rel=1e-12)
        after = before.copy()
        for i in range(moving):
            after[i] = decay * before[i] + kick * normal(key(5, f"rate.flicker.{i}"), tick // 10**i)
        np.testing.assert_allclose(row.state(0).drift.flicker.processes, after, rtol=1e-13)


def test_flicker_begins_as_if_it_had_gone_on_for_ever():
    starts = np.array([Row(("rate", "noise", {}), seed=seed).state(0).drift.flicker.processes for seed in range(400)])
    assert np.all(np.abs(starts.mean(axis=0)) < 4.5 / math.sqrt(400))
    assert np.all(np.abs(starts.var(axis=0) - 1.0) < 4.5 * math.sqrt(2 / 400))


def test_a_function_of_seed_and_tick_alone():
    figures = {"angle_random_walk_deg_rt_h": N, "bias_instability_deg_h": B, "rate_random_walk_deg_h_rt_h": K}
    straight = noise(3, 1000, **figures)
    broken = Row(("rate", "constant", figures), dt_ms=DT_MS, seed=3)
    assert np.array_equal(np.concatenate([broken.play(n) for n in (1, 332, 667)])[:, 0], straight)
    assert not np.any(noise(4, 1000, **figures) == straight)
    sine = Row(("rate", "sine", figures), dt_ms=DT_MS, seed=3).play(1000)
    np.testing.assert_allclose(sine[:, 0] - sine[:, 1], straight, atol=1e-12)
    # each process has a stream of its own, so that the noise is their sum
    alone = [noise(3, 1000, **{name: value}) for name, value in figures.items()]
    np.testing.assert_allclose(sum(alone), straight, atol=1e-14)
    assert abs(np.corrcoef(np.diff(alone[0]), np.diff(alone[2]))[0, 1]) < 4.5 / math.sqrt(1000)


def test_a_rate_that_runs_every_few_ticks_has_the_noise_of_its_own_samples():
    held = Row(("rate", "constant", {"angle_random_walk_deg_rt_h": N}), dt_ms=DT_MS, every=5).play(100_000)[::5, 0]
    assert held.var() == pytest.approx(SI**2 / 5e-3, rel=4.5 * math.sqrt(2 / len(held)))


def test_a_rate_that_runs_every_few_ticks_has_the_flicker_of_its_own_samples():
    flicker = ("rate", "constant", {"bias_instability_deg_h": B})
    every_fifth = Row(flicker, dt_ms=DT_MS, every=5).play(5000)[::5, 0]
    assert np.array_equal(every_fifth, Row(flicker, dt_ms=5 * DT_MS).play(1000)[:, 0])


def test_white_noise_keeps_a_value_for_a_millisecond():
    rate = noise(1, 20_000, dt_ms=0.01, angle_random_walk_deg_rt_h=N).reshape(-1, 100)
    assert np.all(rate == rate[:, :1])
    assert rate[:, 0].var() == pytest.approx(SI**2 / 1e-3, rel=4.5 * math.sqrt(2 / len(rate)))
    assert len(set(rate[:, 0])) == len(rate)
