"""Detection at equal false alarms, Monte Carlo and operations: the studies against their definitions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.board.flops import budget, count
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run
from scenarios.studies import detectors

# -- detectors


def test_threshold_is_where_so_many_episodes_begin():
    rng = np.random.default_rng(1)
    records = [rng.normal(size=20_000) for _ in range(30)]
    threshold = detectors.threshold_at(records, 1e-3)
    above = [record > threshold for record in records]
    episodes = sum(int(np.sum(one[1:] & ~one[:-1])) for one in above)
    assert episodes == pytest.approx(600, abs=1)
    # of white normal noise by its tail
    assert threshold == pytest.approx(3.09, abs=0.05)


def test_area_is_the_chance_of_standing_higher():
    """Of two normals one deviation apart it is Phi(1/sqrt 2)."""
    rng = np.random.default_rng(2)
    calm = [rng.normal(size=8000)]
    faulty = [rng.normal(1.0, size=1) for _ in range(6000)]
    found = detectors._characteristic("x", calm, faulty, 1)
    assert found["x.area"] == pytest.approx(0.5 * (1 + math.erf(0.5)), abs=0.01)
    assert found["x.at_10_pct"] == pytest.approx(0.5 * math.erfc((1.2816 - 1.0) / math.sqrt(2)), abs=0.03)
    assert found["x.at_tenth_pct"] < found["x.at_1_pct"] < found["x.at_10_pct"]


def test_a_fault_that_is_none_is_detected_by_chance():
    values = {"events.0.severity": 1e-9, "study.runs": 25, "study.healthy_samples": 20_000}
    found = run(with_values(get("ch5-detectors"), values)).metrics
    for signal in ("glr25.tone.healthy", "consistency.power.healthy"):
        assert found[f"roc.{signal}.area"] == pytest.approx(0.5, abs=0.15)


@pytest.mark.long
def test_who_detects_what_at_one_false_alarm_in_100_000():
    """CUSUM is quickest for the fault it was built for and blind to another; a long window sees any."""

    def found(fault: str, severity: float) -> dict[str, float]:
        event = {"at_sample": 1000, "fault": fault, "severity": severity}
        values = {"events": [event], "study.runs": 15, "study.healthy_samples": 150_000, "expect": []}
        return run(with_values(get("ch5-detectors"), values)).metrics

    own, other = found("added_mass", 0.05), found("damping", 0.10)
    delay = "detectors.{}.delay"
    assert own[delay.format("cusum.sum.m+5")] <= min(own[delay.format(f"glr{w}.tone.healthy")] for w in (25, 50, 100))
    assert own[delay.format("cusum.sum.m+5")] == pytest.approx(39, rel=0.3)
    assert own[delay.format("glr50.tone.healthy")] == pytest.approx(45, rel=0.3)
    assert own[delay.format("consistency.power.healthy")] > own[delay.format("glr50.tone.healthy")]
    assert other["detectors.cusum.sum.m+5.missed"] >= 0.8
    assert other["detectors.glr100.tone.healthy.missed"] <= 0.05
    assert other[delay.format("glr100.tone.healthy")] < other[delay.format("glr25.tone.healthy")]


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"study.signals": []}, "study.signals"),
        ({"study.signals": ["nobody.tone"]}, "study.signals.0"),
        ({"study.runs": 0}, "study.runs"),
        ({"study.false_alarms_per_sample": 0.0}, "study.false_alarms_per_sample"),
    ],
)
def test_a_study_of_nothing_is_refused(values, field):
    with pytest.raises(InputError) as error:
        run(with_values(get("ch5-detectors"), values))
    assert error.value.field == field


# -- operations


def counted(kind: str, models: int, tick: int = 600, **more: Any) -> tuple[float, float]:
    hypotheses = [{"name": f"h{i}", "mass": 1 + 0.02 * i} for i in range(models)]
    bank = {"kind": kind, "hypotheses": hypotheses, **more}
    board = build(with_values(get("ch5-seven-step"), {"events": [], "expect": [], "diagnosers": {"x": bank}}))
    while board.tick < tick:
        board.advance(tick - board.tick)
    return count(board, "x")


def operations(kind: str, models: int, **more: Any) -> float:
    return counted(kind, models, **more)[0]


def test_a_difference_equation_is_counted_to_the_operation():
    two, three = operations("arx_bank", 2), operations("arx_bank", 3)
    predicted, weighed, logarithm = 4 + 3 + 1, 2, 3
    # its distance to the best, its part in two sums, two quotients, a shift
    shared = 6
    assert three - two == predicted + weighed + logarithm + shared
    assert two - 2 * (three - two) > 0


@pytest.mark.parametrize(
    ("kind", "more", "most"),
    [
        ("mmae", {"form": "steady"}, 40),
        ("mmae", {}, 110),
        ("free_banks", {}, 180),
        ("imm", {}, 200),
        ("anchored", {}, 110),
    ],
)
def test_operations_grow_with_the_models_and_stay_far_below_the_printed(kind, more, most):
    """The text counts 4337 an iteration with one, two and three models alike, and calls that per model."""
    found = [operations(kind, models, **more) for models in (2, 4, 8)]
    assert found[2] - found[1] == pytest.approx(2 * (found[1] - found[0]), rel=0.01)
    per_model = (found[2] - found[0]) / 6
    assert 10 <= per_model <= most and per_model < 4335 / 20


def test_the_totals_of_the_printed_table_do_not_depend_on_its_models():
    """Table 5.5.1: the difference of two totals over the iterations between them, by hand."""
    found = run(get("ch5-flops")).metrics
    by_hand = {1: (11141412 - 2471485) / 1999, 2: (15478414 - 11145755) / 999, 3: (19815418 - 15482749) / 999}
    assert {n: found[f"flops.table.iteration_{n}"] for n in (1, 2, 3)} == by_hand
    assert max(by_hand.values()) / min(by_hand.values()) < 1.0001
    assert 2471485 + 4313 == 2475798 and 11145755 - 11141412 == 4343, "increments are of iterations, of a model's too"


@pytest.mark.parametrize("every", [2, 5])
def test_a_bank_that_runs_now_and_then_is_counted_from_one_turn_to_the_next(every):
    """Between two turns x <- A x + B u of every model: three products and two sums for each of two states."""
    own = {"form": "steady", "probability_floor": 0.0}
    turn = operations("mmae", 3, **own)
    mean_voltage = every + 1  # a sum of N, over N
    for tick in range(600, 600 + every):
        found = operations("mmae", 3, tick=tick, every=every, **own)
        assert found == turn + mean_voltage + (every - 1) * 3 * 2 * (3 + 2)


def test_an_exponential_counts_however_little_it_leaves():
    """Of n probabilities n exponentials and the logarithm of their sum, also where one is below e^-230."""
    for floor in (1e-3, 0.0):
        assert counted("mmae", 6, form="steady", probability_floor=floor)[1] == 6 + 1
        assert counted("arx_bank", 6, probability_floor=floor)[1] == 6 + 1


# -- Monte Carlo


def test_means_of_a_study_are_those_of_the_runs():
    values = {"study": {"kind": "monte_carlo", "runs": 4, "samples": 9000}, "seed": 11, "expect": []}
    found = run(with_values(get("ch5-seven-step"), values)).metrics
    runs = [run(get("ch5-seven-step"), seed).metrics for seed in range(11, 15)]
    for name in ("correct_fraction", "false_switches", "mean_delay_samples", "delay_samples.4", "missed_steps"):
        key = f"diagnosis.kalman.{name}"
        assert found[key] == pytest.approx(np.mean([one[key] for one in runs])), name
    shares = [found[key] for key in found if key.startswith("diagnosis.kalman.confusion.m+5.")]
    assert len(shares) == 6 and sum(shares) == pytest.approx(1.0)


def test_a_diagnoser_that_costs_nothing_fits_any_board(monkeypatch):
    board = build(get("ch5-seven-step"))
    monkeypatch.setattr("core.board.flops.count", lambda board, name: (0.0, 0.0))
    found = budget(board, 1.0)
    assert found.share == 0.0
    assert found.loads[0].models_that_fit == 6 and not found.loads[0].overrun


def test_counting_does_not_take_longer_for_a_bank_that_seldom_runs():
    """A turn, and the work of each other tick: two states of three products and two sums for each model."""
    few, many = (
        count(build(with_values(get("ch5-seven-step"), {"diagnosers.kalman.every": n})), "kalman") for n in (2, 10_000)
    )
    assert many[0] - few[0] == pytest.approx(9_998 * (6 * 10 + 1), abs=20)
