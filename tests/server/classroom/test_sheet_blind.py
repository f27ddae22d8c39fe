"""A sheet reveals nothing of a bench with a hidden fault: at no door, and not by the steps it closes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest

from server.classroom import blind
from server.classroom.access import DOORS, Need, serves_blind
from server.classroom.classes import Classes
from tests.server.classroom.at_sheet import API, AtSheet
from tests.server.classroom.group import join, open_class
from tests.server.classroom.test_blind_doors import plain
from tests.server.conftest import Live

SHEET = """+++
schema = 1
title = "What is it?"
summary = "Conditions that would tell a fault."
minutes = 5
[bench]
scenario = "first-look"
set = { "device.id" = "lcr-350" }
+++

## Run

```step
id = "run"
kind = "hold"
points = 1.0
for_ms = 1.0
window_ms = 0.5
conditions = [
  { label = "Fault", name = "mass", fault = "added_mass", between = [0.01, 1.0], told = false },
  { label = "Verdict", verdict = "kalman", equals = "m+5" },
  { label = "Motion", name = "size", signal = "plant.displacement", measure = "swing", between = [0.0, 50.0] },
]
hints = [{ text = "Wait.", costs = 0.0 }]
```

It moved {{ run_size | um }}.

## Ask

```step
id = "ask"
kind = "question"
points = 1.0
question = "How heavy?"
[number]
value = "run_mass"
```
"""
MASS = {"fault": "added_mass", "severity": 0.05}
BEGUN = re.compile(r"(?:begun|written) [\d :-]+UTC")
TO_COME = 900
"""Ticks after which a fault has come, at the usual pace."""


def hidden(live: Live, sheet: str, faults: list[Any], monkeypatch: pytest.MonkeyPatch) -> AtSheet:
    """Begin the sheet with a student whose device is the same each time, and hide a fault on its bench."""

    async def drawn(*_: Any) -> int:
        return 7

    with monkeypatch.context() as patch:
        patch.setattr(Classes, "draw", drawn)
        at = AtSheet(live, sheet, join(live, open_class(live, "At a sheet"), "Ada"))
        at.do(kind="step", ticks=70)  # a window, and a part of the next
        patch.setattr(blind, "faults_of", lambda _: faults)
        at.ask("POST", f"/benches/{at.bench}/blind", status=201, seed=3)
    at.do(kind="step", ticks=TO_COME)
    return at


def told(at: AtSheet, sheet: str) -> dict[str, str]:
    """Ask at all doors of sheets while the fault acts; return what came."""
    found: dict[str, str] = {}
    bodies = {f"{API}/sheets/{{sheet_id}}/steps/{{step_id}}/answer": {"answer": "5"}}
    looks = [f"{API}/sheets", f"{API}/sheets/{{sheet_id}}", f"{API}/sheets/{{sheet_id}}/report"]
    doors = [
        (m, path) for (m, path), need in DOORS.items() if need is Need.SESSION and path.startswith(f"{API}/sheets")
    ]
    assert {path for method, path in doors if method == "GET"} == set(looks)
    changes = sorted((door for door in doors if door[0] != "GET"), key=lambda door: door[1].endswith("close"))
    for method, path in changes:
        for look in [("GET", one) for one in looks] + [(method, path)]:
            filled = look[1].replace("{sheet_id}", sheet).replace("{step_id}", "run").replace("{recording_id}", "none")
            answer = at.person.ask(look[0], filled, **({"json": bodies.get(path)} if look[0] == "POST" else {}))
            assert (answer.status_code == 403) == (not serves_blind(*look)), look
            text = BEGUN.sub("begun", answer.text)
            found[f"{look} before {path}"] = plain(f"{answer.status_code} {text}", at.bench)
    found["closed"] = plain(str(at.look()), at.bench)
    return found


@pytest.fixture
def sheet(live: Live) -> Iterator[str]:
    """The sheet; the work at it, and its classes, are deleted."""
    made = live.http.post(f"{API}/sheets", json={"text": SHEET}).json()["id"]
    yield made
    live.http.delete(f"{API}/sheets/{made}")
    for group in live.http.get(f"{API}/classes").json()["classes"]:
        if group["name"] == "At a sheet":
            live.http.delete(f"{API}/classes/{group['id']}")


def test_no_door_of_a_sheet_tells_what_is_hidden(live: Live, sheet: str, monkeypatch: pytest.MonkeyPatch) -> None:
    cases: list[list[Any]] = [[MASS], [], [{"fault": "stiffness", "severity": 0.05}]]
    students = [hidden(live, sheet, faults, monkeypatch) for faults in cases]
    for at, faults in zip(students, cases, strict=True):
        acting = live.get(at.bench)["faults"]
        assert [one["name"] for one in acting] == [one["fault"] for one in faults]
        step = at.step("run")
        assert step["earned"] == 0.0 and step["held_share"] == 0.0
        assert [one["now"] for one in step["conditions"]] == ["–", "–", ""]
    first, *others = [told(at, sheet) for at in students]
    for other in others:
        assert [(key, other[key], first[key]) for key in first if other[key] != first[key]] == []


def test_a_step_is_looked_at_again_once_the_fault_is_told(
    live: Live, sheet: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    at = hidden(live, sheet, [MASS], monkeypatch)
    assert at.step("run")["earned"] == 0.0
    at.ask("POST", f"/benches/{at.bench}/blind/answer", said="m+5", confidence=1.0)
    assert at.step("run")["earned"] == 0.0  # what held meanwhile does not count
    at.do(kind="step", ticks=99)
    assert at.step("run")["earned"] == 0.0
    at.do(kind="step", ticks=100)
    assert at.step("run")["earned"] == 1.0


CASES = """+++
schema = 1
title = "Two cases"
summary = "Each hides a fault."
minutes = 5
[bench]
scenario = "first-look"
drawn_device = true
set = { "device.id" = "lcr-350" }
+++

