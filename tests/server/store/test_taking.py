"""Recordings that take the past along, wait for a condition, describe themselves, and are compared and played."""

from __future__ import annotations

import io
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.server.runs.test_runs import wait

FINISHED = ("done", "failed", "aborted")


def recordings(bench: dict[str, Any]) -> str:
    return f"/api/v1/benches/{bench['id']}/recordings"


def until(condition: Callable[[], Any]) -> Any:
    """Ask until something holds; return it."""
    while not (found := condition()):
        pass
    return found


def ended(live: Any, recording_id: str) -> dict[str, Any]:
    def look() -> dict[str, Any] | None:
        found: dict[str, Any] = live.http.get(f"/api/v1/recordings/{recording_id}").json()
        return found if found["state"] in FINISHED else None

    return dict(until(look))


def table(live: Any, recording_id: str, **query: Any) -> Any:
    answer = live.http.get(f"/api/v1/recordings/{recording_id}/trace", params=query)
    assert answer.status_code == 200, answer.text
    return pq.read_table(io.BytesIO(answer.content))


def stepped(live: Any, ticks: int, scenario: str = "ch5-seven-step", **fields: Any) -> dict[str, Any]:
    """A bench that is paused at a tick."""
    bench: dict[str, Any] = live.bench(scenario, paused=True, **fields)
    assert live.command(bench["id"], "step", ticks=ticks).status_code == 200
    return bench


def test_the_last_ticks_are_kept_on_demand(live: Any) -> None:
    bench = stepped(live, 5000)
    body = {"name": "just now", "past_ticks": 1200, "ticks": 0}
    found = live.http.post(recordings(bench), json=body).json()
    assert found["state"] == "done" and (found["start_tick"], found["ticks"]) == (3800, 1200)
    query = {"signals": "plant.displacement", "start_tick": 3800, "end_tick": 5000, "format": "parquet"}
    answer = live.http.get(f"/api/v1/benches/{bench['id']}/trace", params=query)
    np.testing.assert_array_equal(
        table(live, found["id"])["plant.displacement"].to_numpy(),
        pq.read_table(io.BytesIO(answer.content))["plant.displacement"].to_numpy(),
    )
    # more than there is: all there is
    everything = live.http.post(recordings(bench), json={"past_ticks": 5_000_000, "ticks": 0}).json()
    assert (everything["start_tick"], everything["ticks"]) == (0, 5000)


def test_a_condition_starts_a_recording_with_what_was_before_it(live: Any) -> None:
    bench = stepped(live, 1000)
    body = {"past_ticks": 300, "ticks": 500, "when": "faults.added_mass > 0.01"}
    armed = live.http.post(recordings(bench), json=body).json()
    assert armed["state"] == "armed"
    status = live.get(bench["id"])
    assert status["armed"] == [armed["id"]] and status["recording"] == []
    live.command(bench["id"], "step", ticks=800)  # nothing yet: the fault comes at tick 2000
    assert live.get(bench["id"])["armed"] == [armed["id"]]
    live.command(bench["id"], "step", ticks=2000)
    found = ended(live, armed["id"])
    assert found["state"] == "done" and found["ticks"] == 800
    mass = table(live, armed["id"])["faults.added_mass"].to_numpy()
    assert mass[299] == 0.0 and mass[300] == pytest.approx(0.05)
    assert found["start_tick"] == 1700


def test_a_condition_that_never_comes_can_be_called_off(live: Any) -> None:
    bench = stepped(live, 10)
    armed = live.http.post(recordings(bench), json={"when": "plant.displacement > 1e6"}).json()
    answer = live.http.post(f"{recordings(bench)}/{armed['id']}/stop")
    assert answer.status_code == 200 and answer.json()["ticks"] == 0
    empty = live.http.post(f"/api/v1/recordings/{armed['id']}/replay", json={})
    assert empty.status_code == 409 and "empty" in empty.text
    wrong = live.http.post(recordings(bench), json={"when": "plant.displacment > 1"})
    assert wrong.status_code == 422 and "plant.displacement" in wrong.text
    empty = live.http.post(recordings(bench), json={"ticks": 0})
    assert empty.status_code == 422 and "past_ticks" in empty.text


