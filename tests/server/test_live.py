"""Live benches: exact bits with any watchers, true pacing, commands at tick edges."""

from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from itertools import product
from typing import Any

import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario


def until_it_stands(live: Any, bench_id: str) -> dict[str, Any]:
    """Let time pass until a bench no longer runs."""
    live.until(bench_id, lambda status: status["state"] != "running")
    found: dict[str, Any] = live.get(bench_id)
    return found


def test_live_with_watchers_and_headless_give_the_same_bits(live: Any) -> None:
    """Three watchers, one that stalls, a snapshot in the middle: the digest equals the digest of the headless run."""
    expected = run(get("ch5-seven-step"))
    bench = live.bench(time_scale=0.1, paused=True)
    key, names = bench["id"], [signal["name"] for signal in bench["signals"]][:12]
    with ExitStack() as stack:
        watchers = [stack.enter_context(live.stream(key)) for _ in range(4)]
        watchers[3].acks = False
        for stream, panel in product(watchers, range(6)):
            stream.send(type="subscribe", panel=panel, signals=names, window_ms=4.0, width=800)

        def play(until: int) -> None:
            live.command(key, "start")
            while live.get(key)["tick"] < until:
                live.advance(seconds=0.2)
                for stream in watchers:
                    stream.settle()

        play(3000)
        snapshot = live.http.post(f"/api/v1/benches/{key}/snapshots").json()
        play(9000)
        assert live.get(key)["tick"] == 9000
        first = live.http.get(f"/api/v1/benches/{key}/digest").json()
        restored = live.http.post(f"/api/v1/benches/{key}/snapshots/{snapshot['id']}/restore").json()
        assert restored["tick"] == snapshot["tick"] >= 3000 and restored["state"] == "paused"
        play(9000)
        second = live.http.get(f"/api/v1/benches/{key}/digest").json()
        assert len(watchers[0].frames) > 2 == len(watchers[3].frames)
    assert first == second == {"tick": 9000, "digest": expected.digest}


def test_what_happened_live_is_saved_and_run_headless_with_the_same_bits(live: Any) -> None:
    bench = live.bench(set={"events": []}, time_scale=0.05)
    for command in (
        {"fault": "added_mass", "severity": 0.05},
        {"switch": "mrac"},
        {"set": {"reference.amplitude_v": 8.0, "sensor.noise_um": 0.1}},
        {"heal": "all"},
        {"kind": "pause"},
    ):
        live.advance(seconds=0.1)
        assert live.command(bench["id"], **command).status_code == 200
    answer = live.http.get(f"/api/v1/benches/{bench['id']}/scenario")
    assert answer.headers["content-type"].startswith("text/plain")
    digest = live.http.get(f"/api/v1/benches/{bench['id']}/digest").json()
    told = f"# {digest['tick']} ticks, digest {digest['digest']}"
    assert answer.text.split("\n")[:2] == ["#:schema ./scenario.schema.json", told]
    result = run(Scenario.load(answer.text))
    assert (result.board.tick, result.digest) == (digest["tick"], digest["digest"])


def test_two_forks_meet_the_same_noise(live: Any) -> None:
    bench = live.bench(time_scale=0.05)
    live.advance(seconds=0.3)
    forks = []
    snapshot = live.http.post(f"/api/v1/benches/{bench['id']}/snapshots").json()["id"]
    for _ in range(2):
        fork = live.http.post(f"/api/v1/benches/{bench['id']}/fork", json={"snapshot": snapshot}).json()
        forks.append(fork)
        live.command(fork["id"], "pause")
    ends = []
    for fork in forks:
        tick = live.get(fork["id"])["tick"]
        if tick < 8000:
            live.command(fork["id"], "step", ticks=8000 - tick)
        ends.append(live.http.get(f"/api/v1/benches/{fork['id']}/digest").json())
    assert ends[0] == ends[1]
    assert ends[0]["digest"] == run(with_values(get("ch5-seven-step"), {"samples": 8000})).digest


@pytest.mark.long
@pytest.mark.parametrize("scale", [1e-4, 0.002, 0.05, 1.0])
def test_time_runs_at_its_scale(on_the_wall: Any, scale: float) -> None:
    live = on_the_wall
    bench = live.bench(set={"samples": 10_000_000, "events": [], "sample_rate_khz": 100}, time_scale=scale)
    with live.stream(bench["id"]) as stream:
        first = stream.until_type("status")
        began = time.perf_counter()
        status = first
        while time.perf_counter() - began < 2.5:
            status = stream.until_type("status")
        device_s = (status["tick"] - first["tick"]) * bench["dt_ms"] * 1e-3
        wall_s = time.perf_counter() - began
        # On a busy machine time may be dropped, but then it is counted: nothing is slow without notice.
        given_up_s = (status["given_up_ms"] - first["given_up_ms"]) * 1e-3
        assert device_s / scale + given_up_s == pytest.approx(wall_s, rel=0.12)
        if given_up_s == 0.0:
            assert status["achieved_scale"] == pytest.approx(scale, rel=0.05)
            assert not status["capped"]


