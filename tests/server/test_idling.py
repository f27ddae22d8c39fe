"""Unused benches are closed, and come back unchanged; the tests hold the clock."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import pytest

from tests.server.conftest import Live


class Clock:
    """A clock that moves on command."""

    def __init__(self, live: Live) -> None:
        self.now, self._live = 0.0, live
        live.service.idling.clock = lambda: self.now

    def pass_minutes(self, minutes: float) -> set[str]:
        """Pass time and make the server check its benches; return the remaining benches."""
        self.look()
        self.now += 60.0 * minutes
        return self.look()

    def look(self) -> set[str]:
        service = self._live.service
        asyncio.run_coroutine_threadsafe(service.idling.let_go(), service._loop).result(20)
        return {session.id for session in service.benches.all()}


@pytest.fixture
def clock(live: Live) -> Iterator[Clock]:
    before = live.service.idling.clock
    yield Clock(live)
    live.service.idling.clock = before


def reopen(live: Live, bench_id: str) -> Any:
    return live.http.post(f"/api/v1/benches/{bench_id}/reopen")


def test_a_bench_that_nobody_needs_goes_and_comes_back_as_it_was(live: Live, clock: Clock) -> None:
    links = live.http.get("/api/v1/links").json()
    bench = live.bench("first-look", paused=True)["id"]
    live.command(bench, fault="added_mass", severity=0.05)
    live.command(bench, "step", ticks=500)
    before = live.get(bench)
    digest = live.http.get(f"/api/v1/benches/{bench}/digest").json()
    assert before["let_go_in_s"] == 900.0
    assert clock.pass_minutes(14.9) == {bench}
    assert live.get(bench)["tick"] == 500  # asked for: its time begins anew
    assert clock.pass_minutes(14.9) == {bench}
    assert clock.pass_minutes(0.2) == set()
    gone = live.http.get(f"/api/v1/benches/{bench}")
    assert gone.status_code == 404 and "reopen" in gone.json()["error"]["hint"]
    assert live.http.get("/api/v1/links").json() == links
    back = reopen(live, bench).json()
    for field in ("id", "tick", "state", "controller", "faults", "time_scale", "seed"):
        assert back[field] == before[field], field
    assert back["opened"]["same_bits"] and back["opened"]["link"] is None
    assert live.http.get(f"/api/v1/benches/{bench}/digest").json() == digest
    assert reopen(live, bench).json()["id"] == bench  # it is open: nothing more is done
    assert len(live.http.get("/api/v1/benches").json()["benches"]) == 1
    live.http.delete(f"/api/v1/benches/{bench}")
    assert reopen(live, bench).status_code == 404  # closed by a user: it does not come back


def test_what_is_needed_stays(live: Live, clock: Clock) -> None:
    kept = live.bench("first-look", paused=True, keep=True)
    moment = live.bench("first-look", paused=True)
    live.http.post(f"/api/v1/benches/{moment['id']}/snapshots", json={})
    recording, armed = live.bench("first-look", paused=True), live.bench("first-look", paused=True)
    live.http.post(f"/api/v1/benches/{recording['id']}/recordings", json={})
    live.http.post(f"/api/v1/benches/{armed['id']}/recordings", json={"when": "plant.displacement > 1e6"})
    coming = live.bench("first-look")
    live.command(coming["id"], fault="damping", severity=0.3, at_sample=10**9)
    watched = live.bench("first-look", paused=True)
    idle, running = live.bench("first-look", paused=True), live.bench("first-look")
    assert live.get(kept["id"])["let_go_in_s"] is None
    needed = {bench["id"] for bench in (kept, moment, recording, armed, coming, watched)}
    with live.stream(watched["id"]) as stream:
        stream.until_type("hello")
        assert clock.pass_minutes(0) == needed | {idle["id"], running["id"]}
        assert clock.pass_minutes(60) == needed
    recorded = live.http.get(f"/api/v1/benches/{recording['id']}").json()["recording"]
    live.http.post(f"/api/v1/benches/{recording['id']}/recordings/{recorded[0]}/stop")
    assert clock.pass_minutes(14) == needed
    assert clock.pass_minutes(2) == needed - {recording["id"], watched["id"]}


def test_commands_that_wait_on_a_bench_that_stands_come_back_with_it(live: Live, clock: Clock) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    live.command(bench, fault="damping", severity=0.3, at_sample=700)
    live.command(bench, switch="pid", when="plant.displacement > 1e6")
    before = live.get(bench)["pending"]
    assert clock.pass_minutes(16) == set()
    back = reopen(live, bench).json()["pending"]
    assert [(one["tick"], one["when"]) for one in back] == [(one["tick"], one["when"]) for one in before]


def test_a_replay_goes_without_a_trace_and_says_so(live: Live, clock: Clock) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    live.command(bench, "step", ticks=100)
    made = live.http.post(f"/api/v1/benches/{bench}/recordings", json={"past_ticks": 50, "ticks": 0}).json()
    replay = live.http.post(f"/api/v1/recordings/{made['id']}/replay", json={"paused": True}).json()["id"]
    assert clock.pass_minutes(16) == set()
    assert reopen(live, replay).status_code == 404
    assert reopen(live, bench).status_code == 200


def test_no_bench_goes_where_the_setting_is_0(serve: Any) -> None:
    with serve(idle_minutes=0) as live:
        clock, bench = Clock(live), live.bench("first-look", paused=True)
        assert bench["let_go_in_s"] is None and clock.pass_minutes(1e6) == {bench["id"]}


def test_a_bench_that_was_let_go_outlives_the_server_and_a_full_server_says_what_to_do(serve: Any) -> None:
    with serve(max_benches=1) as live:
        clock = Clock(live)
        bench = live.bench("first-look", paused=True)["id"]
        full = live.http.post("/api/v1/benches", json={"scenario": "first-look"})
        assert full.status_code == 409 and "use a running bench" in full.json()["error"]["hint"]
        assert "15 minutes" in full.json()["error"]["hint"]
        clock.pass_minutes(16)
        other = live.bench("first-look")["id"]
        assert reopen(live, bench).json()["error"]["code"] == "too_many_benches"
        live.http.delete(f"/api/v1/benches/{other}")
    with serve(max_benches=1) as live:
        assert reopen(live, bench).json()["id"] == bench
