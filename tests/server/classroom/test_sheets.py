"""Sheets on the server: points, order, hidden parts, classes, grades, and survival."""

from __future__ import annotations

import csv
import io
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest

from server.classroom.grades import safe
from tests.server.classroom.at_sheet import API, AtSheet, response
from tests.server.classroom.group import Somebody, advance, join, open_class, the_teacher, watcher
from tests.server.conftest import Live

OWN = """+++
schema = 1
title = "Two steps"
summary = "For a test."
minutes = 5
[bench]
scenario = "first-look"
drawn_device = true
set = { "device.id" = "lcr-350" }
[draws]
volts = { low = 1.0, high = 9.0, step = 1.0 }
+++
Secret: nothing of what comes is told.

## Run

Set {{ volts | V }}.

```step
id = "run"
kind = "hold"
points = 1.0
for_ms = 2.0
window_ms = 0.5
trace = ["plant.displacement"]
conditions = [
  { label = "Amplitude", setting = "reference.amplitude_v", between = ["volts - 0.1", "volts + 0.1"], unit = "V" },
  { label = "Motion", name = "size", signal = "plant.displacement", measure = "swing", between = [0.0, 50.0] },
]
```

The resonance is {{ f0_hz | Hz }}. <script>alert(1)</script>

## Ask

```step
id = "ask"
kind = "question"
points = 2.0
question = "What is the resonance?"
hints = [{ text = "The root of k over m.", costs = 0.25 }]
[number]
value = "f0_hz"
unit = "Hz"
within = 0.01
partly = { within = 0.05, share = 0.5 }
```

The end.
"""


@pytest.fixture
def own(live: Live) -> Any:
    """A user's sheet; it is deleted after the test."""
    made = live.http.post(f"{API}/sheets", json={"text": OWN})
    assert made.status_code == 201, made.text
    yield made.json()["id"]
    assert live.http.delete(f"{API}/sheets/{made.json()['id']}").status_code == 204


def volts_of(at: AtSheet) -> float:
    text = next(s["text"] for s in at.look()["sections"])
    return float(text.split("Set ")[1].split("\u00a0")[0])


def test_points_come_and_go_by_the_rule_that_is_shown(live: Live, own: str) -> None:
    at = AtSheet(live, own)
    assert at.look()["earned"] == 0.0
    at.set(reference__amplitude_v=volts_of(at))
    at.held("run", 10.0)
    step = at.step("ask")
    assert "2 points within 1 %" in step["rule"].replace("\u00a0", " ")
    assert "costs 0.5 points" in step["rule"].replace("\u00a0", " ")
    assert step["next_hint_costs"] == 0.25 and step["hints"] == []
    at.ask("POST", f"/sheets/{own}/steps/ask/answer", status=422, answer="quick")
    assert at.look()["earned"] == 1.0  # what cannot be read costs nothing
    assert at.answer("ask", "1 Hz")["earned"] == -0.5
    assert at.look()["earned"] == 0.5
    at.ask("POST", f"/sheets/{own}/steps/ask/hint")
    assert at.look()["earned"] == 0.25
    near = at.answer("ask", f"{at.device['f0_hz'] * 1.03:.1f} Hz")
    assert near["answers"][1]["reason"].replace("\u00a0", " ") == "within 5 %" and near["earned"] == 0.25
    assert near["solution"] is None
    done = at.answer("ask", f"{at.device['f0_hz']:.1f} Hz")
    assert done["earned"] == 1.25 and done["solution"]
    assert at.look()["done"] and at.view["earned"] == 2.25


def test_nothing_of_a_step_is_told_before_it_is_done(live: Live, own: str) -> None:
    at = AtSheet(live, own)
    seen = str(at.look())
    assert "The resonance is" not in seen and "What is the resonance?" not in seen and "The root of" not in seen
    assert [section["state"] for section in at.view["sections"]] == ["open", "closed"]
    at.ask("POST", f"/sheets/{own}/steps/ask/answer", status=422, answer="2 kHz")
    at.ask("POST", f"/sheets/{own}/steps/run/answer", status=422, answer="2 kHz")
    at.ask("POST", f"/sheets/{own}/steps/none/answer", status=422, answer="2 kHz")
    at.ask("POST", f"/sheets/{own}/steps/run/close")
    assert at.step("run")["given_up"] and at.step("run")["earned"] == 0.0
    assert "The resonance is" in str(at.view)


