"""Columns longer than a block, in memory or in a file, against numpy over all of their samples."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from scenarios.measure.blocks import (
    BLOCK,
    blocks,
    first_where,
    is_zero,
    largest,
    last_where,
    mean,
    stretches,
    total,
    width,
)
from scenarios.measure.errors import errors, first_peaks, last_step, rms, swing, tracked
from scenarios.measure.metrics import fundamental
from scenarios.measure.rate import bandwidth_hz

LONG = 2 * BLOCK + 4321


@pytest.fixture(params=["memory", "file"])
def column(request, tmp_path: Path):
    """Put numbers into memory or into a file."""

    def put(values: np.ndarray) -> np.ndarray:
        if request.param == "memory":
            return values
        path = tmp_path / f"{len(list(tmp_path.iterdir()))}"
        values.astype(float).tofile(path)
        return np.memmap(path, float, "r")

    return put


def test_sums_and_extremes(column):
    x, y = np.random.default_rng(1).normal(size=(2, LONG))
    a, b = column(x), column(y)
    by_block = [np.sum(x[start : start + BLOCK] * y[start : start + BLOCK]) for start in range(0, LONG, BLOCK)]
    assert total(np.multiply, a, b) == (by_block[0] + by_block[1]) + by_block[2]
    assert mean(a) == pytest.approx(np.mean(x), rel=1e-12) and mean(a[:BLOCK]) == np.mean(x[:BLOCK])
    assert width(a) == np.ptp(x) and largest(np.subtract, a, b) == np.max(x - y)
    assert np.isnan(largest(np.asarray, column(np.repeat([np.nan, 1.0], BLOCK))))
    assert is_zero(column(np.zeros(LONG))) and not is_zero(a)
    assert rms(a) == pytest.approx(np.sqrt(np.mean(x * x)), rel=1e-12) and swing(a) == np.max(np.abs(x))


@pytest.mark.parametrize("at", [1, 100, BLOCK - 1, BLOCK, BLOCK + 1, LONG - BLOCK, 2 * BLOCK, LONG - 1])
def test_samples_are_counted_over_the_ends_of_blocks(column, at):
    step = column(np.repeat([0.0, 1.0], [at, LONG - at]))
    assert list(stretches(step)) == [0, at] and last_step(step) == at
    assert first_where(np.asarray, step) == at and last_where(np.logical_not, step) == at
    assert last_where(lambda values: values > 1.0, step) == 0 and first_where(lambda values: values > 1.0, step) == LONG
    moved = column(np.zeros(LONG))
    error, peak, settled = errors(column(np.where(np.arange(LONG) < at, 0.5, 0.0)), moved, 0.1)
    assert (peak, settled) == (0.5, at) and error == pytest.approx(0.5 * np.sqrt(at / LONG))


def test_errors_of_a_long_run_and_of_its_tail(column):
    x, model, u = np.random.default_rng(2).normal(size=(3, LONG))
    whole, peak, settled, last, effort = tracked(column(x), column(model), column(u), 10, BLOCK - 5, 0.5)
    error, band = x - model, 0.5 * np.max(np.abs(model[BLOCK - 5 :]))
    assert whole == pytest.approx(np.sqrt(np.mean(error[10:] ** 2)), rel=1e-12) and peak == np.max(np.abs(error[10:]))
    assert settled == np.flatnonzero(np.abs(error[10:]) > band)[-1] + 1
    assert last == pytest.approx(np.sqrt(np.mean(error[BLOCK - 5 :] ** 2)), rel=1e-12)
    assert effort == pytest.approx(np.sqrt(np.mean(u[BLOCK - 5 :] ** 2)), rel=1e-12)


@pytest.mark.parametrize("turn", [5, BLOCK - 2, BLOCK - 1, BLOCK, BLOCK + 1])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_the_first_peak_may_be_near_the_end_of_a_block(column, turn, way):
    at = np.arange(LONG, dtype=float)
    model = np.where(at <= turn, at, np.where(at <= turn + 3, 2 * turn - at, at - 6))
    x = np.where(at == turn + 2, 3.0 * turn, model)
    x[turn + 6] = 1e9  # too late to count
    assert first_peaks(column(way * x), column(way * model)) == (turn, 3.0 * turn)


def test_all_blocks_are_seen_once(column):
    numbers = np.arange(float(LONG))
    assert np.array_equal(np.concatenate([block for (block,) in blocks(column(numbers))]), numbers)
    shared = [block[-1] for (block,) in blocks(column(numbers), more=1)]
    assert shared == [BLOCK, 2 * BLOCK, LONG - 1]


def test_a_tone_longer_than_a_block(column):
    t = 5 + np.arange(LONG)
    signal = np.imag((0.3 - 0.7j) * np.exp(2j * np.pi * 0.0123 * t)) + 0.2
    assert fundamental(column(signal), 12.3, 1.0, 5) == pytest.approx(0.3 - 0.7j, rel=1e-9)


@pytest.mark.parametrize("corner", [0.05, 2.0, 4000.0])
def test_bandwidth_of_a_lag_in_a_long_record(column, corner):
    """Of 20 s at 100 kHz every eighth sample is taken, of the fastest lag's samples only the beginning."""
    lag = 1.0 - np.exp(-2e-5 * np.pi * corner * np.arange(2_000_000))
    assert bandwidth_hz(column(lag), 1.0, 0.01) == pytest.approx(corner, rel=0.015, abs=0.3 if corner > 1.0 else 0.02)
