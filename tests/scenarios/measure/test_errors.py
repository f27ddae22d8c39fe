"""Errors in one pass, and evidence counted by its odds, against numpy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from scenarios.campaign.outcome import EVIDENCE, LEAST, ODDS, evidence
from scenarios.measure.errors import errors, first_peaks, last_step, rms, swing, tracked
from scenarios.measure.metrics import first_peak, fundamental

SIGNALS = st.integers(0, 2**32 - 1).map(lambda seed: np.random.default_rng(seed))


@given(SIGNALS, st.floats(0.0, 2.0))
def test_errors_are_those_of_numpy(rng, band):
    x, model = rng.normal(size=(2, 57))
    found, peak, settled = errors(x, model, band)
    error = x - model
    assert found == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-13)
    assert peak == np.max(np.abs(error)) and rms(x) == pytest.approx(np.sqrt(np.mean(x**2)), rel=1e-13)
    outside = np.flatnonzero(np.abs(error) > band)
    assert settled == (outside[-1] + 1 if len(outside) else 0)
    assert swing(x) == np.max(np.abs(x))


@given(SIGNALS, st.floats(0.0, 0.5), st.integers(0, 56), st.integers(0, 56))
def test_one_pass_has_the_bits_of_each_figure_alone(rng, share, start, tail):
    x, model, u = rng.normal(size=(3, 57))
    band = share * swing(model[tail:])
    alone = *errors(x[start:], model[start:], band), errors(x[tail:], model[tail:], band)[0], rms(u[tail:])
    assert tracked(x, model, u, start, tail, share) == alone


def test_what_is_not_a_number_is_no_small_error():
    x = np.array([0.0, np.nan, 1.0])
    assert np.isnan(errors(x, np.zeros(3), 0.1)[0])
    assert np.isnan(swing(np.array([1.0, np.nan])))


@given(SIGNALS)
def test_the_last_step_and_the_first_peak(rng):
    r = rng.integers(0, 2, size=9).astype(float)
    steps = np.flatnonzero(np.diff(r))
    assert last_step(r) == (steps[-1] + 1 if len(steps) else 0)
    model, x = np.cumsum(rng.integers(-2, 3, size=30)).astype(float), rng.normal(size=30)
    slope = np.sign(np.diff(model))
    moving = np.flatnonzero(slope)
    expected = None
    if len(moving):
        way = slope[moving[0]]
        back = moving[slope[moving] == -way]
        again = moving[(slope[moving] == way) & (moving > back[0])] if len(back) else back
        if len(again) and model[back[0]] * way > 0.0:
            expected = 100.0 * (np.max(x[: again[0] + 1] * way) / (model[back[0]] * way) - 1.0)
    assert first_peak(x, model) == (None if expected is None else pytest.approx(expected, rel=1e-12))
    assert first_peaks(x, np.zeros(30)) == (0.0, 0.0)


@given(SIGNALS, st.floats(0.1, 0.4), st.integers(0, 1000))
def test_the_phasor_of_a_tone_with_an_offset(rng, cycles, first):
    t = first + np.arange(200)
    phasor = complex(*rng.normal(size=2))
    signal = np.imag(phasor * np.exp(2j * np.pi * cycles * t)) + rng.normal()
    assert fundamental(signal, cycles * 1e3, 1.0, first) == pytest.approx(phasor, rel=1e-9)


@given(SIGNALS, st.integers(0, 2))
def test_evidence_is_counted_by_its_odds(rng, healthy):
    probability = rng.dirichlet([0.05] * 3, size=400).T
    probability[:, rng.integers(0, 400, 5)] = np.nan
    probability[healthy, :3] = 0.0
    truth = rng.integers(0, 3, size=400).astype(float)
    fault = np.delete(probability, healthy, axis=0).sum(axis=0)
    odds = np.log10(np.maximum(fault, LEAST)) - np.log10(np.maximum(probability[healthy], LEAST))
    bins = np.digitize(np.where(np.isnan(odds), 0.0, odds), EVIDENCE)
    fault = sum(probability[k] for k in range(len(probability)) if k != healthy)
    found = evidence(fault, np.ascontiguousarray(probability[healthy]), truth, healthy, ODDS)
    for row, chosen in enumerate((truth == healthy, truth != healthy)):
        assert found[row].tolist() == np.bincount(bins[chosen], minlength=len(EVIDENCE) + 1).tolist()