def test_as_fast_as_possible_outruns_a_pace_and_still_takes_commands(on_the_wall: Any) -> None:
    live = on_the_wall
    bench = live.bench(set={"samples": 100_000_000, "events": []}, time_scale=None)
    live.until(bench["id"], lambda status: status["achieved_scale"] > 10 * 0.002)
    assert live.command(bench["id"], fault="added_mass", severity=0.05).status_code == 200
    assert not live.get(bench["id"])["capped"]
    live.command(bench["id"], "time_scale", value=0.002)
    live.until(bench["id"], lambda status: status["achieved_scale"] == pytest.approx(0.002, rel=0.1))
    after = live.get(bench["id"])
    assert after["time_scale"] == 0.002 and after["state"] == "running"


def test_a_paused_bench_stands_still_and_steps_exactly(live: Any) -> None:
    bench = live.bench(paused=True)
    assert live.get(bench["id"])["tick"] == 0
    assert live.command(bench["id"], "step").json()["tick"] == 0
    assert live.get(bench["id"])["tick"] == 1
    live.command(bench["id"], "step_period")
    assert live.get(bench["id"])["tick"] == 26
    assert live.advance(seconds=1.0)[bench["id"]] == 26


SLOW = {"reference": {"kind": "sine", "amplitude_v": 5.0, "frequency_hz": 1.0}}
"""A planar plant at 100 kHz: one period of the drive takes a second or two."""


def test_a_long_step_holds_up_no_other_bench(live: Any) -> None:
    other = live.bench("first-look", time_scale=0.002)
    bench = live.bench("ch3-case3-adhesion", set=SLOW, paused=True)
    with ThreadPoolExecutor(1) as pool:
        asked = pool.submit(live.command, bench["id"], "step_period")
        live.wait(lambda: live.get(bench["id"])["tick"])
        for severity in (0.01, 0.02, 0.03):
            assert live.command(other["id"], fault="added_mass", severity=severity).status_code == 200
        assert not asked.done()
        assert live.get(bench["id"])["state"] == "running"
        entry = asked.result(60).json()["entry"]
    assert (entry["tick"], entry["text"]) == (0, "stepped 100000 ticks")
    after = live.get(bench["id"])
    assert (after["tick"], after["state"]) == (100_000, "paused")


def test_the_page_that_steps_can_pause_the_step(live: Any) -> None:
    bench = live.bench("ch3-case3-adhesion", set=SLOW, paused=True)
    with live.stream(bench["id"]) as stream:
        stream.send(type="command", id="a", command={"kind": "step_period"})
        stream.send(type="command", id="b", command={"kind": "pause"})
        replies = [stream.until_type("reply"), stream.until_type("reply")]
        assert {(reply["id"], reply["ok"]) for reply in replies} == {("a", True), ("b", True)}
        event = stream.until_event(kind="pause")
    assert event["tick"] < 100_000
    said = live.http.get(f"/api/v1/benches/{bench['id']}/events").json()["events"]
    assert said[-2]["text"] == f"stepped {event['tick']} of 100000 ticks"
    live.advance(seconds=0.5)
    after = live.get(bench["id"])
    assert (after["tick"], after["state"]) == (event["tick"], "paused")


def test_a_trip_stops_one_bench_and_says_why(live: Any) -> None:
    other = live.bench()
    bench = live.bench(set={"events": [], "guard": {"travel_um": 0.5}}, time_scale=0.05)
    stopped = until_it_stands(live, bench["id"])
    assert stopped["state"] == "tripped"
    assert "travel" in stopped["trip"]["reason"]
    refused = live.command(bench["id"], "start")
    assert refused.status_code == 422 and refused.json()["error"]["code"] == "tripped"
    kinds = [e["kind"] for e in live.http.get(f"/api/v1/benches/{bench['id']}/events").json()["events"]]
    assert "tripped" in kinds
    trace = live.http.get(f"/api/v1/benches/{bench['id']}/trace", params={"columns": 10})
    assert trace.status_code == 200
    live.command(bench["id"], set={"guard.travel_um": 25.0})
    assert live.command(bench["id"], reset_trip=True).status_code == 200
    assert live.command(bench["id"], "start").status_code == 200
    assert live.get(bench["id"])["state"] == "running"
    assert live.get(other["id"])["state"] == "running"


def test_a_reset_begins_the_scenario_again(live: Any) -> None:
    bench = live.bench(time_scale=0.05)
    live.advance(seconds=0.2)
    entry = live.command(bench["id"], "reset", values={"sensor.noise_um": 0.2}).json()["entry"]
    assert entry["tick"] == 0 and entry["kind"] == "reset"
    assert "0.2" in live.http.get(f"/api/v1/benches/{bench['id']}/scenario").text
    until_it_stands(live, bench["id"])
    expected = run(with_values(get("ch5-seven-step"), {"sensor.noise_um": 0.2}))
    assert live.http.get(f"/api/v1/benches/{bench['id']}/digest").json()["digest"] == expected.digest
