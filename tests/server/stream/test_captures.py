"""Captures through the stream and over REST: the bits of a headless run, of the bench and not of a page."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from core.board.history import History
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from server.stream.codec import Frame
from tests.server.classroom.group import join, open_class

NAMES = ["plant.displacement", "drive.voltage"]
TRIGGER = {"signal": "reference.voltage", "edge": "rising", "level": 0.0, "hysteresis": 0.1, "position": 0.25}
ASK = {"signals": NAMES, "mode": "triggered", "window_ms": 2.0, "width": 50, "trigger": TRIGGER}


@pytest.fixture
def small(serve: Any) -> Any:
    """A server whose benches keep as little history as there may be."""
    with serve(history_ticks=2000) as live:
        yield live


def captured(stream: Any, least: int, panel: int = 1, last: int = 0) -> list[dict[str, Any]]:
    """Return the captures of a panel once there are so many, and one at this tick."""

    def has_come(message: Any) -> bool:
        if not isinstance(message, dict) or message["type"] != "captures" or message["panel"] != panel:
            return False
        marks = message["captures"]
        return len(marks) >= least and (not last or marks[-1]["tick"] >= last)

    told = stream.until(has_come, 30.0)
    found: list[dict[str, Any]] = told["captures"]
    return found


def step(live: Any, bench: str, ticks: int) -> None:
    for piece in range(0, ticks, 1000):
        assert live.command(bench, "step", ticks=min(1000, ticks - piece)).status_code == 200
        live.show()  # captures are copied while the history has them


def rows(live: Any, bench: str, mark: dict[str, Any], names: list[str] = NAMES, **options: Any) -> np.ndarray:
    ask = {"signals": ",".join(names), "start_tick": mark["start_tick"], "end_tick": mark["end_tick"]}
    answer = live.http.get(f"/api/v1/benches/{bench}/trace", params={**ask, "format": "parquet"}, **options)
    assert answer.status_code == 200, answer.text
    table = pq.read_table(io.BytesIO(answer.content))
    assert table.column("tick").to_pylist() == list(range(mark["start_tick"], mark["end_tick"]))
    return np.array([table.column(name).to_numpy() for name in names], np.float32)


def test_a_page_that_takes_no_pictures_misses_no_capture(small: Any) -> None:
    bench = small.bench("first-look", paused=True)["id"]
    with small.stream(bench) as stream:
        stream.send(type="subscribe", panel=1, **ASK)
        stream.acks = False
        step(small, bench, 9000)
        marks = captured(stream, 40, last=8850)
    assert marks[0]["end_tick"] < small.get(bench)["first_tick"]
    assert [mark["tick"] for mark in marks] == list(range(50, 8851, 200))


def test_a_list_asked_for_behind_a_step_has_every_capture_of_it(live: Any) -> None:
    bench = live.bench("first-look", paused=True)
    others = [signal["name"] for signal in bench["signals"] if signal["name"] not in NAMES][:6]
    with live.stream(bench["id"]) as stream:
        stream.send(type="subscribe", panel=1, **{**ASK, "signals": NAMES + others})
        stream.settle()
        live.command(bench["id"], "step", ticks=9050)
        (kept,) = live.http.get(f"/api/v1/benches/{bench['id']}/captures").json()["triggers"]
    assert [mark["tick"] for mark in kept["captures"]] == list(range(50, 8851, 200))


def test_captures_outlive_the_history_with_the_bits_of_a_headless_run(small: Any) -> None:
    bench = small.bench("first-look", paused=True)
    with small.stream(bench["id"]) as stream:
        stream.send(type="subscribe", panel=1, **ASK)
        step(small, bench["id"], 1500)
        early = captured(stream, 5)
        step(small, bench["id"], 12_000)
        marks = captured(stream, 50, last=13_250)
        # the reference rises every 100 ticks, and a window of 200 is captured of every second
        assert [mark["tick"] for mark in marks] == list(range(3450, 13_251, 200))
        assert [mark["tick"] for mark in early][:3] == [50, 250, 450]
        first_tick = small.get(bench["id"])["first_tick"]
        assert sum(mark["end_tick"] <= first_tick for mark in marks) > 20
        whole = run(Scenario.load({**get("first-look").document, "samples": 13_500})).trace
        for mark in marks:
            window = slice(mark["start_tick"], mark["end_tick"])
            expected = np.array([np.float32(whole[name][window]) for name in NAMES])
            np.testing.assert_array_equal(rows(small, bench["id"], mark), expected)
            before, after = (whole["reference.voltage"][mark["tick"] + at] for at in (-1, 0))
            assert before < 0.0 <= after and mark["tick"] - mark["start_tick"] == 50
            assert mark["trigger_tick"] == pytest.approx(mark["tick"] - 1 - before / (after - before), abs=1e-4)
        # the scope shows one of them: at full rate, down to single ticks
        old = marks[0]
        ask = {**ASK, "mode": "frozen", "start_tick": old["start_tick"] + 20, "end_tick": old["start_tick"] + 30}
        stream.send(type="subscribe", panel=1, **ask)
        frame = stream.until(lambda m: isinstance(m, Frame) and m.panels[0].revision == 2)
        (picture,) = frame.panels
        part = rows(small, bench["id"], old)[:, 20:30]
        assert picture.columns.shape == (2, 2, 10)
        np.testing.assert_array_equal(picture.columns, np.stack([part, part], axis=1))
        assert captured(stream, 50) == marks


def test_captures_are_of_the_bench_and_stay_when_the_sweep_changes_or_pages_come_and_go(small: Any) -> None:
    bench = small.bench("first-look", paused=True)["id"]
    step(small, bench, 1000)
    with small.stream(bench) as stream:
        stream.send(type="subscribe", panel=1, **ASK)
        marks = captured(stream, 3)
    (kept,) = small.service.benches.find(bench).captures.sets()
    small.wait(lambda: not kept.views)  # no page looks any more, so nothing is looked for
    step(small, bench, 9000)
    with small.stream(bench) as stream, small.stream(bench) as other:
        single = {**ASK, "trigger": {**TRIGGER, "sweep": "single"}}
        stream.send(type="subscribe", panel=4, **single)
        assert captured(stream, 3, panel=4)[: len(marks)] == marks
        other.send(type="subscribe", panel=2, **{**ASK, "width": 77})
        here = captured(other, len(marks) + 3, panel=2)
        assert here[: len(marks)] == marks
        listed = small.http.get(f"/api/v1/benches/{bench}/captures").json()["triggers"]
        assert [kept["captures"] for kept in listed] == [here]
        assert listed[0] | {"captures": None, "is_short": None} == {
            "signals": sorted(NAMES), "trigger": "reference.voltage", "edge": "rising", "level": 0.0, "upper": None,
            "hysteresis": 0.1, "window_ticks": 200, "before_ticks": 50, "captures": None, "is_short": None,
        }  # fmt: skip
        # another level is another trigger, with captures of its own
        other.send(type="subscribe", panel=2, **{**ASK, "trigger": {**TRIGGER, "level": 0.5}})
        captured(other, 1, panel=2)
        assert len(small.http.get(f"/api/v1/benches/{bench}/captures").json()["triggers"]) == 2


def test_a_bench_that_goes_back_in_time_loses_the_captures_ahead_of_it(small: Any) -> None:
    bench = small.bench("first-look", paused=True)["id"]
    with small.stream(bench) as stream:
        stream.send(type="subscribe", panel=1, **ASK)
        step(small, bench, 700)
        kept = captured(stream, 3, last=450)
        snapshot = small.http.post(f"/api/v1/benches/{bench}/snapshots", json={}).json()["id"]
        step(small, bench, 700)
        assert len(captured(stream, len(kept) + 2)) > len(kept)
        answer = small.http.post(f"/api/v1/benches/{bench}/snapshots/{snapshot}/restore")
        assert answer.status_code == 200
        stream.until(lambda m: isinstance(m, dict) and m["type"] == "captures" and m["captures"] == kept)
        small.command(bench, "reset")
        stream.until(lambda m: isinstance(m, dict) and m["type"] == "captures" and m["captures"] == [])
    assert small.http.get(f"/api/v1/benches/{bench}/captures").json()["triggers"][0]["captures"] == []


def test_a_view_that_hides_a_fault_has_captures_of_its_own(live: Any) -> None:
    group = open_class(live)
    ada = join(live, group, "Ada")
    assert live.http.post(f"/api/v1/classes/{group['id']}/blind", json={}).json()["done"] == 1
    ada.bench = live.service.people.bench_of(live.service.people.by_secret(ada.secret))
    hidden = {**ASK, "signals": ["sensor.displacement"], "trigger": {**TRIGGER, "signal": "plant.displacement"}}
    shown = {**ASK, "signals": ["sensor.displacement"]}
    live.until(ada.bench, lambda status: status["tick"] > 500)
    with live.stream(ada.bench) as teacher, ada.stream() as student:
        teacher.send(type="subscribe", panel=1, **hidden)
        captured(teacher, 1)
        student.send(type="subscribe", panel=1, **hidden)
        assert student.until_type("error")["error"]["field"] == "trigger.signal"
        student.send(type="subscribe", panel=1, **{**hidden, "mode": "frozen", "start_tick": 0, "end_tick": 9})
        assert student.until_type("error")["error"]["field"] == "trigger.signal"
        assert ada.ask("GET", f"/api/v1/benches/{ada.bench}/captures").json() == {"triggers": []}
        student.send(type="subscribe", panel=1, **shown)
        captured(student, 1)
        own = ada.ask("GET", f"/api/v1/benches/{ada.bench}/captures").json()["triggers"]
        assert [kept["trigger"] for kept in own] == ["reference.voltage"]
        all_of_it = live.http.get(f"/api/v1/benches/{ada.bench}/captures").json()["triggers"]
        assert [kept["trigger"] for kept in all_of_it] == ["plant.displacement"]
    live.http.delete(f"/api/v1/classes/{group['id']}")


def test_many_subscriptions_cost_no_more_than_the_bench_has_for_captures(live: Any) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    step(live, bench, 20_000)
    session = live.service.benches.find(bench)
    names = [signal["name"] for signal in live.get(bench)["signals"]][:32]
    with live.stream(bench) as stream:
        for panel in range(25):
            trigger = {**TRIGGER, "level": 0.01 * panel}
            ask = {**ASK, "signals": names, "window_ms": 5.0, "width": 100, "trigger": trigger}
            stream.send(type="subscribe", panel=panel, **ask)
        told: dict[int, Any] = {}

        def all_told(message: Any) -> bool:
            if isinstance(message, dict) and message["type"] == "captures":
                told[message["panel"]] = message
            have = [message for message in told.values() if message["captures"]]
            return len(told) == 25 and len(have) == 16 and not any(one.waiting or one.coming for one in kept())

        def kept() -> list[Any]:
            found: list[Any] = session.captures.sets()
            return found

        while any(one.waiting or one.coming for one in kept()) or len(kept()) < 16:
            live.show()
        stream.until(all_told)
        assert 0 < sum(one.nbytes for one in kept()) <= session.captures.most_bytes
        assert all(message["is_short"] for message in told.values() if not message["captures"])
    # what captures and checkpoints may take, the history of 72 MB leaves free
    beside = 2 * session.captures.most_bytes + session.memory.track_bytes
    counts = session.board.signals.outputs, len(session.board.signals.taps)
    left = History.ticks_within(72 - beside * 1e-6, *counts)
    assert session.history.capacity == History(*counts, left).capacity
    assert left < History.ticks_within(72 - session.memory.track_bytes * 1e-6, *counts)


def test_what_no_capture_has_is_refused_in_one_line(small: Any) -> None:
    bench = small.bench("first-look", paused=True)["id"]
    step(small, bench, 9000)
    ask = {"signals": NAMES[0], "start_tick": 100, "end_tick": 200, "format": "csv"}
    answer = small.http.get(f"/api/v1/benches/{bench}/trace", params=ask)
    error = answer.json()["error"]
    assert answer.status_code == 422 and error["field"] == "start_tick" and "captures" in error["hint"]
