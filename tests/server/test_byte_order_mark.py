"""A text that begins with a byte order mark, as some editors write UTF-8, is read at each door as it is without one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from core.nesting import read_toml
from scenarios.benchmark.seeds import hidden_list
from scenarios.benchmark.track import tracks
from server.api.examples import SHEET, UNIT
from server.cli.main import app
from server.settings import load_settings

MARK = "\ufeff"
SCENARIO = 'id = "mine"\nsample_rate_khz = 100\nsamples = 50\ndevice.id = "ch3"\n'
SWEEP = 'id = "mine"\nscenario = "mine.toml"\nseeds = "1:2"\n'
LECTURE = """title = "Mine"
chapter = 1
summary = "A step."

[[cue]]
title = "A step"
minutes = 1
scenario = "ch1-step"
until_ms = 1
pace_ms_per_s = 1
say = "It moves."
"""
FILES = {
    "mine.toml": SCENARIO,
    "sweep.toml": SWEEP,
    "lecture.toml": LECTURE,
    "sheet.md": SHEET,
    "gain.py": UNIT,
}
COMMANDS = {
    "a scenario": ["run", "mine.toml", "--json"],
    "a unit beside a scenario": ["run", "mine.toml", "--unit", "gain.py", "--set", "controller.kind=gain", "--json"],
    "a campaign and its scenario": ["sweep", "sweep.toml", "--workers", "1", "--out", "made"],
    "a lecture": ["lectures", "lecture.toml", "--json"],
    "a sheet": ["sheets", "--check", "sheet.md", "--json"],
    "a unit": ["check", "gain.py", "--json"],
}


def said(folder: Path, mark: str, command: list[str], monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return the output of a command for files that begin with a mark, without the times that it measures."""
    folder.mkdir()
    monkeypatch.chdir(folder)
    for name, text in FILES.items():
        (folder / name).write_text(mark + text, "utf-8")
    done = CliRunner().invoke(app, command, catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    if "--json" not in command:
        return sorted(path.name for path in (folder / "made").iterdir())
    return json.loads(done.stdout, object_hook=lambda one: {k: v for k, v in one.items() if k not in TIMES})


TIMES = ("elapsed_s", "ns_per_sample")


@pytest.mark.parametrize("command", COMMANDS.values(), ids=COMMANDS)
def test_a_file_of_the_command_line(command: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plain, marked = (said(tmp_path / name, mark, command, monkeypatch) for name, mark in (("a", ""), ("b", MARK)))
    assert marked == plain and plain


def test_the_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "combbench.toml").write_text(f"{MARK}port = 1001\n", "utf-8")
    assert load_settings().port == 1001


def test_hidden_seeds_of_a_benchmark() -> None:
    text = 'salt = "00"\n'
    words = []
    for mark in ("", MARK):
        with pytest.raises(ValueError, match="seeds") as caught:
            hidden_list(mark + text, [*tracks()])
        words.append(str(caught.value))
    assert words[0] == words[1]


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("scenarios/check", {"scenario": SCENARIO}),
        ("benches", {"scenario": SCENARIO, "paused": True}),
        ("units", {"name": "gain", "source": UNIT}),
    ],
)
def test_a_text_over_rest(live: Any, path: str, body: dict[str, Any]) -> None:
    marked = {name: MARK + text if isinstance(text, str) and "\n" in text else text for name, text in body.items()}
    answers = [live.http.post(f"/api/v1/{path}", json=one) for one in (body, marked)]
    assert [answer.status_code for answer in answers] == [answers[0].status_code] * 2
    first, second = (answer.json() for answer in answers)
    for answer in (first, second):
        assert answer.get("error") is None, answer
    if path == "units":
        assert second["unit"]["hash"] == first["unit"]["hash"]


def test_a_campaign_and_a_sheet_over_rest(live: Any) -> None:
    sweep = f'{MARK}id = "marked"\nscenario = "first-look"\nset = {{ samples = 50 }}\n'
    started = live.http.post("/api/v1/sweeps", json={"sweep": sweep})
    assert started.is_success, started.text
    live.ended(started.json()["id"])
    opened = live.http.post("/api/v1/sheets", json={"text": MARK + SHEET})
    assert opened.is_success, opened.text
    assert live.http.delete(f"/api/v1/sheets/{opened.json()['id']}").status_code == 204


def test_a_whole_body(live: Any) -> None:
    body = (MARK + json.dumps({"scenario": SCENARIO})).encode()
    answer = live.http.post("/api/v1/scenarios/check", content=body, headers={"Content-Type": "application/json"})
    assert answer.is_success, answer.text


def test_a_mark_within_a_text_is_no_mark() -> None:
    assert read_toml(f'{MARK}a = "{MARK}"', "")["a"] == MARK
    with pytest.raises(ValueError, match="malformed"):
        read_toml(f"a = 1\n{MARK}b = 2", "")
