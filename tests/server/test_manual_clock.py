"""The clock that tests advance: device time, leases and limits pass by request, and by nothing else."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from core.errors import InputError
from server.bench.engine import PERIOD_S
from server.classroom.access import TESTING_DOORS
from server.clock import ManualClock
from server.settings import Settings, load_settings

DOOR = "/api/v1/testing/advance"
DT_S = 1e-5
"""Of the first look, at a time scale of 2 ms/s."""


def test_device_time_passes_by_request_to_the_tick(live: Any) -> None:
    bench = live.bench("first-look", time_scale=2e-3)["id"]
    begun = live.get(bench)["tick"]
    assert live.advance(seconds=1.0025)[bench] - begun == int(1.0025 * 2e-3 / DT_S)
    assert live.advance(bench=bench, ticks=1)[bench] - begun == 201
    assert live.advance(bench=bench, ticks=12_345)[bench] - begun == 12_546
    assert live.get(bench)["tick"] - begun == 12_546


def test_no_time_passes_between_requests(live: Any) -> None:
    bench = live.bench("first-look", time_scale=None)["id"]
    ticks = live.advance(seconds=4 * PERIOD_S)[bench]
    for _ in range(20):  # any of these would give a bench that runs freely time to advance
        assert live.get(bench)["tick"] == ticks
    assert live.advance(seconds=PERIOD_S)[bench] > ticks


def test_steps_need_no_time(live: Any) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    assert live.command(bench, "step", ticks=9_000).status_code == 200
    assert live.get(bench)["tick"] == 9_000


def test_a_paused_bench_stays_where_it_is(live: Any) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    assert live.advance(seconds=10.0)[bench] == 0
    refused = live.http.post(DOOR, json={"bench": bench, "ticks": 5})
    assert (refused.status_code, refused.json()["error"]["field"]) == (409, "bench")


def test_two_runs_with_the_same_requests_have_the_same_bits(live: Any) -> None:
    digests = []
    for _ in range(2):
        bench = live.bench("first-look", seed=7)["id"]
        live.advance(seconds=0.5)
        live.command(bench, inject="added_mass", severity=0.05)
        live.advance(seconds=1.5)
        live.command(bench, "pause")
        digests.append(live.http.get(f"/api/v1/benches/{bench}/digest").json())
    assert digests[0] == digests[1]


def test_a_command_limit_gains_nothing_until_time_passes(serve: Any) -> None:
    with serve(command_rate_per_s=1.0, command_burst=4) as live:
        bench = live.bench("first-look", paused=True)["id"]
        codes = [live.command(bench, "pause").status_code for _ in range(5)]
        assert codes == [200, 200, 200, 429, 429]
        live.advance(seconds=1.0)
        assert [live.command(bench, "pause").status_code for _ in range(2)] == [200, 429]


def test_an_idle_bench_is_unloaded_when_its_minutes_have_passed(serve: Any) -> None:
    with serve(idle_minutes=15.0) as live:
        bench = live.bench("first-look", paused=True)["id"]
        live.advance(seconds=14 * 60.0)
        assert [one["id"] for one in live.http.get("/api/v1/benches").json()["benches"]] == [bench]
        live.advance(seconds=70.0)
        assert live.http.get("/api/v1/benches").json()["benches"] == []


def test_the_status_has_gone_out_before_the_answer(live: Any) -> None:
    bench = live.bench("first-look")["id"]
    with live.stream(bench) as stream:
        stream.until_type("hello")
        ticks = live.advance(seconds=0.25)[bench]
        stream.until(lambda m: isinstance(m, dict) and m["type"] == "status" and m["tick"] == ticks)


def test_bad_requests_are_refused(live: Any) -> None:
    bad: list[Any] = [{}, {"seconds": 0}, {"seconds": 1, "bench": "x", "ticks": 1}, {"bench": "x"}, {"ticks": 5}]
    assert [live.http.post(DOOR, json=body).status_code for body in bad] == [422] * len(bad)


def test_the_door_is_there_only_with_the_setting(on_the_wall: Any, live: Any) -> None:
    assert on_the_wall.http.post(DOOR, json={"seconds": 1.0}).status_code == 404
    assert ("POST", DOOR) in TESTING_DOORS
    assert DOOR not in live.http.get("/api/v1/openapi.json").json()["paths"]
    with live.anonymous() as stranger:
        assert stranger.post(DOOR, json={"seconds": 1.0}, headers={"Origin": live.address}).status_code == 401


def test_the_setting_is_refused_where_others_could_reach_it() -> None:
    reachable: list[Any] = [{"host": "0.0.0.0", "token": "t" * 20}, {"classroom": True}]
    for settings in (*reachable, {"public_origin": "https://a.example"}):
        with pytest.raises(InputError, match="clock = manual is for tests"):
            load_settings(clock="manual", **settings)
        assert Settings(**settings).clock == "machine"


def test_a_loop_that_was_cancelled_holds_nothing_up() -> None:
    async def scene() -> list[str]:
        clock, done = ManualClock(), []

        async def loop(name: str, seconds: float) -> None:
            async for _ in clock.every(seconds):
                done.append(name)
                await asyncio.sleep(0)

        tasks = [asyncio.create_task(loop(*one)) for one in (("slow", 2.0), ("quick", 1.0))]
        await asyncio.sleep(0)
        await clock.advance(clock() + 1.0)
        tasks[1].cancel()
        await asyncio.gather(tasks[1], return_exceptions=True)
        await clock.advance(clock() + 1.5)
        tasks[0].cancel()
        return done

    assert asyncio.run(scene()) == ["quick", "slow"]
