"""Figures of the benchmark against their definitions, worked out by hand or by other means."""

from __future__ import annotations

import math

import numpy as np
import pytest

from scenarios.benchmark import figures

GENERATOR = np.random.default_rng(7)


def said(classes: int, samples: int) -> np.ndarray:
    return np.ascontiguousarray(GENERATOR.dirichlet(np.ones(classes), samples).T)


def test_scores_are_those_of_brier_and_good() -> None:
    """B = mean of the squared distance from the vertex of the truth (Brier 1950), L = mean of -ln p (Good 1952)."""
    p, truth = said(4, 300), GENERATOR.integers(0, 4, 300)
    log_score, brier = figures.scores(p, truth)
    vertices = np.eye(4)[truth].T
    assert brier == pytest.approx(((p - vertices) ** 2).sum(axis=0).mean(), rel=1e-12)
    assert log_score == pytest.approx(-np.log(p[truth, np.arange(300)]).mean(), rel=1e-12)


def test_knowing_nothing_has_known_scores() -> None:
    """Even odds of n classes: ln n and 1 - 1/n. Sure and right: 0 and 0. Sure and wrong: 6 ln 10 and 2."""
    truth = np.zeros(10, dtype=np.int64)
    assert figures.scores(np.full((5, 10), 0.2), truth) == pytest.approx((math.log(5), 0.8))
    sure = np.zeros((5, 10))
    sure[0] = 1.0
    assert figures.scores(sure, truth) == (0.0, 0.0)
    assert figures.scores(sure, truth + 1) == pytest.approx((6.0 * math.log(10), 2.0))


def test_both_scores_are_proper() -> None:
    """Under truths drawn from q, no answer of a grid has a better mean score than q itself; the DX figure has."""
    q = 0.7
    truth = np.repeat([0, 1], [700, 300]).astype(np.int64)
    scores, praise = {}, {}
    for p in np.round(np.arange(0.5, 1.0, 0.05), 2):
        answer = np.repeat([[p], [1.0 - p]], len(truth), axis=1)
        scores[p] = figures.scores(answer, truth)
        praise[p] = q * p + (1.0 - q) * (1.0 - p)
    assert min(scores, key=lambda p: scores[p][0]) == q
    assert min(scores, key=lambda p: scores[p][1]) == q
    assert max(praise, key=praise.get) == 0.95


def test_classes_are_shares_of_their_hypotheses() -> None:
    """Hypotheses of a class are added; what does not add up to 1 is scaled, and no number counts as 0."""
    probabilities = np.array([[0.2, 2.0, math.nan], [0.3, 1.0, 0.25], [0.5, 1.0, -1.0]])
    found = figures.classed(probabilities, np.array([0, 1, 1]), 2)
    assert found == pytest.approx(np.array([[0.2, 0.5, 0.0], [0.8, 0.5, 1.0]]))
    assert not figures.classed(np.zeros((3, 1)), np.array([0, 1, 1]), 2).any()


def test_evidence_is_minus_the_logarithm_of_healthy() -> None:
    found = figures.surprise(np.array([1.0, math.exp(-2.0), 0.0, math.nan]))
    assert found[:2] == pytest.approx([0.0, 2.0])
    assert np.isfinite(found).all() and found[2] == found[3] > 600.0


def test_alarms_by_hand() -> None:
    """Samples 2 to 9 count, the fault is at 6: one false alarm of one sample in four, three of four faulty ones."""
    evidence = np.array([9, 9, 0, 5, 0, 0, 0, 5, 5, 5], dtype=float)
    found = figures.alarms(evidence, 4.0, 2, 6)
    assert (found.detection, found.false_alarm, found.episodes) == (0.75, 0.25, 1)
    assert (found.delay, found.missed) == (1.0, 0.0)
    assert figures.alarms(evidence, 5.0, 2, 6).delay == 4.0  # missed: all the samples there are
    assert figures.alarms(evidence, 5.0, 2, 6).missed == 1.0


def test_a_standing_alarm_detects_nothing() -> None:
    """An alarm that is on before the fault has no delay, so a permanent alarm is not the quickest."""
    found = figures.alarms(np.ones(10), 0.0, 2, 6)
    assert (found.delay, found.missed, found.false_alarm, found.detection) == (None, None, 1.0, 1.0)


def test_isolation_by_hand() -> None:
    """Of the samples with the alarm on, the share named rightly among faults, and the mean share of the truth."""
    p = np.array([[0.9, 0.5, 0.6, 0.0], [0.1, 0.3, 0.3, 0.4], [0.0, 0.2, 0.1, 0.6]])
    on = np.array([True, True, True, True])
    right, given = figures.isolation(p, on, 1, 1)
    assert right == pytest.approx(2 / 3) and given == pytest.approx((0.3 + 0.3 + 0.4) / 3)
    assert figures.isolation(p, ~on, 1, 1) is None
    assert figures.isolation(p[:2], on, 1, 1)[0] is None  # of one kind of fault there is nothing to isolate


def test_reliability_of_a_calibrated_source_is_a_straight_line() -> None:
    """Truths drawn from the stated probabilities: in every bin the share of right ones is the mean probability, within
    4 sigma."""
    samples = 200_000
    p = said(3, samples)
    truth = (GENERATOR.random(samples) > np.cumsum(p, axis=0)).sum(axis=0)
    many, total, right = figures.reliability(p, truth)
    assert many.sum() == samples
    there = many > 0
    expected, share = total[there] / many[there], right[there] / many[there]
    assert (np.abs(share - expected) < 4.0 * np.sqrt(expected * (1.0 - expected) / many[there])).all()


def test_false_switches_are_exits_after_twenty_right_ones() -> None:
    truth = np.repeat([0, 1], [60, 60])
    verdict = truth.copy()
    verdict[[5, 40, 41, 50]] = 1  # before it is found, one exit of two samples, another of one
    verdict[60:70] = 0  # the truth changed: late, and no exit
    verdict[75] = 0  # found by 20 in a row only after this
    assert figures.false_switches(verdict, truth) == 2
    verdict[110] = 0
    assert figures.false_switches(verdict, truth) == 3


def test_estimates_are_means_with_standard_errors() -> None:
    values = [1.0, 2.0, 4.0, None]
    found = figures.estimate(values)
    assert found.cases == 3 and found.mean == pytest.approx(7 / 3)
    assert found.error == pytest.approx(np.std([1.0, 2.0, 4.0], ddof=1) / math.sqrt(3))
    assert figures.estimate([None]) is None


def test_faults_found_in_time_are_counted_of_those_that_can_be() -> None:
    assert figures.found_within([10.0, None, 11.0, 2500.0], (9, 10, 500)) == pytest.approx([0.0, 1 / 3, 2 / 3])
    assert figures.found_within([None], (10,)) == []
