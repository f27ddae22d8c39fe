"""Measured results: the same to the bit at any time and on any machine, and worse where more is said than known."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from core import registry
from core.diagnose.mmae import Mmae
from scenarios.benchmark import results
from scenarios.benchmark.answer import CaseProbabilities, answers, section, unscored
from scenarios.benchmark.measure import FALSE_ALARM_SAMPLES, TrackJudge, measure
from scenarios.benchmark.seeds import seed_list
from scenarios.benchmark.track import HEALTHY, WARM, Case, track, tracks
from scenarios.run import run
from tests.scenarios.digests import OLDER

NAMES = tuple(tracks())
DEMONSTRATION = seed_list("demonstration", NAMES)
DEMONSTRATED = "e3b503f951483f36843a7d21b9bbf031eb8a9c0bc4420070498afa81244d51e1"
"""Hash of all outputs on the seeds of the demonstration."""


@pytest.fixture(scope="module")
def table() -> results.BenchmarkResults:
    return measure([*registry.blocks("diagnose")], NAMES, DEMONSTRATION)


def test_every_diagnoser_has_a_row_in_every_track_or_a_reason(table: results.BenchmarkResults) -> None:
    there = {(row.unit, row.track) for row in table.rows}
    out = {(one.unit, one.track) for one in table.left_out}
    assert there | out == {(unit, name) for unit in registry.blocks("diagnose") for name in NAMES}
    assert not there & out
    assert {unit for unit, _ in out} == {"axes_bank"} and all(one.reason for one in table.left_out)


def test_cases_are_those_the_kept_table_was_measured_on(table: results.BenchmarkResults) -> None:
    """Another digest says that devices, noise or diagnosers have changed: then the kept table is measured anew."""
    bits = results.hash_of([row.digest for row in sorted(table.rows, key=lambda row: (row.track, row.unit))])
    assert bits == DEMONSTRATED


def test_a_diagnoser_alone_has_the_rows_it_has_beside_all_others(table: results.BenchmarkResults) -> None:
    alone = measure(["imm"], ["known", "sensor"], DEMONSTRATION)
    assert alone.differences(table) == []
    assert [one.seed for one in alone.rows[0].cases] == [*DEMONSTRATION.cases["known"]]


def test_results_read_back_are_the_same_and_any_change_is_named(table: results.BenchmarkResults) -> None:
    read = results.read(results.write(table), "FILE")
    assert read == table and table.differences(read) == []
    row = read.rows[0]
    row.cases[1].digest = "0" * 64
    row.brier.mean = np.nextafter(row.brier.mean, 1.0)
    assert table.differences(read) == [f"{row.unit}, {row.track}: brier, case {row.cases[1].seed}"]
    read.rows.pop()
    assert table.differences(read)[-1].endswith("is missing")


def test_rates_of_false_alarms_are_those_asked_for(table: results.BenchmarkResults) -> None:
    """By their healthy runs no diagnoser alarms more often than once in so many samples."""
    for row in table.rows:
        assert row.calibration_samples == DEMONSTRATION.calibrations * HEALTHY
        assert row.calibration_alarms <= row.calibration_samples / FALSE_ALARM_SAMPLES


def test_truth_is_what_the_board_knows() -> None:
    """Where the fault is one of the hypotheses, the class that is true is the one the board's own score names."""
    for name in ("known", "closed_loop", "sensor"):
        case = track(name).case(DEMONSTRATION.cases[name][0])
        truth = run(case.scenario({"kalman": section(Mmae, track(name))}, {}), figures_only=True).trace["kalman.truth"]
        assert not truth[: case.onset].any()
        assert (truth[case.onset + 1 :] == case.truth).all()