def test_who_has_used_up_all_attempts_is_told_the_answer(live: Live, own: str) -> None:
    at = AtSheet(live, own)
    at.ask("POST", f"/sheets/{own}/steps/run/close")
    for left in (2, 1, 0):
        assert at.answer("ask", "1 kV")["tries_left"] == left
    assert at.look()["done"] and at.view["earned"] == -1.5 and at.step("ask")["solution"]


@pytest.mark.parametrize("ticks", [(1, 7, 42), (333,)])
def test_what_is_found_depends_on_ticks_alone(live: Live, own: str, ticks: tuple[int, ...]) -> None:
    """Conditions count from the first whole window behind the opening, however the bench is made to run."""
    at = AtSheet(live, own)
    at.do(kind="step", ticks=5)
    at.do(kind="reset")  # earlier ticks do not count, and do not shorten the rest
    at.set(reference__amplitude_v=volts_of(at))
    asked = cycle(ticks)
    while not at.step("run")["earned"]:
        at.do(kind="step", ticks=next(asked))
    work = next(w for w in live.service.sheets.works("teacher") if w.sheet_id == own)
    state = work.progress.steps["run"]
    assert state.tick == 200
    assert state.values["Motion"] == pytest.approx(work.progress.facts["run_size"])
    again = AtSheet(live, own)  # answers stay, the bench is new
    assert again.bench != at.bench and again.step("run")["earned"] == 1.0


def test_a_setting_that_is_left_begins_the_time_again(live: Live, own: str) -> None:
    at = AtSheet(live, own)
    volts = volts_of(at)
    at.set(reference__amplitude_v=volts)
    at.run(1.6)
    assert at.step("run")["held_share"] == pytest.approx(0.75)
    at.set(reference__amplitude_v=volts + 1)
    at.run(0.5)
    assert at.step("run")["held_share"] == 0.0 and not at.step("run")["conditions"][0]["holds"]
    at.set(reference__amplitude_v=volts)
    at.run(1.4)
    assert not at.step("run")["earned"]
    at.run(0.5)
    assert at.step("run")["earned"] == 1.0


def test_the_sheet_is_handed_in_as_one_file(live: Live, own: str) -> None:
    at = AtSheet(live, own)
    at.set(reference__amplitude_v=volts_of(at))
    at.held("run", 10.0)
    recording = at.ask("POST", f"/benches/{at.bench}/recordings", status=201, ticks=0, past_ticks=10)["id"]
    at.ask("PUT", f"/sheets/{own}/recordings/{recording}")
    at.ask("PUT", f"/sheets/{own}/recordings/nobodys", status=404)
    at.answer("ask", "1 Hz <b>")
    html = at.person.ask("GET", f"{API}/sheets/{own}/report").text
    assert (
        "recording: 100\u00a0µs from" in html
        and f"({recording})" in html
        and "1 Hz &lt;b&gt;" in html
        and "<svg" in html
        and "0.5 of 3" in html
    )
    assert "<script" not in html and "&lt;script&gt;" in html


def test_a_sheet_of_ones_own_is_refused_with_its_line(live: Live) -> None:
    count = len(live.http.get(f"{API}/sheets").json()["sheets"])
    answer = live.http.post(f"{API}/sheets", json={"text": OWN.replace("points = 2.0", "points = -2.0")})
    assert answer.status_code == 422
    assert "line 39, step ask, points: must be > 0" in answer.json()["error"]["message"]
    assert len(live.http.get(f"{API}/sheets").json()["sheets"]) == count
    assert live.http.delete(f"{API}/sheets/first-look").status_code == 404


