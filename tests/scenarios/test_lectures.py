"""Every lecture: the claims of its notes are true on a real run, and an error in a file is said in one line."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, get_args

import pytest
from typer.testing import CliRunner

from core.errors import InputError
from scenarios.lecture import Cue, Lecture, Panel
from scenarios.lectures import lecture, lecture_ids
from scenarios.run import build
from server.cli.main import app

CUE = """
[[cue]]
title = "{title}"
minutes = 1
say = "Look."
{more}
"""


def written(*cues: str) -> Lecture:
    text = 'title = "A lecture"\nchapter = 1\n'
    return Lecture.load("mine", text + "".join(CUE.format(title=f"Cue {n}", more=more) for n, more in enumerate(cues)))


def refusal(*cues: str) -> str:
    with pytest.raises(InputError) as refused:
        written(*cues)
    return str(refused.value)


FIRST = 'scenario = "first-look"\nuntil_ms = 2'


@pytest.mark.parametrize("name", lecture_ids())
def test_all_that_the_notes_claim_holds_on_a_real_run(name: str) -> None:
    one = lecture(name)
    assert 8 <= len(one.head.cues) <= 12
    assert one.minutes == pytest.approx(10.0)
    for cue, checked in zip(one.head.cues, one.check()["cues"], strict=True):
        assert checked["ok"], (cue.title, [row for row in checked["expectations"] if not row["ok"]])


def test_no_vote_is_answered_by_its_own_words() -> None:
    """Neither the question nor the picture and the words before it name the right answer or its number."""
    votes = [(cue, cue.vote) for name in lecture_ids() for cue in lecture(name).head.cues if cue.vote]
    assert votes
    for cue, vote in votes:
        words = " ".join((vote.text, cue.title, cue.say, cue.ask, cue.see)).casefold()
        answer = re.sub(r"^[a-z]+\+(\d+)$", r" \1 %", vote.right.casefold())
        assert answer and answer not in words, f"{cue.title} tells {vote.right}"


def test_there_is_a_lecture_for_each_of_five_chapters() -> None:
    assert [lecture(name).head.chapter for name in lecture_ids()] == [1, 2, 3, 4, 5]


@pytest.mark.parametrize("name", lecture_ids())
def test_a_cue_begins_with_the_bits_with_which_the_cue_before_ends(name: str) -> None:
    """A lecture from cue to cue shows the same as a jump to one of them."""
    one = lecture(name)
    pairs = zip(one.states, one.states[1:], one.head.cues[1:], strict=False)
    joined = [(before, after) for before, after, cue in pairs if cue.scenario is None]
    for before, after in joined:
        digests = []
        for state, tick in ((before, before.until_tick), (after, before.until_tick)):
            board = build(state.scenario)
            while board.tick < tick:
                board.advance(tick - board.tick)
            digests.append(board.digest())
        assert digests[0] == digests[1]


def test_a_cue_goes_on_with_the_experiment_of_the_one_before() -> None:
    one = written(
        FIRST
        + '\nseed = 7\nset = { "sensor.noise_um" = 0.01 }\nevents = [{ at_ms = 1, fault = "damping", severity = 1 }]',
        'events = [{ at_ms = 3, heal = "all" }]\nuntil_ms = 4',
        "from_ms = 5",
        'scenario = "first-look"',
    )
    assert [(s.from_tick, s.until_tick) for s in one.states] == [(0, 200), (200, 400), (500, 500), (0, 0)]
    assert [len(s.scenario.events) for s in one.states] == [1, 2, 2, 0]
    assert {s.scenario.spec.seed for s in one.states[:3]} == {7} and one.states[3].scenario.spec.seed == 1
    assert one.states[2].scenario.document["sensor"]["noise_um"] == 0.01


WRONG: list[tuple[list[str], str]] = [
    (["until_ms = 2"], "mine.cue 1.scenario: is required: the first cue begins an experiment"),
    ([FIRST, "scenarios = 3"], "mine.cue 2.scenarios: "),
    ([FIRST, 'scenario = "first-lok"'], "mine.cue 2.scenario: unknown scenario 'first-lok'"),
    ([FIRST, 'panels = ["lane"]'], "mine.cue 2.panels.0: must be one of"),
    ([FIRST, 'signals = ["plant.x"]'], "mine.cue 2.signals.0: this bench has no signal plant.x"),
    ([FIRST, "from_ms = 1"], "mine.cue 2.from_ms: is before 2 ms, where the cue before ends"),
    ([FIRST, "until_ms = 1"], "mine.cue 2.until_ms: must be from 2 ms to"),
    ([FIRST, "seed = 3"], "mine.cue 2: seed and set go with scenario"),
    ([FIRST, 'events = [{ at_ms = 1, heal = "all" }]'], "mine.cue 2.events.0: is at 1 ms, outside the cue, 2 ms"),
    ([FIRST, 'events = [{ at_ms = 2, fault = "mass", severity = 1 }]'], "mine.cue 2.events.0.fault: unknown"),
    ([FIRST, 'expect = [{ metric = "device.f0_hz" }]'], "mine.cue 2.expect.0: needs min, max, or value"),
    ([FIRST + "\nset = { reference = { frequency_hz = 0 } }"], "mine.cue 1"),
    (['scenario = "ch1-beam-width"'], "mine.cue 1.scenario: ch1-beam-width is a study"),
    ([FIRST, '[cue.vote]\ntext = "Which?"\ndiagnoser = "imm"'], "mine.cue 2.vote.diagnoser: this bench has no"),
    ([FIRST, '[cue.vote]\ntext = "Which?"'], "mine.cue 2.vote: give answers or a diagnoser"),
    ([FIRST, '[cue.vote]\ntext = "Which?"\nanswers = ["a", "a"]'], "mine.cue 2.vote: answers must be two to six"),
    ([FIRST, '[cue.vote]\ntext = "Which?"\nanswers = ["a", ""]'], "mine.cue 2.vote: an answer has 1 to 100"),
    (
        [FIRST, '[cue.vote]\ntext = "Which?"\ndiagnoser = "kalman"\nwhen = { from_ms = 3, until_ms = 3 }'],
        "mine.cue 2.vote.when: from_ms must be less",
    ),
    ([FIRST, "until_ms = 50001"], "mine.cue 2.until_ms: must be from 2 ms to 50000 ms"),
    ([FIRST, 'until_ms = 4\nevents = [{ at_ms = 5, heal = "all" }]'], "mine.cue 2.events.0: is at 5 ms, outside"),
    (
        [FIRST + '\nevents = [{ at_ms = 1, heal = "all" }]', 'events = [{ at_ms = 2, fault = "mass", severity = 1 }]'],
        "mine.cue 2.events.0.fault: unknown",
    ),
]


def test_an_error_names_the_cue_and_the_field() -> None:
    assert [(cues, found) for cues, said in WRONG if not (found := refusal(*cues)).startswith(said)] == []


def test_the_panels_a_lecture_can_show_are_views_of_the_page() -> None:
    text = (Path(__file__).parents[2] / "web" / "src" / "bench" / "panel-views.ts").read_text("utf-8")
    (table,) = re.findall(r"export const VIEWS = {(.*?)} as const;", text, re.DOTALL)
    assert set(get_args(Panel)) <= set(re.findall(r'"(\w+)"', table))


def test_the_command_line_lists_and_checks_lectures(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    claim = '{ metric = "device.f0_hz", min = 2400, max = 2500 }'
    body = 'title = "Mine"\nchapter = 1\n' + CUE.format(
        title="One", more=f'scenario = "first-look"\nexpect = [{claim}]'
    )
    file.write_text(body)
    checked = run("lectures", str(file), "--json")
    assert checked.exit_code == 0
    [cue] = json.loads(checked.output)[0]["cues"]
    assert cue["ok"] and cue["expectations"][0]["measured"] == pytest.approx(2483.8, abs=0.1)
    file.write_text(body.replace("2400", "2490"))
    missed = run("lectures", str(file))
    assert missed.exit_code == 1 and "MISS  1 One" in missed.output
    file.write_text(body.replace("first-look", "firs-look"))
    assert run("lectures", str(file)).exit_code == 2


def run(*words: str) -> Any:
    return CliRunner().invoke(app, list(words))


def test_the_example_of_the_document_is_a_lecture_whose_claims_hold() -> None:
    text = (Path(__file__).parents[2] / "docs/lectures.md").read_text()
    [example] = re.findall(r"```toml\n(.*?)```", text, re.S)
    cues = Lecture.load("example", example).check()["cues"]
    assert len(cues) == 2 and all(cue["ok"] and cue["expectations"] for cue in cues)
    named = set(re.findall(r"`(\w+)`", " ".join(re.findall(r"^\| (`.*?) \|", text, re.M))))
    assert named == set(Cue.model_fields)
