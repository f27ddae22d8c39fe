"""The clock that tests advance: device time, leases and limits pass by request, and by nothing else."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from core.errors import InputError
from server.bench.engine import PERIOD_S
from server.clock import ManualClock
from server.people.access import TESTING_DOORS
from server.settings import Settings, load_settings

DOOR = "/api/v1/testing/advance"
DT_S = 1e-5
"""Of the first look, at a time scale of 2 ms/s."""


@pytest.fixture
def lab(serve: Any) -> Any:
    with serve(clock="manual") as live:
        yield live


def advance(live: Any, **how: Any) -> dict[str, Any]:
    answer = live.http.post(DOOR, json=how)
    assert answer.status_code == 200, answer.text
    return answer.json()["ticks"]


def test_device_time_passes_by_request_to_the_tick(lab: Any) -> None:
    bench = lab.bench("first-look", time_scale=2e-3)["id"]
    begun = lab.get(bench)["tick"]
    assert advance(lab, seconds=1.0025)[bench] - begun == int(1.0025 * 2e-3 / DT_S)
    assert advance(lab, bench=bench, ticks=1)[bench] - begun == 201
    assert advance(lab, bench=bench, ticks=12_345)[bench] - begun == 12_546
    assert lab.get(bench)["tick"] - begun == 12_546


def test_no_time_passes_between_requests(lab: Any) -> None:
    bench = lab.bench("first-look", time_scale=None)["id"]
    ticks = advance(lab, seconds=4 * PERIOD_S)[bench]
    for _ in range(20):  # any of these would give a bench that runs freely time to advance
        assert lab.get(bench)["tick"] == ticks
    assert advance(lab, seconds=PERIOD_S)[bench] > ticks


def test_steps_need_no_time(lab: Any) -> None:
    bench = lab.bench("first-look", paused=True)["id"]
    assert lab.command(bench, "step", ticks=9_000).status_code == 200
    assert lab.get(bench)["tick"] == 9_000


def test_a_looped_span_takes_its_time_at_every_pass(lab: Any) -> None:
    bench = lab.bench("first-look", paused=True)["id"]
    lab.command(bench, "step", ticks=1_000)
    kept = lab.http.post(f"/api/v1/benches/{bench}/recordings", json={"past_ticks": 500, "ticks": 0}).json()["id"]
    replay = lab.http.post(f"/api/v1/recordings/{kept}/replay", json={"paused": True}).json()["id"]
    lab.command(replay, "loop", start_tick=600, end_tick=800)
    lab.command(replay, "time_scale", value=200 * DT_S)  # the span takes a second
    lab.command(replay, "start")
    for _ in range(3):
        tick = advance(lab, seconds=0.5)[replay]
        assert 690 <= tick <= 710
        advance(lab, seconds=0.5 + PERIOD_S)


def test_a_paused_bench_stays_where_it_is(lab: Any) -> None:
    bench = lab.bench("first-look", paused=True)["id"]
    assert advance(lab, seconds=10.0)[bench] == 0
    refused = lab.http.post(DOOR, json={"bench": bench, "ticks": 5})
    assert (refused.status_code, refused.json()["error"]["field"]) == (409, "bench")


def test_two_runs_with_the_same_requests_have_the_same_bits(lab: Any) -> None:
    digests = []
    for _ in range(2):
        bench = lab.bench("first-look", seed=7)["id"]
        advance(lab, seconds=0.5)
        lab.command(bench, inject="added_mass", severity=0.05)
        advance(lab, seconds=1.5)
        lab.command(bench, "pause")
        digests.append(lab.http.get(f"/api/v1/benches/{bench}/digest").json())
    assert digests[0] == digests[1]


def test_a_command_limit_gains_nothing_until_time_passes(serve: Any) -> None:
    with serve(clock="manual", command_rate_per_s=1.0, command_burst=4) as live:
        bench = live.bench("first-look", paused=True)["id"]
        codes = [live.command(bench, "pause").status_code for _ in range(5)]
        assert codes == [200, 200, 200, 429, 429]
        advance(live, seconds=1.0)
        assert [live.command(bench, "pause").status_code for _ in range(2)] == [200, 429]


def test_an_idle_bench_is_unloaded_when_its_minutes_have_passed(serve: Any) -> None:
    with serve(clock="manual", idle_minutes=15.0) as live:
        bench = live.bench("first-look", paused=True)["id"]
        advance(live, seconds=14 * 60.0)
        assert [one["id"] for one in live.http.get("/api/v1/benches").json()["benches"]] == [bench]
        advance(live, seconds=70.0)
        assert live.http.get("/api/v1/benches").json()["benches"] == []


def test_the_status_has_gone_out_before_the_answer(lab: Any) -> None:
    bench = lab.bench("first-look")["id"]
    with lab.stream(bench) as stream:
        stream.until_type("hello")
        ticks = advance(lab, seconds=0.25)[bench]
        stream.until(lambda m: isinstance(m, dict) and m["type"] == "status" and m["tick"] == ticks)


@pytest.mark.parametrize(
    "body", [{}, {"seconds": 0}, {"seconds": 1, "bench": "x", "ticks": 1}, {"bench": "x"}, {"ticks": 5}]
)
def test_bad_requests_are_refused(lab: Any, body: dict[str, Any]) -> None:
    assert lab.http.post(DOOR, json=body).status_code == 422


def test_the_door_is_there_only_with_the_setting(shared: Any, lab: Any) -> None:
    assert shared.http.post(DOOR, json={"seconds": 1.0}).status_code == 404
    assert ("POST", DOOR) in TESTING_DOORS
    assert DOOR not in lab.http.get("/api/v1/openapi.json").json()["paths"]
    with lab.anonymous() as stranger:
        assert stranger.post(DOOR, json={"seconds": 1.0}, headers={"Origin": lab.address}).status_code == 401


@pytest.mark.parametrize(
    "settings", [{"host": "0.0.0.0", "token": "t" * 20}, {"classroom": True}, {"public_origin": "https://a.example"}]
)
def test_the_setting_is_refused_where_others_could_reach_it(settings: dict[str, Any]) -> None:
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