def test_a_recording_says_all_it_takes_to_repeat_it(live: Any) -> None:
    bench = stepped(live, 700, seed=11)
    started = live.http.post(recordings(bench), json={"layout": {"panels": ["scope"]}}).json()
    live.command(bench["id"], fault="damping", severity=0.2)
    live.command(bench["id"], "step", ticks=600)
    live.http.post(f"{recordings(bench)}/{started['id']}/stop")
    found = ended(live, started["id"])
    assert found["seed"] == 11 and found["layout"] == {"panels": ["scope"]} and found["version"]
    assert found["bytes"] > 1000 and found["ticks"] == 600
    injected = next(event for event in found["events"] if event["kind"] == "inject")
    assert injected["tick"] == 700 and injected["command"]["fault"] == "damping"
    # its scenario, and the commands at their ticks, give the same trace again
    document = {**found["scenario"], "samples": 1300}
    document["events"] = [*document["events"], {"at_sample": 700, "fault": "damping", "severity": 0.2}]
    from scenarios.run import run
    from scenarios.schema import Scenario

    again = run(Scenario.load(document)).signal("plant.displacement")[700:]
    np.testing.assert_array_equal(table(live, started["id"])["plant.displacement"].to_numpy(), np.float32(again))


def test_a_recording_knows_the_faults_that_act_at_its_start_and_the_events_of_its_past(live: Any) -> None:
    bench = stepped(live, 100)
    for fault in ("damping", "stiffness", "added_mass"):
        live.command(bench["id"], fault=fault, severity=0.2)
    live.command(bench["id"], heal=["damping"])
    live.command(bench["id"], fault="stiffness", severity=0.3)
    live.command(bench["id"], "step", ticks=400)
    live.command(bench["id"], fault="drive_gain", severity=-0.1)
    live.command(bench["id"], "step", ticks=100)
    kept = live.http.post(recordings(bench), json={"past_ticks": 200, "ticks": 0}).json()
    events = ended(live, kept["id"])["events"]
    injected = [(e["tick"], e["command"]["fault"], e["command"]["severity"]) for e in events if e["kind"] == "inject"]
    assert injected == [(100, "stiffness", 0.3), (100, "added_mass", 0.2), (500, "drive_gain", -0.1)]
    assert kept["start_tick"] == 400 and not any(event["kind"] == "heal" for event in events)


def test_a_part_of_a_trace_is_downloaded(live: Any) -> None:
    bench = stepped(live, 3000)
    kept = live.http.post(recordings(bench), json={"past_ticks": 3000, "ticks": 0}).json()
    whole = table(live, kept["id"])
    part = table(live, kept["id"], signals="drive.voltage,plant.displacement", start_tick=500, end_tick=1501, every=10)
    assert part.column_names == ["tick", "time_ms", "drive.voltage", "plant.displacement"]
    assert part["tick"].to_pylist() == list(range(500, 1501, 10))
    for name in part.column_names[2:]:
        np.testing.assert_array_equal(part[name].to_numpy(), whole[name].to_numpy()[500:1501:10])
    text = live.http.get(
        f"/api/v1/recordings/{kept['id']}/trace", params={"format": "csv", "signals": "drive.voltage", "every": 1000}
    ).text
    assert text.splitlines()[0] == '"tick","time_ms","drive.voltage"' and len(text.splitlines()) == 4
    for query, word in (
        ({"signals": "drive.voltge"}, "drive.voltage"),
        ({"start_tick": 9000}, "span"),
        ({"every": 0}, "every"),
    ):
        answer = live.http.get(f"/api/v1/recordings/{kept['id']}/trace", params=query)
        assert answer.status_code == 422 and word in answer.text