## First

```step
id = "first"
kind = "blind"
points = 4.0
```

## Second

```step
id = "second"
kind = "blind"
points = 2.0
```
"""


@pytest.fixture
def cases(live: Live) -> Iterator[tuple[str, dict[str, Any]]]:
    """A sheet of two hidden faults, and a class."""
    made, group = live.http.post(f"{API}/sheets", json={"text": CASES}).json()["id"], open_class(live, "At a sheet")
    yield made, group
    live.http.delete(f"{API}/classes/{group['id']}")
    live.http.delete(f"{API}/sheets/{made}")


def truth_of(live: Live, bench: str) -> str:
    """Return the hidden fault of a bench; no door reveals it."""
    return str(live.service.benches.get(bench).view.rules.truth)


def test_a_step_takes_the_answer_to_the_fault_that_it_has_hidden_and_no_other(
    live: Live, cases: tuple[str, dict[str, Any]]
) -> None:
    """Neither of a bench that the student has made easy, nor of the sheet's own after a hand on its noise."""
    sheet, group = cases
    at = AtSheet(live, sheet, join(live, group, "Ada"))
    hypotheses = [{"name": "healthy"}, {"name": "m+50", "mass": 1.5}]
    easy = {"sensor.noise_um": 0.0, "diagnosers.kalman.hypotheses": hypotheses}
    for turn in range(2):
        if turn == 0:
            bench = at.ask("POST", "/benches", status=201, scenario="first-look", set=easy)["id"]
        else:
            bench = at.bench = at.ask("POST", f"/sheets/{sheet}/begin")["bench"]
            at.do(kind="reset", values={"sensor.noise_um": 0.0})
        at.ask("POST", f"/benches/{bench}/blind", status=201, seed=1)
        said = at.ask("POST", f"/benches/{bench}/blind/answer", said=truth_of(live, bench), confidence=1.0)
        assert said["points"] == 100.0
        assert (at.step("first")["earned"], at.step("first")["can_go_on"]) == (0.0, True)
    bench = at.ask("POST", f"/sheets/{sheet}/steps/first/hide", status=201)["bench"]
    assert len(at.ask("GET", f"/benches/{bench}")["blind"]["answers"]) == 6
    assert live.service.benches.get(bench).document["sensors"]["ideal"]["noise_um"] == 0.05
    refused = at.ask("POST", f"/sheets/{sheet}/steps/first/hide", status=403)["error"]
    assert refused["code"] == "blind"
    at.ask("POST", f"/benches/{bench}/blind/answer", said=truth_of(live, bench), confidence=1.0)
    assert at.step("first")["earned"] == 4.0
    assert at.ask("POST", f"/sheets/{sheet}/steps/first/hide", status=422)["error"]["field"] == "step"


def test_a_fault_that_is_given_up_earns_nothing_and_one_whose_bench_has_gone_is_hidden_anew(
    live: Live, cases: tuple[str, dict[str, Any]]
) -> None:
    sheet, group = cases
    at = AtSheet(live, sheet, join(live, group, "Ada"))
    at.ask("POST", f"/sheets/{sheet}/steps/first/hide", status=201)
    live.http.post(f"{API}/classes/{group['id']}/scenario", json={"scenario": "first-look"})
    assert at.step("first")["can_go_on"]
    bench = at.ask("POST", f"/sheets/{sheet}/steps/first/hide", status=201)["bench"]
    at.ask("DELETE", f"/benches/{bench}/blind")
    assert (at.step("first")["earned"], at.step("first")["can_go_on"]) == (0.0, False)
    assert at.step("second")["can_go_on"]


def test_no_two_names_and_no_two_steps_share_what_is_drawn(live: Live, cases: tuple[str, dict[str, Any]]) -> None:
    """A second name that joins by the same code gets nothing of the first."""
    sheet, group = cases
    drawn: set[tuple[Any, ...]] = set()
    for name in ("Ada", "Ben"):
        at = AtSheet(live, sheet, join(live, group, name))
        for step in ("first", "second"):
            bench = at.ask("POST", f"/sheets/{sheet}/steps/{step}/hide", status=201)["bench"]
            session = live.service.benches.get(bench)
            drawn.add((session.board.spec.seed, session.view.rules.came_tick))
            at.ask("DELETE", f"/benches/{bench}/blind")
            at.look()
    assert len(drawn) == 4
