"""The past of a live bench: shown again at any tick, gone on from, the bits of a straight run."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run
from scenarios.schema import Scenario

FAR = 30_000
ENDLESS = {"samples": 100_000_000}


def forward(live: Any, bench_id: str, tick: int) -> None:
    while (now := live.get(bench_id)["tick"]) < tick:
        answer = live.command(bench_id, "step", ticks=min(10_000, tick - now))
        assert answer.status_code == 200, answer.text


def fork(live: Any, bench_id: str, **fields: Any) -> Any:
    return live.http.post(f"/api/v1/benches/{bench_id}/fork", json=fields)


def digest(live: Any, bench_id: str) -> Any:
    return live.http.get(f"/api/v1/benches/{bench_id}/digest").json()["digest"]


def trace(live: Any, bench_id: str, start: int, end: int) -> dict[str, Any]:
    asked = {"format": "parquet", "start_tick": start, "end_tick": end}
    answer = live.http.get(f"/api/v1/benches/{bench_id}/trace", params=asked)
    assert answer.status_code == 200, answer.text
    table = pq.read_table(io.BytesIO(answer.content))
    return {name: table.column(name).to_numpy() for name in table.column_names}


@pytest.fixture
def ran(live: Any) -> Any:
    """A bench that has run for long, with a fault and another controller on the way."""
    bench = live.bench("ch5-seven-step", set=ENDLESS, paused=True)["id"]
    forward(live, bench, 9_500)
    assert live.command(bench, switch="pid").status_code == 200
    assert live.command(bench, fault="drive_gain", severity=0.02).status_code == 200
    forward(live, bench, FAR)
    return bench


def test_a_branch_far_back_is_a_straight_run(live: Any, ran: str) -> None:
    made = fork(live, ran, tick=FAR - 20_000, window_ticks=5000).json()
    assert made["origin"] == {"bench": ran, "tick": FAR - 20_000, "window_ticks": 5000, "is_past": True}
    assert (made["state"], made["tick"], made["controller"]) == ("paused", FAR - 20_000, "pid")
    forward(live, made["id"], FAR)
    assert digest(live, made["id"]) == digest(live, ran)
    mine, theirs = (trace(live, one, FAR - 12_000, FAR) for one in (made["id"], ran))
    assert len(mine["tick"]) == 12_000
    for name, values in theirs.items():
        np.testing.assert_array_equal(values, mine[name], name)
    document = live.http.get(f"/api/v1/benches/{made['id']}/scenario").text
    assert run(Scenario.load(document)).digest == digest(live, ran)


def test_the_past_before_the_history_is_computed_again(serve: Any) -> None:
    with serve(history_ticks=5000) as live:
        bench = live.bench("ch5-seven-step", set=ENDLESS, paused=True)["id"]
        forward(live, bench, 30_000)
        assert live.get(bench)["first_tick"] > 20_000
        made = fork(live, bench, tick=12_000, window_ticks=3000, paused=True).json()["id"]
        straight = build(with_values(get("ch5-seven-step"), {**ENDLESS, "expect": []}))
        rows = []
        while straight.tick < 12_000:
            part = straight.advance(12_000 - straight.tick)
            rows.append(np.hstack([part.outputs, part.taps]))
        names = straight.signals.names
        expected = np.vstack(rows)[9_000:].astype(np.float32)
        shown = trace(live, made, 9_000, 12_000)
        for at, name in enumerate(names):
            np.testing.assert_array_equal(shown[name].astype(np.float32), expected[:, at], name)
        assert digest(live, made) == straight.digest()


def test_seeking_shows_other_ticks_until_the_bench_goes_on(live: Any, ran: str) -> None:
    made = fork(live, ran, tick=20_000, paused=True).json()["id"]
    for tick, controller in ((3_000, "open_loop"), (9_500, "pid"), (FAR, "pid"), (9_499, "open_loop")):
        assert live.command(made, "seek", tick=tick).json()["tick"] == tick
        shown = live.get(made)
        assert (shown["tick"], shown["controller"], shown["origin"]["is_past"]) == (tick, controller, True)
    assert digest(live, made) != digest(live, ran)
    live.command(made, fault="stiffness", severity=0.1)
    assert live.get(made)["origin"] == {"bench": ran, "tick": 9_499, "window_ticks": 20_000, "is_past": False}
    refused = live.command(made, "seek", tick=10)
    assert refused.json()["error"]["code"] == "conflict" and "gone on" in refused.json()["error"]["message"]
    again = fork(live, made, tick=4_000, paused=True).json()
    assert (again["tick"], again["controller"]) == (4_000, "open_loop")


def test_a_fork_before_what_was_done_at_a_tick_is_without_it(live: Any, ran: str) -> None:
    with_it, without = (fork(live, ran, tick=9_500, before=before, paused=True).json() for before in (False, True))
    assert [fault["name"] for fault in with_it["faults"] if fault["name"] == "drive_gain"] == ["drive_gain"]
    assert "drive_gain" not in [fault["name"] for fault in without["faults"]]
    assert without["controller"] == "open_loop"
    for bench, kinds in ((with_it, {"switch", "inject"}), (without, set())):
        events = live.http.get(f"/api/v1/benches/{bench['id']}/events").json()["events"]
        led = next(one["new"] for one in events if one["kind"] == "restored")
        at = {one["kind"] for one in events if one["tick"] == 9_500 and one["seq"] <= led}
        assert at & {"switch", "inject"} == kinds
    forward(live, without["id"], 12_000)
    straight = run(with_values(get("ch5-seven-step"), {"samples": 12_000, "expect": []}))
    assert digest(live, without["id"]) == straight.digest


def test_the_log_of_the_past_ends_at_its_tick(live: Any, ran: str) -> None:
    made = fork(live, ran, tick=5_000, paused=True).json()["id"]
    live.command(made, "seek", tick=9_500)
    events = live.http.get(f"/api/v1/benches/{made}/events").json()["events"]
    restored = [event for event in events if event["kind"] == "restored"]
    assert [event["tick"] for event in restored] == [5_000, 9_500]
    shown = [event for event in events if event["seq"] <= restored[-1]["new"]]
    assert {"switch", "inject"} <= {event["kind"] for event in shown if event["tick"] == 9_500}
    assert max(event["tick"] for event in shown) == 9_500


def test_a_bench_that_tripped_is_forked_from_before(live: Any) -> None:
    bench = live.bench("ch5-seven-step", set=ENDLESS, paused=True)["id"]
    forward(live, bench, 3000)
    assert live.command(bench, set={"guard.travel_um": 0.01}).status_code == 200
    live.command(bench, "step", ticks=5000)
    live.until(bench, lambda status: status["state"] == "tripped")
    tick = live.get(bench)["trip"]["tick"]
    made = fork(live, bench, tick=tick - 1, paused=True).json()
    assert (made["state"], made["trip"], made["tick"]) == ("paused", None, tick - 1)
    live.command(made["id"], "step", ticks=1000)
    assert live.get(made["id"])["trip"]["tick"] == tick


def test_ticks_that_are_not_there_are_refused_in_one_line(live: Any, ran: str) -> None:
    for fields, field in (
        ({"tick": FAR + 1}, "tick"),
        ({"tick": -1}, "tick"),
        ({"tick": 5, "window_ticks": -1}, "window_ticks"),
        ({"before": True}, ""),
        ({"tick": 5, "snapshot": "x"}, ""),
    ):
        answer = fork(live, ran, **fields)
        assert answer.status_code == 422, (fields, answer.text)
        assert answer.json()["error"]["field"] == field
    assert len(live.http.get("/api/v1/benches").json()["benches"]) == 1


def test_the_past_of_a_bench_that_runs_is_shown_while_it_runs(live: Any) -> None:
    bench = live.bench("first-look", time_scale=0.5)["id"]
    live.until(bench, lambda status: status["tick"] > 3_000)
    made = fork(live, bench, tick=2_000, paused=True).json()["id"]
    ticks = live.advance(seconds=0.2)
    assert ticks[made] == 2_000
    assert ticks[bench] > 13_000 and live.get(bench)["state"] == "running"


def test_a_branch_has_been_told_and_tells_what_a_straight_run_tells(live: Any, ran: str) -> None:
    def told(bench: str) -> list[dict[str, Any]]:
        answer: list[dict[str, Any]] = live.http.get(f"/api/v1/benches/{bench}/narration").json()["sentences"]
        return answer

    whole = told(ran)
    assert {"fault", "switch", "verdict"} <= {one["kind"] for one in whole}
    places = [one["tick"] + delta for one in whole for delta in (-1, 0, 1)]
    made = fork(live, ran, tick=9_500, window_ticks=700, paused=True).json()["id"]
    for tick in sorted(set(places)):
        live.command(made, "seek", tick=tick)
        assert [one for one in told(made) if one["tick"] < tick] == [one for one in whole if one["tick"] < tick]
        assert all(one in whole for one in told(made))
    for tick in (9_500, 20_001):
        branch = fork(live, ran, tick=tick, paused=True).json()["id"]
        forward(live, branch, FAR)
        assert told(branch) == whole


def test_a_branch_has_a_name(live: Any, ran: str) -> None:
    made = fork(live, ran, tick=9_000, paused=True, name="with PID").json()
    assert (made["name"], made["title"]) == ("with PID", live.get(ran)["title"])
    path = f"/api/v1/benches/{made['id']}"
    assert live.http.patch(path, json={"name": "with PID, from 180 ms"}).json()["name"] == "with PID, from 180 ms"
    refused = live.http.patch(path, json={"name": "x" * 81})
    assert refused.status_code == 422 and refused.json()["error"]["field"] == "name"
    assert live.get(made["id"])["name"] == "with PID, from 180 ms" and live.get(ran)["name"] == ""


@pytest.mark.parametrize("back", [0, 60])
def test_a_moment_comes_again_with_another_diagnoser(live: Any, back: int) -> None:
    bench = live.bench("ch5-seven-step", set=ENDLESS, paused=True)["id"]
    live.command(bench, switch="pid")
    forward(live, bench, 300)
    live.command(bench, fault="added_mass", severity=0.07)
    forward(live, bench, 500)
    of = fork(live, bench, tick=500 - back, paused=True).json()["id"] if back else bench
    other = {"kind": "imm", "hypotheses": [{"name": "healthy"}, {"name": "m+7", "mass": 1.07}]}
    answer = live.http.post(f"/api/v1/benches/{of}/variant", json={"set": {"diagnosers.imm": other}, "repeat": True})
    assert answer.status_code == 201, answer.text
    made = answer.json()
    assert (made["tick"], made["state"], made["controller"]) == (500 - back, "paused", "pid")
    assert [fault["name"] for fault in made["faults"]] == ["added_mass"]
    mine, theirs = (trace(live, one, 0, 500 - back) for one in (made["id"], of))
    assert set(mine) - set(theirs) >= {"imm.winner"}
    for name in set(mine) & set(theirs):
        np.testing.assert_array_equal(mine[name], theirs[name], name)

    document = {**get("ch5-seven-step").document, "diagnosers": {"imm": other}, "samples": 500 - back}
    done = [{"at_sample": 0, "switch": "pid"}, {"at_sample": 300, "fault": "added_mass", "severity": 0.07}]
    straight = build(Scenario.load({**document, "events": done, "expect": []}))
    rows = straight.advance(500 - back)
    assert rows.count == 500 - back
    winner = np.hstack([rows.outputs, rows.taps])[:, straight.signals.names.index("imm.winner")]
    assert len(set(winner)) == 2
    np.testing.assert_array_equal(winner.astype(np.float32), mine["imm.winner"])


def test_a_moment_that_does_not_fit_other_values_is_refused_in_one_line(live: Any, serve: Any) -> None:
    bench = live.bench("ch5-seven-step", set=ENDLESS, paused=True)["id"]
    live.command(bench, set={"diagnosers.kalman.probability_floor": 1e-2})
    there = len(live.http.get("/api/v1/benches").json()["benches"])
    for values, field in (
        ({"diagnosers.kalman.kind": "none"}, "diagnosers.kalman.kind"),
        ({"diagnosers": {}}, "diagnosers.kalman"),
    ):
        answer = live.http.post(f"/api/v1/benches/{bench}/variant", json={"set": values, "repeat": True})
        assert answer.status_code == 422, answer.text
        assert field in answer.json()["error"]["field"] and "\n" not in answer.json()["error"]["message"]
    assert len(live.http.get("/api/v1/benches").json()["benches"]) == there
    with serve(max_run_ticks=100) as small:
        bench = small.bench("ch5-seven-step", set=ENDLESS, paused=True)["id"]
        forward(small, bench, 101)
        answer = small.http.post(f"/api/v1/benches/{bench}/variant", json={"repeat": True})
        assert (answer.status_code, answer.json()["error"]["code"]) == (409, "too_long")