def test_a_class_works_at_a_sheet_each_with_own_numbers(live: Live, own: str) -> None:
    group = open_class(live)
    ada, ben = join(live, group, "=Ada"), join(live, group, "Ben")
    begun = live.http.post(f"{API}/classes/{group['id']}/sheet", json={"sheet": own})
    assert begun.json() == {"done": 2, "failed": []}
    works = {w.person_id: w for w in live.service.sheets.works(class_id=group["id"])}
    assert works[ada.id].progress.facts["f0_hz"] != works[ben.id].progress.facts["f0_hz"]
    benches = {ada.me()["bench"], ben.me()["bench"]}
    assert benches == {works[ada.id].bench_id, works[ben.id].bench_id}
    assert ada.ask("GET", f"{API}/sheets").json()["current"] == own
    ada.ask("POST", f"{API}/sheets/{own}/steps/run/close")
    ada.ask("POST", f"{API}/sheets/{own}/steps/ask/answer", json={"answer": "-5 Hz"})
    tiles = live.http.get(f"{API}/classes/{group['id']}/members").json()["members"]
    assert tiles[0]["sheet"] == {
        **{"sheet": own, "title": "Two steps", "step": 2, "steps": 2},
        **{"earned": -0.5, "points": 3.0, "done": False},
    }
    grades = live.http.get(f"{API}/classes/{group['id']}/grades").json()["grades"]
    assert [(grade["student"], grade["points"]) for grade in grades] == [("=Ada", -0.5), ("Ben", 0.0)]
    text = live.http.get(f"{API}/classes/{group['id']}/grades?format=csv").text
    rows = list(csv.DictReader(io.StringIO(text)))
    assert len(rows) == 4
    assert (rows[1]["student"], rows[1]["answers"], rows[1]["lost"], rows[1]["earned"]) == (
        "'=Ada",
        "'-5 Hz",
        "0.5",
        "0.0",
    )
    assert all(not cell.startswith(("=", "+", "-", "@", "\t", "\r")) for row in rows for cell in row.values())
    report = f"{API}/classes/{group['id']}/sheets/{own}/{ada.id}/report"
    assert "=Ada" in live.http.get(report).text
    for somebody in (ada, ben):
        assert somebody.ask("GET", report).status_code == 403
        assert somebody.ask("GET", f"{API}/classes/{group['id']}/grades").status_code == 403
        assert somebody.ask("DELETE", f"{API}/sheets/{own}/progress").status_code == 403
    guest = watcher(live, works[ada.id].bench_id)
    assert guest.ask("POST", f"{API}/sheets/{own}/begin").status_code == 409
    assert (
        live.http.post(f"{API}/classes/{group['id']}/sheet", json={"sheet": own, "members": ["x"]}).status_code == 422
    )
    live.http.delete(f"{API}/classes/{group['id']}")