def test_a_diagnoser_that_knows_the_truth_has_no_loss() -> None:
    """Sure of the true class at every sample and never before: both scores, delay, misses and false alarms are 0."""
    chosen = track("known")
    case = chosen.case(DEMONSTRATION.cases["known"][1])
    p = np.zeros((len(chosen.classes), case.document["samples"]))
    p[0, : case.onset] = p[case.truth, case.onset :] = 1.0
    judge = TrackJudge("oracle", "known", [np.zeros(HEALTHY)])
    judge.take(case, CaseProbabilities(1.0 - p[0], p, ""))
    row = judge.row()
    nothing = (row.log_score, row.brier, row.delay_samples, row.missed, row.false_alarm, row.false_switches)
    assert [figure.mean for figure in nothing] == [0.0] * 6
    assert [figure.mean for figure in (row.detection, row.isolation, row.truth_probability)] == [1.0] * 3
    assert row.found_within == [1.0] * len(results.WITHIN_SAMPLES) and row.healthy_samples == case.onset - WARM


def judged(name: str, sharpen: float) -> results.Row:
    """Return the row of the Kalman bank on a track, its odds to some power."""
    chosen, unit = track(name), {"mmae": section(Mmae, track(name))}

    def answer(case: Case) -> CaseProbabilities:
        found = answers(chosen, case, unit, {})["mmae"]
        p = found.classes**sharpen
        return CaseProbabilities(found.evidence, p / p.sum(axis=0), found.digest)

    healthy = [answer(chosen.healthy(seed)) for seed in DEMONSTRATION.calibration(name)]
    judge = TrackJudge("mmae", name, [one.evidence[WARM:] for one in healthy])
    for seed in seed_list("public", NAMES).cases[name][:20]:
        case = chosen.case(seed)
        judge.take(case, answer(case))
    return judge.row()


@pytest.mark.parametrize("name", ["severity", "drift"])
def test_overconfidence_ranks_below_honesty(name: str) -> None:
    """The same verdicts at the same samples, said with the odds to the fifth power.

    Log score and Brier's score are worse, and the reliability curve is further below the diagonal, while the mean
    probability given to the truth, a former ranking of a competition, is better.
    """
    honest, sure = judged(name, 1.0), judged(name, 5.0)
    sure = sure.model_copy(update={"unit": "sure"})
    found = results.BenchmarkResults.model_construct(rows=[sure, honest])
    assert [row.unit for row in found.ranked(name)] == ["mmae", "sure"]
    assert sure.log_score.mean > honest.log_score.mean and sure.brier.mean > honest.brier.mean
    assert sure.truth_probability.mean > honest.truth_probability.mean
    assert sure.false_switches == honest.false_switches and sure.delay_samples == honest.delay_samples
    assert overconfidence(sure) > overconfidence(honest)


def overconfidence(row: results.Row) -> float:
    """Return the mean probability said less the share that was right."""
    samples = sum(one.samples for one in row.reliability)
    return sum(one.samples * (one.said - one.right) for one in row.reliability) / samples


def test_reasons_say_what_is_lacking() -> None:
    assert (
        unscored(registry.block("diagnose", "axes_bank")) == "is for plants with axes; the devices of this "
        "benchmark move along one"
    )
    assert not unscored(registry.block("diagnose", "regions"))


def test_a_case_in_which_the_board_stops_is_refused() -> None:
    chosen = track("known")
    case = chosen.case(DEMONSTRATION.cases["known"][0])
    case.document["guard"] = {"travel_um": 0.5}
    with pytest.raises(Exception, match="stopped in case"):
        answers(chosen, case, {"mmae": section(Mmae, chosen)}, {})


@pytest.mark.long
@pytest.mark.timeout(600)
@pytest.mark.parametrize("machine", [{}, OLDER], ids=["this machine", "an older one"])
def test_the_kept_table_is_recomputed_to_the_bit(machine: dict[str, str]) -> None:
    command = [sys.executable, "-m", "server.cli.main", "benchmark", "--track", "severity", "--json"]
    env = {**os.environ, **machine}
    again = results.read(subprocess.run(command, capture_output=True, text=True, env=env, check=True).stdout, "--json")
    assert len(again.rows) == len(registry.blocks("diagnose")) - 1
    assert again.differences(results.kept()) == []


def test_the_kept_table_has_every_diagnoser_and_track() -> None:
    kept = results.kept()
    found = {(one.unit, one.track) for one in [*kept.rows, *kept.left_out]}
    assert found == {(unit, name) for unit in registry.blocks("diagnose") for name in NAMES}
    assert kept.seeds == "public" and all(row.scenario for row in kept.rows)
