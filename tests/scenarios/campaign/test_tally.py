"""Sums over runs against the definitions: spreads, confusion, delays, the operating characteristic."""

from __future__ import annotations

import re
from dataclasses import replace
from statistics import NormalDist
from xml.etree import ElementTree

import numpy as np
import pytest

from scenarios.campaign.outcome import EVIDENCE, RunOutcome, outcome
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import Spread, receiver_operating_characteristic, tally
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.report.campaign import campaign_report
from scenarios.report.svg import Chart, Series, paint
from scenarios.run import run

SWEEP = {
    "schema": 1,
    "id": "small",
    "title": "Noise <small>",
    "scenario": "ch5-seven-step",
    "set": {"samples": 3500},
    "seeds": {"count": 3},
    "grid": {"sensor.noise_um": [0.05, 0.6]},
}


@pytest.fixture(scope="module")
def campaign() -> tuple[Sweep, dict[str, RunOutcome]]:
    sweep = Sweep(SWEEP)
    from scenarios.schema import Scenario

    return sweep, {key: outcome(Scenario.load(point.document), seed) for key, point, seed in sweep.runs()}


def test_the_curve_of_two_normal_densities_is_the_one_in_closed_form() -> None:
    """Evidence N(-1, 1) and N(1, 1): P_D = Q(Q^-1(P_F) - 2), area Phi(2 / sqrt(2))."""
    rng = np.random.default_rng(4)
    counts = [
        np.bincount(np.digitize(rng.normal(mean, 1.0, 400_000), EVIDENCE), minlength=len(EVIDENCE) + 1)
        for mean in (-1.0, 1.0)
    ]
    roc = receiver_operating_characteristic(*counts)
    normal = NormalDist()
    assert roc.area == pytest.approx(normal.cdf(2.0 / np.sqrt(2.0)), abs=2e-3)
    assert (roc.false_alarm[0], roc.detection[0]) == (0.0, 0.0)
    assert (roc.false_alarm[-1], roc.detection[-1]) == (1.0, 1.0)
    for false_alarm, detection in zip(roc.false_alarm, roc.detection, strict=True):
        if 0.001 < false_alarm < 0.999:
            assert detection == pytest.approx(1.0 - normal.cdf(normal.inv_cdf(1.0 - false_alarm) - 2.0), abs=5e-3)
    # the threshold of a point is the threshold that gives it
    for at in range(1, len(roc.false_alarm)):
        if 0.01 < roc.false_alarm[at] < 0.99:
            assert roc.false_alarm[at] == pytest.approx(1.0 - normal.cdf(roc.log10_odds[at - 1] + 1.0), abs=5e-3)


def test_no_evidence_is_the_diagonal_and_perfect_evidence_the_corner() -> None:
    counts = np.zeros(len(EVIDENCE) + 1, np.int64)
    counts[40:60] = 7
    assert receiver_operating_characteristic(counts, counts).area == pytest.approx(0.5)
    assert receiver_operating_characteristic(counts, np.roll(counts, 50)).area == pytest.approx(1.0)


def test_an_outcome_counts_what_the_trace_shows() -> None:
    scenario = with_values(get("ch5-seven-step"), {"samples": 3500, "sensor.noise_um": 0.4})
    result, found = run(scenario, 5), outcome(scenario, 5)
    assert found.digest == result.digest and found.ticks == 3500
    assert found.metrics == result.metrics
    truth, winner = result.signal("kalman.truth"), result.signal("kalman.winner")
    bank = found.diagnosis["kalman"]
    for i in range(6):
        for j in range(6):
            assert bank.confusion[i][j] == np.sum((truth == i) & (winner == j))
    assert sum(bank.healthy) == np.sum(truth == 0) and sum(bank.faulty) == np.sum(truth != 0)
    healthy = result.signal("kalman.probability.healthy")[truth == 0]
    called = sum(bank.healthy[int(np.digitize(0.0, EVIDENCE)) :])  # odds above 1: the fault is likelier
    assert abs(called - np.sum(healthy < 0.5)) <= np.sum(np.abs(healthy - 0.5) < 0.06)