def test_the_page_that_is_led_to_the_bench_of_a_sheet_finds_the_sheet_there(
    live: Live, own: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The end of the earlier bench leads a page to the new one, where it asks which sheet is on it."""
    group = open_class(live)
    ada = join(live, group, "Ada")
    service, close = live.service, live.service.hub.close_bench
    seen: list[tuple[str, str]] = []

    def closing(bench: str) -> None:
        person = next(one for one in service.people.students(group["id"]) if one.id == ada.id)
        work = service.sheets.current(person)
        seen.append((work[0].bench_id if work else "", service.people.bench_of(person)))
        close(bench)

    monkeypatch.setattr(service.hub, "close_bench", closing)
    assert live.http.post(f"{API}/classes/{group['id']}/sheet", json={"sheet": own}).json()["done"] == 1
    assert len(seen) == 1 and seen[0][0] == seen[0][1] != ada.bench
    monkeypatch.undo()
    live.http.delete(f"{API}/classes/{group['id']}")


def test_nobody_hands_in_a_recording_of_somebody_else(live: Live, own: str) -> None:
    group = open_class(live)
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    live.http.post(f"{API}/classes/{group['id']}/sheet", json={"sheet": own})
    stage = live.bench("first-look")["id"]
    live.http.put(f"{API}/classes/{group['id']}/shown", json={"bench": stage})
    benches = [who.me()["bench"] for who in (ada, ben)]
    status, teacher = {}, the_teacher(live)
    for name, who, bench in (("own", ada, benches[0]), ("other", ben, benches[1]), ("shown", teacher, stage)):
        advance(live, bench=bench, ticks=21)
        made = who.ask("POST", f"{API}/benches/{bench}/recordings", json={"ticks": 0, "past_ticks": 10}).json()["id"]
        status[name] = ada.ask("PUT", f"{API}/sheets/{own}/recordings/{made}").status_code
    assert status == {"own": 200, "other": 404, "shown": 404}
    ada.ask("POST", f"{API}/sheets/{own}/begin")  # another bench; the earlier recordings stay with the student
    assert ada.ask("PUT", f"{API}/sheets/{own}/recordings/{made}").status_code == 404
    kept = ada.ask("GET", f"{API}/sheets/{own}").json()["recordings"]
    assert ada.ask("PUT", f"{API}/sheets/{own}/recordings/{kept[0]}").json()["recordings"] == kept
    live.http.delete(f"{API}/benches/{stage}")
    live.http.delete(f"{API}/classes/{group['id']}")


def test_who_joins_later_begins_the_sheet_of_the_class(serve: Any, tmp_path: Path) -> None:
    folder = tmp_path / "late"

    def begun(who: Somebody) -> str | None:
        found = who.ask("GET", f"{API}/sheets").json()["current"]
        bench = who.me()["bench"]
        assert found is None or who.ask("GET", f"{API}/sheets/{found}").json()["bench"] == bench
        return None if found is None else str(found)

    with serve(folder=folder, clock="manual") as live:
        own = live.http.post(f"{API}/sheets", json={"text": OWN}).json()["id"]
        group = open_class(live)
        ada = join(live, group, "Ada")
        live.http.post(f"{API}/classes/{group['id']}/sheet", json={"sheet": own, "members": [ada.id]})
        assert begun(ada) == own and begun(join(live, group, "Ben")) is None
        live.http.post(f"{API}/classes/{group['id']}/sheet", json={"sheet": own})
        assert begun(join(live, group, "Cy")) == own
    with serve(folder=folder, clock="manual") as live:
        group = live.http.post(f"{API}/classes/{group['id']}/code", json={}).json()
        dee = join(live, group, "Dee")
        assert begun(dee) == own
        tick = live.get(dee.bench)["created"]
        assert live.get(dee.me()["bench"])["created"] == tick  # it was made once
        live.http.post(f"{API}/classes/{group['id']}/scenario", json={"scenario": "first-look"})
        assert begun(join(live, group, "Eve")) is None
        live.http.post(f"{API}/classes/{group['id']}/sheet", json={"sheet": own})
        live.http.delete(f"{API}/sheets/{own}")
        assert begun(join(live, group, "Fay")) is None


def test_no_cell_is_a_formula() -> None:
    formulas = ["=1+1", "+1", "-1", "@A1", "\tx", "\rx"]
    assert [safe(text) for text in formulas] == [f"'{text}" for text in formulas]
    assert [safe(f"a{text}") for text in formulas] == [f"a{text}" for text in formulas]


def test_answers_outlive_the_server(serve: Any) -> None:
    with serve(clock="manual") as live:
        own = live.http.post(f"{API}/sheets", json={"text": OWN}).json()["id"]
        alone = AtSheet(live, own)
        alone.ask("POST", f"/sheets/{own}/steps/run/close")
        alone.answer("ask", "1 Hz")
        group = open_class(live)
        ada = join(live, group, "Ada")
        at = AtSheet(live, own, ada)
        at.set(reference__amplitude_v=volts_of(at))
        at.held("run", 10.0)
        facts = live.service.sheets.works(ada.id)[0].progress.facts
    with serve(clock="manual") as live:
        view = live.http.get(f"{API}/sheets/{own}").json()
        assert view["earned"] == -0.5 and view["bench"] is None
        back = Somebody(live, ada.secret)
        view = back.ask("GET", f"{API}/sheets/{own}").json()
        assert view["earned"] == 1.0
        assert live.service.sheets.works(ada.id)[0].progress.facts == facts
        again = AtSheet(live, own)
        assert again.view["earned"] == -0.5 and again.view["bench"]


def test_the_sheet_of_the_manual_is_a_whole_sheet(live: Live) -> None:
    text = (Path(__file__).parents[3] / "docs" / "sheets.md").read_text()
    example = text.split("`````markdown\n")[1].split("`````")[0]
    name = live.http.post(f"{API}/sheets", json={"text": example}).json()["id"]
    at = AtSheet(live, name)
    at.right("guess", "2")
    volts = float(at.look()["sections"][1]["text"].split("reference to ")[1].split("\u00a0")[0])
    at.set(reference__amplitude_v=volts)
    at.held("twice", 100.0)
    d = at.device
    force = abs(d["static_gain_um_per_v"]) * d["stiffness_n_m"] * volts
    moved = force * abs(response(d["mass_kg"], d["stiffness_n_m"], d["damping_ns_m"], 500.0))
    at.right("far", f"{1e3 * moved:.1f} nm")
    assert at.look()["done"] and at.view["earned"] == 4.0
    live.http.delete(f"{API}/sheets/{name}")