def test_recordings_are_compared_signal_by_signal(live: Any) -> None:
    kept = []
    for values in ({}, {}, {"sensor.noise_um": 0.06}):
        bench = stepped(live, 2500, set=values)
        kept.append(live.http.post(recordings(bench), json={"past_ticks": 2500, "ticks": 0}).json()["id"])
    one, two, other = kept

    def compare(second: str, **fields: Any) -> dict[str, Any]:
        answer = live.http.post(f"/api/v1/recordings/{one}/compare", json={"other": second, **fields})
        assert answer.status_code == 200, answer.text
        return dict(answer.json())

    same = compare(two)
    assert same["ok"] and same["ticks"] == 2500 and all(row["max_difference"] == 0 for row in same["signals"])
    found = compare(other, absolute=1e-9)
    rows = {row["signal"]: row for row in found["signals"]}
    assert not found["ok"] and rows["plant.displacement"]["ok"] and not rows["ideal.displacement"]["ok"]
    first, second = (table(live, key)["ideal.displacement"].to_numpy().astype(float) for key in (one, other))
    difference = np.abs(first - second)
    row = rows["ideal.displacement"]
    assert row["max_difference"] == pytest.approx(difference.max()) and row["at_tick"] == difference.argmax()
    assert row["rms_difference"] == pytest.approx(np.sqrt(np.mean(difference**2)))
    wide = {name: 1e30 for name, row in rows.items() if not row["ok"]}
    assert compare(other, absolute=1e-9, tolerances=wide)["ok"]
    wrong = live.http.post(f"/api/v1/recordings/{one}/compare", json={"other": "0" * 32})
    assert wrong.status_code == 404
    wrong = live.http.post(f"/api/v1/recordings/{one}/compare", json={"other": two, "tolerances": {"nothing": 1}})
    assert wrong.status_code == 422 and "nothing" in wrong.text


def test_a_recording_is_played_on_the_streams_of_a_bench(live: Any) -> None:
    bench = stepped(live, 4000, time_scale=0.01)
    live.command(bench["id"], fault="damping", severity=0.2)
    kept = live.http.post(recordings(bench), json={"past_ticks": 3000, "ticks": 0}).json()["id"]
    answer = live.http.post(f"/api/v1/recordings/{kept}/replay", json={"speed": 10.0, "paused": True})
    assert answer.status_code == 201, answer.text
    replay = answer.json()
    assert replay["replay_of"] == kept and replay["tick"] == 1000 and replay["time_scale"] == pytest.approx(0.1)
    assert replay["recorded_scale"] == pytest.approx(0.01) and bench["recorded_scale"] is None
    assert [signal["name"] for signal in replay["signals"]] == [signal["name"] for signal in bench["signals"]]
    assert live.command(replay["id"], "start").status_code == 200
    live.until(replay["id"], lambda status: status["tick"] == 4000)
    query = {"format": "parquet", "signals": "plant.displacement,kalman.winner"}
    played = pq.read_table(io.BytesIO(live.http.get(f"/api/v1/benches/{replay['id']}/trace", params=query).content))
    whole = table(live, kept)
    assert played["tick"].to_pylist() == list(range(1000, 4000))
    for name in ("plant.displacement", "kalman.winner"):
        np.testing.assert_array_equal(played[name].to_numpy(), whole[name].to_numpy())
    # the page sees it as a bench: frames come, and the past cannot be changed
    with live.stream(replay["id"]) as stream:
        stream.until_type("hello")
    refused = live.command(replay["id"], fault="damping", severity=0.1)
    assert refused.status_code in (409, 422) and "recording" in refused.text
    assert live.http.post(f"/api/v1/benches/{replay['id']}/snapshots", json={"name": "x"}).status_code in (409, 422)


