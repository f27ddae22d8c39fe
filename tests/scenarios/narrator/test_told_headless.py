"""The narrator headless: printed and in JSON on request, and part of the report."""

from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner

from core.diagnose.hypothesis import Hypothesis
from core.format import MINUS
from scenarios.library import get
from scenarios.narrator.words import change, hypothesis_words, listed, uncapital
from scenarios.run import run
from server.cli.main import app

SHORT = ["run", "ch5-seven-step", "--set", "samples=3100", "--set", "expect=[]"]


def call(*arguments: str) -> tuple[int, str]:
    outcome = CliRunner().invoke(app, list(arguments))
    return outcome.exit_code, outcome.output


def plain(text: str) -> str:
    return " ".join(text.split())


def test_the_command_line_tells_what_happens_if_asked() -> None:
    scenario = get("ch5-seven-step")
    document = {key: value for key, value in scenario.document.items() if key != "expect"}
    said = run(type(scenario).load({**document, "samples": 3100}), narrate=True).narration
    code, text = call(*SHORT, "--narrate")
    assert code == 0 and len(said) == 4
    for sentence in said:
        assert plain(sentence.text) in plain(text)
    assert plain(said[0].text) not in plain(call(*SHORT)[1])


def test_json_has_the_sentences_only_if_asked() -> None:
    assert "narration" not in json.loads(call(*SHORT, "--json")[1])
    told = json.loads(call(*SHORT, "--json", "--narrate")[1])["narration"]
    assert [said["kind"] for said in told] == ["fault", "verdict", "fault", "verdict"]
    assert told[1]["numbers"]["delay_samples"] == 12.0


def test_it_tells_of_one_seed_alone() -> None:
    code, _ = call(*SHORT, "--narrate", "--seeds", "1:2")
    assert code == 2


def test_a_report_tells_what_happened(tmp_path: Path) -> None:
    assert call(*SHORT, "--out", str(tmp_path))[0] == 0
    (report,) = tmp_path.glob("*.html")
    text = report.read_text()
    assert "<h2>What happened</h2>" in text and text.count("the bank now favours") == 2
    (summary,) = tmp_path.glob("*.json")
    assert "narration" not in json.loads(summary.read_text())


def test_hypotheses_are_said_in_words() -> None:
    said = {"m+5": Hypothesis(name="m+5", mass=1.05), "b+30": Hypothesis(name="b+30", damping=1.3)}
    assert hypothesis_words(said["m+5"]) == "mass +5\u00a0%"
    assert hypothesis_words(said["b+30"]) == "damping +30\u00a0%"
    assert (
        hypothesis_words(Hypothesis(name="x2", mass=0.9, gain=1.1)) == f"mass {MINUS}10\u00a0%, drive gain +10\u00a0%"
    )
    assert hypothesis_words(Hypothesis(name="healthy")) == "healthy"
    assert hypothesis_words(Hypothesis(name="heavy", mass=1.05)) == "heavy"  # a user's choice of words


def test_words_read_as_people_write_them() -> None:
    assert (change(0.05), change(-0.3), change(0.0)) == ("+5\u00a0%", f"{MINUS}30\u00a0%", "0\u00a0%")
    assert (uncapital("Direct MRAC"), uncapital("PID")) == ("direct MRAC", "PID")
    assert (listed(["a"]), listed(["a", "b", "c"])) == ("a", "a, b and c")
