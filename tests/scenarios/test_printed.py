"""Printed marks: their allowed content, their place, and the quotations of the library."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Any

import pytest

from core.errors import InputError
from scenarios.claims import check_marks, claims, marks
from scenarios.edit import with_values
from scenarios.key import content_hash
from scenarios.library import get, library
from scenarios.run import build, run
from scenarios.schema import Scenario
from tests.lab import QUIET

BAND = {
    "figure": "9.1",
    "section": "9",
    "words": "between 2 and 3 micron",
    "number": "2 and 3",
    "signal": "plant.displacement",
    "unit": "um",
    "low": 2.0,
    "high": 3.0,
}
NUMBER_WORDS = r"\d|zero|one|two|half|third"


def scenario(*printed: dict[str, Any], **rest: Any) -> Scenario:
    events = [
        {"at_sample": 30, "fault": "added_mass", "severity": 0.1},
        {"when": "plant.displacement > 1", "fault": "damping", "severity": 0.1},
    ]
    return Scenario.load({**QUIET, "samples": 100, "events": events, "printed": list(printed), **rest})


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"low": None}, "printed.0", "low and high go together"),
        ({"values": [2.0]}, "printed.0", "needs one of"),
        ({"low": None, "high": None}, "printed.0", "needs one of"),
        ({"low": 3.0}, "printed.0", "low < high"),
        ({"number": "4"}, "printed.0", "not in the words"),
        ({"low": 1.5}, "printed.0", "1.5 is drawn and not in the words"),
        ({"after_ms": 3.0, "until_ms": 2.0}, "printed.0", "after_ms < until_ms"),
        ({"colour": "red"}, "printed.0.colour", ""),
    ],
)
def test_a_slip_is_one_line_that_names_the_field(change: dict[str, Any], field: str, words: str) -> None:
    given = {name: value for name, value in {**BAND, **change}.items() if value is not None}
    with pytest.raises(InputError) as refused:
        scenario(given)
    assert refused.value.field.startswith(field)
    assert words in refused.value.message


def test_times_count_from_the_event() -> None:
    spans = [
        {**BAND},
        {**BAND, "event": 0, "after_ms": 0.1, "until_ms": 0.4},
        {**{k: v for k, v in BAND.items() if k not in ("low", "high")}, "at_sample": 3, "event": 0},
        {**{k: v for k, v in BAND.items() if k not in ("low", "high")}, "at_ms": 0.2, "reading": "ours"},
    ]
    one = scenario(*spans)
    found = [(mark.kind, mark.from_tick, mark.until_tick) for mark in marks(one, build(one).signals)]
    # 100 kHz: 0.01 ms a tick, and the event is at tick 30
    assert found == [("band", 0, None), ("band", 40, 70), ("moment", 33, 33), ("moment", 20, 20)]


@pytest.mark.parametrize(
    ("change", "field", "words"),
    [
        ({"signal": "plant.nothing"}, "signal", "this bench has no signal plant.nothing"),
        ({"unit": "V"}, "unit", "plant.displacement is in um, the mark in V"),
        ({"metric": "control.rms_error_um"}, "metric", "this scenario expects nothing of control.rms_error_um"),
        ({"event": 2}, "event", "there are 2 events, counted from 0"),
        ({"event": 1}, "event", "this event waits for a condition; take one at a moment"),
    ],
)
def test_what_cannot_be_drawn_says_why(change: dict[str, Any], field: str, words: str) -> None:
    one = scenario({**BAND, **change})
    signals = build(one).signals
    assert marks(one, signals)[0].problem == ("" if field == "metric" else words)
    with pytest.raises(InputError) as refused:
        check_marks(one, signals)
    assert (refused.value.field, refused.value.message) == (f"printed.0.{field}", words)


def test_no_run_depends_on_what_is_printed() -> None:
    bare = {key: value for key, value in scenario().document.items() if key != "printed"}
    assert content_hash(scenario(BAND).document) == content_hash(bare)
    assert run(scenario(BAND)).digest == run(Scenario.load(bare)).digest


def test_other_events_have_no_printed_marks() -> None:
    changed = with_values(scenario({**BAND, "event": 0}), {"events": []})
    assert changed.head.printed == []
    assert len(with_values(scenario({**BAND, "event": 0}), {"events.0.severity": 0.2}).head.printed) == 1


def test_a_claim_is_ticked_only_at_the_end_and_by_what_is_printed() -> None:
    row = {"metric": "control.peak_error_um", "max": 1.0, "published": "at most 2", "published_range": [0.0, 2.0]}
    one = scenario({**BAND, "metric": "control.peak_error_um"}, expect=[row])
    signals = build(one).signals
    for measured, is_over, state, expected, word in (
        (1.5, False, "not yet", False, None),
        (1.5, True, "holds", False, "reproduced"),
        (2.5, True, "fails", False, "not reproduced"),
        (0.5, True, "holds", True, "reproduced"),
        (None, True, "fails", None, "not reproduced"),
    ):
        metrics = {} if measured is None else {"control.peak_error_um": measured}
        (claim,) = claims(one, metrics, signals, is_over)
        assert (claim.state, claim.as_expected, claim.verdict) == (state, expected, word)
        assert [mark.words for mark in claim.marks] == [BAND["words"]]


def test_each_mark_of_the_library_is_on_its_bench_and_quotes_a_number() -> None:
    marked = [one for one in library() if one.head.printed]
    assert marked
    for one in marked:
        check_marks(one, build(one).signals)
        for entry in one.head.printed:
            assert re.search(NUMBER_WORDS, entry.number), (one.id, entry.number)
            assert re.fullmatch(r"(\d+(\.\d+)+)?", entry.figure), one.id
            assert re.fullmatch(r"\d+(\.\d+)+", entry.section), one.id
            first, last = entry.ticks(0, one.spec.dt_ms)
            assert first < (one.samples or 0) and (last is None or last <= (one.samples or 0)), one.id


def test_efforts_are_the_printed_share_of_the_reference() -> None:
    for name, percent in (
        ("ch3-case1-aged-mass", 80.0),
        ("ch3-case2-broken-truss", 20.0),
        ("ch3-one-side-stiffer", 20.0),
        ("ch3-case3-adhesion", 46.0),
    ):
        one = get(name)
        (entry,) = one.head.printed
        amplitude = one.document["reference"]["amplitude_v"]
        assert f"{percent:g}%" in entry.words
        assert sorted(entry.values) == pytest.approx(
            [-amplitude * (1 + percent / 100), amplitude * (1 + percent / 100)]
        )


def test_first_peaks_are_the_printed_share_of_the_peak_of_the_model() -> None:
    for name, percent in (("ch4-tracking", 10.0), ("ch4-tracking-mrac", 50.0)):
        (entry,) = get(name).head.printed
        model = run(get(name)).signal("model.displacement")
        turns = [i for i in range(1, len(model) - 1) if model[i - 1] < model[i] >= model[i + 1]]
        assert entry.values == pytest.approx([model[turns[0]] * (1 + percent / 100)], rel=1e-3)


def test_four_weeks_leave_the_printed_share_of_the_stroke() -> None:
    (entry,) = get("ch3-ageing-four-weeks").head.printed
    whole = with_values(get("ch3-ageing-four-weeks"), {"events": []})
    stroke = max(abs(run(whole).signal("plant.displacement")[-3000:]))
    assert max(entry.values) == pytest.approx(stroke * (1 - 0.428), rel=2e-3)


def test_the_seven_steps_are_drawn_over_the_samples_of_the_text() -> None:
    ends = [0, 2000, 3000, 4000, 5000, 6000, 7000, 9000]
    for name in ("ch5-seven-step", "ch5-printed-recursion", "ch5-sample-interval", "ch5-two-outputs"):
        one = get(name)
        drawn = marks(one, build(one).signals)
        assert [(mark.from_tick, mark.until_tick) for mark in drawn] == list(pairwise(ends))
