"""The word of an expectation and of a scenario: derived from the measured and the published figure."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.expectation import VERDICTS, Expectation, overall
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import UNREAD, Scenario
from tests.lab import document

NUMBERS = st.floats(-1e6, 1e6).filter(lambda number: abs(number) > 1e-6)


def expected(**fields: Any) -> Expectation:
    return Expectation(**{"metric": "control.x", "min": -1e9, **fields})


def test_nothing_published_is_ours():
    assert expected().word(3.0) == "ours" == expected().word(None)


@given(value=NUMBERS, share=st.floats(-0.2, 0.2))
def test_a_number_agrees_within_five_per_cent(value, share):
    word = expected(published_value=value).word(value * (1 + share))
    if abs(abs(share) - 0.05) > 1e-9:
        assert word == ("reproduced" if abs(share) < 0.05 else "not reproduced")


@given(ends=st.tuples(NUMBERS, NUMBERS).map(sorted), measured=NUMBERS)
def test_a_range_says_otherwise_ends_included(ends, measured):
    low, high = ends
    entry = expected(published_range=(low, high), fitted=["controller.gain"], published_value=low)
    assert entry.word(measured) == ("reproduced by tuning" if low <= measured <= high else "not reproduced")
    assert entry.word(low) == entry.word(high) == "reproduced by tuning"


@pytest.mark.parametrize(
    ("fields", "pid", "word"),
    [
        ({"max": 0.003, "published_range": [0, 0.06]}, 0.037, "reproduced, by a PID too"),
        ({"max": 0.003, "published_range": [0, 0.06]}, 0.087, "reproduced"),
        ({"max": 0.003, "published_range": [0, 0.001]}, 0.0059, "reproduced, by a PID too"),
        ({"max": 0.003, "published_range": [0, 0.06]}, None, "reproduced"),
        ({"max": 0.003, "published_range": [0, 0.06], "pid_too": True}, None, "reproduced, by a PID too"),
        ({"max": 0.003, "published_range": [0, 0.06], "pid_too": True}, 0.087, "reproduced"),
        ({"max": 0.003, "published_range": [0, 0.06], "compare": "open_loop"}, 0.037, "reproduced"),
        ({"max": 0.003}, 0.001, "ours"),
        ({"max": 1.0, "published_range": [0, 1], "fitted": ["seed"]}, 0.5, "reproduced by tuning, by a PID too"),
    ],
)
def test_a_pid_that_meets_the_claim_is_in_the_word(fields, pid, word):
    entry = Expectation(**{"metric": "control.tail_rms_error_um", "compare": "pid", **fields})
    assert entry.word(0.0005, pid) == word


def test_an_error_below_its_window_is_as_good_and_an_amplitude_is_not():
    window = {"value": 0.223, "tolerance": 0.03, "compare": "pid"}
    assert Expectation(metric="control.tail_rms_error_um", **window).does_as_well(0.107)
    assert not Expectation(metric="control.amplitude_um", **window).does_as_well(0.107)


def test_ranges_may_be_open_and_pass_through_json_and_toml():
    text = 'schema = 1\nid = "x"\n[[expect]]\nmetric = "a"\nmin = 2\npublished_range = [1.5, inf]\n'
    read = Scenario.load(text)
    for again in (Scenario.load(json.loads(json.dumps(read.document, allow_nan=False))), Scenario.load(read.toml())):
        assert again.head.expect[0].published_range == (1.5, math.inf)
        assert again.document == read.document
    assert read.head.expect[0].word(1e300) == "reproduced" and read.head.expect[0].word(1.0) == "not reproduced"


def test_a_figure_that_is_not_there_agrees_with_nothing():
    assert expected(published_value=1.0).word(None) == "not reproduced"


def test_words_without_a_number_have_no_verdict_and_say_so():
    entry = {"metric": "control.x", "min": 0, "published": "very close"}
    scenario = Scenario.load({**document(), "expect": [entry]})
    assert scenario.verdict is None and "control.x: published has no published_value" in scenario.warnings[0]


@pytest.mark.parametrize(
    ("bounds", "promised"),
    [
        ({"value": 1.0, "tolerance": 0.1}, "reproduced"),
        ({"min": None, "max": 0.5}, "not reproduced"),
        ({"min": 2.5}, "not reproduced"),
        ({"min": None, "max": 1.5}, "reproduced"),
    ],
)
def test_before_a_run_the_word_is_that_of_the_expectation_if_it_holds(bounds, promised):
    bounds = {**bounds, "min": bounds.get("min")} if "value" not in bounds else {**bounds, "min": None}
    assert expected(**bounds, published_range=(0.8, 2.0)).promised() == promised


@given(words=st.lists(st.sampled_from([*VERDICTS, None])))
def test_the_word_of_a_scenario(words):
    claimed = {word for word in words if word not in (None, "ours")}
    found = overall(words)
    if not claimed:
        assert found == ("ours" if "ours" in words else None)
    elif len(claimed) == 1:
        assert {found} == claimed
    elif all(word.startswith("reproduced") for word in claimed):
        assert found is not None and found.startswith("reproduced")
        for part in ("by tuning", "by a PID too"):
            assert (part in found) == any(part in word for word in claimed)
    else:
        assert found == "partly"


@pytest.mark.parametrize(
    ("bounds", "inside", "outside"),
    [
        ({"min": None, "value": 2.0, "tolerance": 0.5}, 2.9, 3.0),
        ({"min": None, "value": 2.0, "tolerance": 0.5}, 1.1, 1.0),
        ({"min": None, "max": 0.3}, 0.59, 0.6),
        ({"min": 1.0, "max": 2.0}, 2.4, 2.5),
        ({"min": 10.0}, 5.1, 5.0),
        ({"metric": "diagnosis.a.correct_fraction", "min": 0.9}, 0.81, 0.8),
        ({"min": None, "max": 0}, 0.0, 1.0),
    ],
)
def test_missed_by_twice_the_tolerance(bounds, inside, outside):
    entry = expected(**bounds)
    assert not entry.missed_twice(inside) and entry.missed_twice(outside) and entry.missed_twice(None)


@pytest.mark.parametrize(
    ("fields", "field", "says"),
    [
        ({"published_range": [2.0, 1.0]}, "expect.0", "low <= high"),
        ({"published_range": [math.nan, 1.0]}, "expect.0", "low <= high"),
        ({"published_value": math.inf}, "expect.0.published_value", "finite"),
        ({"published_value": 0}, "expect.0", "needs published_range"),
        ({"published_value": 3.0, "published_range": [1.0, 2.0]}, "expect.0", "outside published_range"),
        ({"fitted": ["seed"]}, "expect.0", "goes with"),
        ({"compare": "none"}, "expect.0", "go together"),
        ({"compare": "open_loop", "pid_too": True}, "expect.0", "pid_too goes with"),
        ({"reason": "because"}, "expect.0", "go together"),
        ({"compare": "mrac"}, "expect.0.compare", "must be one of"),
        ({"published_value": 1, "fitted": ["controller.gian"]}, "expect.0.fitted", "no 'controller.gian'"),
        ({"published_value": 1, "fitted": ["events.7.severity"]}, "expect.0.fitted", "no 'events.7.severity'"),
    ],
)
def test_bad_rows_are_refused_in_one_line(fields, field, says):
    with pytest.raises(InputError) as refused:
        Scenario.load({**document(), "expect": [{"metric": "a", "min": 0, **fields}]})
    assert refused.value.field == field and says in refused.value.message and "\n" not in str(refused.value)


def test_a_fitted_field_is_found_wherever_it_is_kept_and_forgotten_when_it_goes():
    case = get("ch3-case1-aged-mass")
    other = with_values(case, {"controller.kind": "pid", "sensor.noise_um": 0.01})
    assert other.head.expect[0].fitted == case.head.expect[0].fitted
    tuned = get("ch4-lcr-two-tone")  # its gain stays in the table of controllers that do not drive
    assert with_values(tuned, {"controller.kind": "pid"}).head.expect[0].fitted == ["controller.adaptation_gain"]
    changed = with_values(case, {"reference.kind": "constant"})
    assert changed.head.expect[0].fitted == ["events.1.fault"]


def test_a_typed_verdict_is_not_read_and_that_is_said_once():
    typed = {"verdict": "reproduced", "expect": [{"metric": "control.rms_error_um", "min": 9.0, "verdict": "partly"}]}
    summary = run(Scenario.load({**document(), **typed, "samples": 20})).summary()
    assert summary["verdict"] == "ours" == summary["expectations"][0]["verdict"]
    assert summary["warnings"].count(UNREAD) == 1
    study = {**get("ch1-beam-width").document, "verdict": "partly"}
    assert run(Scenario.load(study)).summary()["warnings"] == [UNREAD]
