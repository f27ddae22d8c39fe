"""The running Allan deviation against allantools on the same means."""

from __future__ import annotations

from typing import Any

import allantools
import numpy as np
import pytest

from core.readout.allan import LEVELS, Allan
from tests.rates import OPEN, Row

NOISE = {"angle_random_walk_deg_rt_h": 0.3, "bias_instability_deg_h": 200.0, "rate_random_walk_deg_h_rt_h": 9e3}


def listening(ticks: int, *, compiled: bool = True, dt_ms: float = 1.0, **values: Any) -> tuple[Row, np.ndarray]:
    """Return a read-out that has heard a noisy rate, and the rate."""
    generator = ("rate", "sine", {**NOISE, "deg_per_s": 0.1, "frequency_hz": 0.03})
    row = Row(generator, ("readout", "allan", values), dt_ms=dt_ms, compiled=compiled)
    return row, row.play(ticks)[:, 0]


def fed(rate: np.ndarray, **values: Any) -> Row:
    """Return a read-out that has heard a record."""
    row = Row(("readout", "allan", values))
    for value in rate:
        row.w[row.places[OPEN]] = value
        row.play(1)
    return row


def curve(row: Row) -> tuple[np.ndarray, np.ndarray]:
    return row.value("deviation", LEVELS), row.value("averages", LEVELS)


def expected(means: np.ndarray, interval_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Return deviation and pairs of every octave, by allantools on the phase at every max(1, m/8) intervals."""
    phase = np.concatenate([[0.0], np.cumsum(means)]) * interval_s
    deviations, pairs = np.zeros(LEVELS), np.zeros(LEVELS)
    for level in range(LEVELS):
        m = 2**level
        stride = max(1, m // 8)
        thin = phase[::stride]
        pairs[level] = max(0, len(thin) - 2 * (m // stride))
        if pairs[level] > 1:  # allantools shows no deviation of one pair
            rate = 1.0 / (stride * interval_s)
            _, found, _, counts = allantools.oadev(thin, rate=rate, data_type="phase", taus=[m * interval_s])
            assert counts[0] == pairs[level]
            deviations[level] = found[0]
    return deviations, pairs


@pytest.mark.parametrize(("ticks", "interval_ms"), [(30_000, 1.0), (29_983, 3.0), (4097, 1.0), (31, 2.0)])
def test_every_octave_is_that_of_allantools(ticks, interval_ms):
    row, rate = listening(ticks, interval_ms=interval_ms)
    n = round(interval_ms)
    means = rate[: ticks // n * n].reshape(-1, n).mean(axis=1)
    deviations, averages = curve(row)
    wanted, pairs = expected(means, n * 1e-3)
    assert np.array_equal(averages, pairs)
    told = pairs > 1
    np.testing.assert_allclose(deviations[told], wanted[told], rtol=1e-10)
    assert np.array_equal(deviations > 0, pairs > 0)
    assert np.count_nonzero(told) >= 3


def test_a_long_interval_is_the_tail_of_a_short_one():
    """Means of eight intervals are the intervals of a read-out that is eight times as slow."""
    fine, _ = listening(40_000, interval_ms=1.0)
    coarse, _ = listening(40_000, interval_ms=8.0)
    fine_curve, coarse_curve = curve(fine), curve(coarse)
    np.testing.assert_allclose(fine_curve[0][6:], coarse_curve[0][3:-3], rtol=1e-12)
    assert np.array_equal(fine_curve[1][6:], coarse_curve[1][3:-3])


def test_a_large_rate_does_not_hide_its_noise():
    rng = np.random.default_rng(1)
    rate = rng.normal(size=4000)
    small, large = (curve(fed(rate * 1e-6 + offset))[0] for offset in (0.0, 400.0))
    np.testing.assert_allclose(small, large, rtol=1e-5)


def test_the_start_is_left_out():
    row, rate = listening(5000, interval_ms=2.0, skip_ms=501.0)
    late = fed(rate[501:], interval_ms=2.0)
    assert np.array_equal(curve(row)[0], curve(late)[0]) and curve(row)[1][0] == 2248


def test_no_average_spans_a_gap():
    rng = np.random.default_rng(2)
    parts = [rng.normal(size=n) for n in (900, 700)]
    parted = np.concatenate([parts[0], [np.nan], parts[1]])
    row = fed(parted)
    (first, first_pairs), (second, second_pairs) = (expected(part, 1e-3) for part in parts)
    pairs = first_pairs + second_pairs
    told = (first_pairs > 1) & (second_pairs > 1)
    wanted = np.sqrt((first_pairs * first**2 + second_pairs * second**2)[told] / pairs[told])
    assert np.array_equal(curve(row)[1], pairs)
    np.testing.assert_allclose(curve(row)[0][told], wanted, rtol=1e-10)
    assert np.all(np.isfinite(row.s[0]))


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_rate_that_is_no_number_is_passed_over(bad):
    row = fed(np.full(300, bad))
    assert not np.any(curve(row)[1]) and not np.any(curve(row)[0]) and np.all(np.isfinite(row.s[0]))


def test_a_record_of_any_length_takes_the_same_memory():
    row = Row(("readout", "allan", {}))
    size = len(row.s[0])
    assert size == Allan.State.layout.size < 400
    row.play(2_000_000)
    assert len(row.s[0]) == size and curve(row)[1][17] == 2_000_000 // 2**14 - 15
    assert not np.any(curve(row)[0])


def test_averaging_times_are_whole_samples():
    row = Row(("readout", "allan", {"interval_ms": 0.25}), dt_ms=0.1)
    taus = Allan.taus_s(row.params[0], row.context)
    assert taus[0] == pytest.approx(2e-4) and taus[10] == pytest.approx(2e-4 * 1024) and len(taus) == LEVELS


def test_compiled_has_the_bits_of_plain_python():
    (fast, _), (slow, _) = (
        listening(5000, compiled=compiled, dt_ms=0.01, interval_ms=0.03, skip_ms=0.2) for compiled in (True, False)
    )
    assert np.array_equal(fast.w, slow.w) and np.count_nonzero(curve(fast)[0]) > 8
    assert np.array_equal(fast.s[1], slow.s[1])


def test_the_card_says_which_pairs_are_left_out():
    """All overlapping pairs are allantools' own; the read-out takes one in m/8, and says by how much that differs."""
    row, rate = listening(2048)
    deviations, averages = curve(row)
    for level in range(4, 9):
        m = 2**level
        _, found, _, counts = allantools.oadev(rate, rate=1e3, data_type="freq", taus=[m * 1e-3])
        assert averages[level] == pytest.approx(counts[0] / (m / 8), abs=1.0)
        assert abs(deviations[level] / found[0] - 1.0) < 0.05
    assert "overlapping" not in Allan.title.lower()
    assert any("differs from that of all overlapping pairs" in text for text in Allan.weaknesses)