def test_points_have_the_mean_and_deviation_of_their_runs(campaign: tuple[Sweep, dict[str, RunOutcome]]) -> None:
    sweep, outcomes = campaign
    points = tally(sweep, outcomes)
    assert [point.labels for point in points] == [{"sensor.noise_um": 0.05}, {"sensor.noise_um": 0.6}]
    for number, point in enumerate(points):
        mine = list(outcomes.values())[3 * number : 3 * number + 3]
        assert point.runs == 3
        for name, spread in point.metrics.items():
            values = [one.metrics[name] for one in mine]
            assert spread.mean == pytest.approx(np.mean(values), rel=1e-12)
            assert spread.std == pytest.approx(np.std(values, ddof=1), rel=1e-6, abs=1e-12)
            assert (spread.min, spread.max) == (min(values), max(values))
        bank = point.diagnosis["kalman"]
        assert np.sum(bank.confusion) == 3 * 3500
        assert sum(bank.delays.values()) + bank.missed == 3 * 2  # two changes of the truth in each run
    areas = [point.diagnosis["kalman"].roc.area for point in points]  # type: ignore[union-attr]
    assert areas[0] > areas[1] > 0.5  # more noise, a worse detector


def test_the_report_is_one_whole_file_that_loads_nothing(campaign: tuple[Sweep, dict[str, RunOutcome]]) -> None:
    sweep, outcomes = campaign
    text = campaign_report(sweep, tally(sweep, outcomes))
    assert "Noise &lt;small&gt;" in text and "<small>" not in text
    assert not re.search(r"(src|href)=|url\(|@import|<script|<link", text)
    drawings = re.findall(r"<svg .*?</svg>", text)
    assert len(drawings) >= 4
    for drawing in drawings:
        ElementTree.fromstring(drawing)
    assert "6 of 6 runs" in text and "Receiver operating characteristic" in text


def test_the_report_tells_few_errors_from_none(campaign: tuple[Sweep, dict[str, RunOutcome]]) -> None:
    """A share that is almost all keeps its digits, and counts are whole."""
    sweep, outcomes = campaign
    means = {"diagnosis.kalman.correct_fraction": 0.99997, "diagnosis.kalman.false_switches": 53.0}
    metrics = {name: Spread(count=3, mean=mean, std=0.0, min=mean, max=mean) for name, mean in means.items()}
    text = campaign_report(sweep, [replace(point, metrics=metrics) for point in tally(sweep, outcomes)])
    assert text.count("<td>0.99997\u00a0±\u00a00</td>") == text.count("<td>53\u00a0±\u00a00</td>") == 2


def test_partial_results_are_added_up(campaign: tuple[Sweep, dict[str, RunOutcome]]) -> None:
    sweep, outcomes = campaign
    some = dict(list(outcomes.items())[:2])
    assert [point.runs for point in tally(sweep, some)] == [2, 0]
    assert "2 of 6 runs" in campaign_report(sweep, tally(sweep, some))


def test_a_run_that_cannot_be_carried_out_says_why_in_the_report() -> None:
    sweep = Sweep({"schema": 1, "scenario": "ch5-seven-step"})
    key = next(key for key, _, _ in sweep.runs())
    points = tally(sweep, {key: RunOutcome(seed=1, error="severity: too large")})
    assert points[0].errors == ["severity: too large (1 runs)"]
    assert "severity: too large" in campaign_report(sweep, points)


def test_lines_with_gaps_are_drawn_and_so_is_a_single_point() -> None:
    drawing = paint(Chart("a & b", series=[Series("one", [0, 1, 2], [1.0, float("nan"), 3.0])]))
    assert ElementTree.fromstring(drawing).attrib["aria-label"] == "a & b"
    assert "nan" not in drawing
    assert paint(Chart("flat", series=[Series("one", [1.0], [2.0])]))
