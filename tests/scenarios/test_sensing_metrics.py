from __future__ import annotations

import numpy as np
import pytest

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)
from scenarios.library import get
from scenarios.run import run
from scenarios.sensing_metrics import lost_samples


def test_the_fringe_the_count_began_on_is_left_open():
    error = np.full(1000, 8.0)
    error[:30] += 4.0
    bad, whole = lost_samples(error, 4.0)
    assert whole == 2 and bad.mean() == pytest.approx(0.03)


def test_what_is_not_a_number_is_bad_and_nothing_is_lost_without_error():
    assert lost_samples(np.zeros(10), 4.0)[0].sum() == 0
    assert lost_samples(np.array([0.0, np.nan, np.inf, 0.1]), 4.0)[0].tolist() == [False, True, True, False]
    assert lost_samples(np.full(3, np.nan), 4.0)[0].all()


def test_of_equally_good_alignments_the_smallest_is_taken():
    assert lost_samples(np.array([0.0, 0.0, 4.0, 4.0]), 4.0)[1] == 0


@pytest.mark.parametrize("name", ["ch2-capacitive", "ch2-through-wafer", "ch2-doppler", "ch2-dual-beam"])
def test_library_of_chapter_two(name):
    summary = run(get(name)).summary()
    assert summary["ok"], summary["expectations"]
    assert all(entry["note"] for entry in summary["expectations"])
