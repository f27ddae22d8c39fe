"""A sheet tells nothing of a bench on which a fault is hidden: at no door, and not by what it closes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest

from server.bench import blind
from server.people.access import DOORS, Need, serves_blind
from server.people.classes import Classes
from tests.server.conftest import Live
from tests.server.people.at_sheet import API, AtSheet
from tests.server.people.group import join, open_class
from tests.server.people.test_blind_doors import plain

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
BEGUN = re.compile(r"begun [\d :-]+UTC")
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
    """The sheet; what was done at it, and the classes that did it, are deleted."""
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