def test_a_replay_seeks_and_loops(live: Any) -> None:
    bench = stepped(live, 3000)
    kept = live.http.post(recordings(bench), json={"past_ticks": 2000, "ticks": 0}).json()["id"]
    replay = live.http.post(f"/api/v1/recordings/{kept}/replay", json={"paused": True}).json()["id"]
    assert live.command(replay, "seek", tick=2500).status_code == 200 and live.get(replay)["tick"] == 2500
    done = live.command(replay, "step", ticks=9000)
    assert done.json()["entry"]["text"] == "stepped 500 of 9000 ticks" and live.get(replay)["tick"] == 3000
    assert live.command(replay, "seek", tick=10).status_code == 422
    refused = live.command(replay, "reset", values={"seed": 3})
    assert refused.status_code == 422 and refused.json()["error"]["field"] == "values"
    assert refused.json()["error"]["code"] == "conflict" and live.get(replay)["tick"] == 3000
    assert live.command(replay, "reset").status_code == 200 and live.get(replay)["tick"] == 1000
    assert live.command(replay, "loop", start_tick=2000, end_tick=2050).status_code == 422
    assert live.command(replay, "loop", start_tick=2000, end_tick=2200).status_code == 200
    live.command(replay, "time_scale", value=0.1)  # 200 ticks of 20 us are played in 40 ms
    live.command(replay, "start")
    seen: list[int] = []
    for _ in range(12):
        live.advance(seconds=0.01)
        seen.append(live.get(replay)["tick"])
    assert sum(later < earlier for earlier, later in pairwise(seen)) == 2
    assert live.get(replay)["state"] == "running" and all(2000 <= tick < 2200 for tick in seen)
    # a span that begins anew keeps its pace: a step of 10 ms plays 50 ticks, less the excess at the turn
    assert all(0 <= (later - earlier) % 200 <= 52 for earlier, later in pairwise(seen))
    live.command(replay, "loop")
    live.until(replay, lambda status: status["tick"] == 3000 and status["state"] == "paused")
    # a loop requested at the end plays on; a loop requested during a pause waits
    live.command(replay, "loop", start_tick=2000, end_tick=2200)
    live.until(replay, lambda status: status["state"] == "running" and 2000 <= status["tick"] <= 2200)
    live.command(replay, "pause")
    live.command(replay, "loop", start_tick=1500, end_tick=1700)
    assert live.get(replay)["state"] == "paused" and live.get(replay)["tick"] == 1500
    assert live.command(bench["id"], "seek", tick=0).status_code in (409, 422)


def test_a_live_bench_is_saved_and_graded_headless_to_the_same_bits(live: Any) -> None:
    bench = stepped(live, 1500)
    live.command(bench["id"], fault="stiffness", severity=0.05)
    live.command(bench["id"], switch="pid")
    live.command(bench["id"], "step", ticks=2000)
    seen = live.http.get(f"/api/v1/benches/{bench['id']}/digest").json()
    text = live.http.get(f"/api/v1/benches/{bench['id']}/scenario").text
    run = live.http.post("/api/v1/runs", json={"scenario": text}).json()
    found = wait(live, run["id"])
    assert seen["tick"] == found["summary"]["ticks"] == 3500
    assert found["summary"]["digest"] == seen["digest"]
    assert [entry["metric"] for entry in found["summary"]["expectations"]]  # graded by the expectations of the scenario


def test_a_recording_is_deleted_once_it_has_ended(live: Any) -> None:
    bench = stepped(live, 100)
    started = live.http.post(recordings(bench)).json()["id"]
    assert live.http.delete(f"/api/v1/recordings/{started}").status_code == 409
    live.command(bench["id"], "step", ticks=10)
    live.http.post(f"{recordings(bench)}/{started}/stop")
    path = live.service.recordings.path(started)
    assert path.exists() and live.http.delete(f"/api/v1/recordings/{started}").status_code == 204
    assert not path.exists() and live.http.get(f"/api/v1/recordings/{started}").status_code == 404


def test_tables_of_recordings_with_gaps_and_nothing_in_common(tmp_path: Any) -> None:
    from core.errors import InputError
    from server.store.compare import compare

    def write(name: str, ticks: list[int], **columns: list[float]) -> Any:
        path = tmp_path / f"{name}.parquet"
        times = [0.01 * tick for tick in ticks]
        arrays = {name: pa.array(values, pa.float32()) for name, values in columns.items()}
        pq.write_table(pa.table({"tick": ticks, "time_ms": times, **arrays}), path)
        return path

    one = write("one", [5, 6, 7], a=[1.0, 2.0, float("nan")], b=[0, 0, 0])
    two = write("two", [6, 7, 8], a=[2.5, float("nan"), 9.0])
    found = compare(one, two, 0.5, 0.0, {}, by_start=False)
    assert found.ok and found.ticks == 2 and found.only_in_first == ["b"] and found.signals[0].at_tick == 6
    assert not compare(one, two, 0.499, 0.0, {}, by_start=False).ok
    shifted = compare(one, two, 0.0, 0.0, {}, by_start=True).signals[0]
    assert not shifted.ok and shifted.at_tick == 6  # a number beside none is as wrong as can be
    with pytest.raises(InputError, match="in common"):
        compare(one, write("three", [100], a=[0.0]), 0.0, 0.0, {}, by_start=False)
