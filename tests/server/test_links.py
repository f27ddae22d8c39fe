"""A link is the experiment: the same bits again, for any user at any time."""

from __future__ import annotations

import asyncio
from typing import Any

from sqlalchemy import update

from server.store.experiment import THIS_VERSION
from server.store.links import ID_LENGTH
from server.store.models import LinkRow
from tests.lab import RICH, STORY

LAYOUT = {"grid": {"root": {"data": []}}, "panels": {"motion": {"params": {"cursors": [0.2, 0.6]}}}}


def worked_on(live: Any, ticks: int = 150, **fields: Any) -> dict[str, Any]:
    """Return a paused bench after a long story, some of it still to come."""
    later = {"fault": "drive_gain", "severity": -0.2, "at_sample": 400}
    bench: dict[str, Any] = live.bench({**RICH, "schema": 1, "id": "story", "events": [*STORY, later]}, **fields)
    live.command(bench["id"], "step", ticks=ticks)
    assert live.command(bench["id"], fault="added_mass", severity=0.03).status_code == 200
    live.command(bench["id"], "step", ticks=20)
    assert live.command(bench["id"], switch="mrac").status_code == 200  # at the very tick it is left at
    return bench


def digest(live: Any, bench_id: str) -> tuple[int, str]:
    found = live.http.get(f"/api/v1/benches/{bench_id}/digest").json()
    return found["tick"], found["digest"]


def share(live: Any, **body: Any) -> dict[str, Any]:
    answer = live.http.post("/api/v1/links", json=body)
    assert answer.status_code == 201, answer.text
    return dict(answer.json())


def opened(live: Any, link: str) -> dict[str, Any]:
    answer = live.http.post(f"/api/v1/links/{link}/open")
    assert answer.status_code == 201, answer.text
    return dict(answer.json())


def test_it_opens_a_fresh_bench_with_the_same_bits_that_goes_on_alike(live: Any) -> None:
    bench = worked_on(live, paused=True, seed=9)
    link = share(live, bench=bench["id"], note="see the gains", layout=LAYOUT)
    assert len(link["id"]) == ID_LENGTH and link["content"]["layout"] == LAYOUT
    then = digest(live, bench["id"])
    assert (link["tick"], link["digest"]) == then and then[0] == 170
    again = opened(live, link["id"])
    assert again["id"] != bench["id"] and again["state"] == "paused"
    assert digest(live, again["id"]) == then
    assert again["opened"] == {
        "link": link["id"],
        "note": "see the gains",
        "version": THIS_VERSION,
        "version_now": THIS_VERSION,
        "same_bits": True,
    }
    before = live.get(bench["id"])
    for field in ("controller", "seed", "time_scale", "faults", "parameters", "title"):
        assert again[field] == before[field], field
    assert [entry["tick"] for entry in again["pending"]] == [entry["tick"] for entry in before["pending"]] == [400]
    for key in (bench["id"], again["id"]):
        live.command(key, "step", ticks=300)
    assert digest(live, again["id"]) == digest(live, bench["id"]) != then


def test_it_has_the_same_log_and_the_last_of_the_traces(live: Any) -> None:
    bench = worked_on(live, paused=True)
    again = opened(live, share(live, bench=bench["id"])["id"])

    def deeds(key: str) -> list[tuple[Any, ...]]:
        events = live.http.get(f"/api/v1/benches/{key}/events").json()["events"]
        return [(e["tick"], e["kind"], e["text"]) for e in events if e["command"] and "kind" not in e["command"]]

    done = [deed for deed in deeds(bench["id"]) if deed[1] != "scheduled"]
    assert [deed for deed in deeds(again["id"]) if deed[1] != "scheduled"] == done and len(done) > 8
    signals = {"signals": "plant.displacement,drive.voltage", "start_tick": 0, "end_tick": 170, "columns": 170}
    traces = [
        live.http.get(f"/api/v1/benches/{key}/trace", params=signals).json() for key in (bench["id"], again["id"])
    ]
    assert traces[0] == traces[1]


def test_its_reset_is_that_of_the_scenario_and_a_running_bench_runs_on(live: Any) -> None:
    bench = live.bench("first-look")
    live.command(bench["id"], fault="added_mass", severity=0.05)
    again = opened(live, share(live, bench=bench["id"])["id"])
    assert again["state"] == "running" and [fault["name"] for fault in again["faults"]] == ["added_mass"]
    live.command(again["id"], "pause")
    live.command(again["id"], "reset")
    live.command(again["id"], "step", ticks=50)
    assert live.get(again["id"])["faults"] == []


def test_a_bench_of_axes_with_twins_and_one_that_has_tripped_come_back(live: Any) -> None:
    gyroscope = live.bench("gyro-diagnosis", paused=True, set={"twins": {"b": {"controller": {"kind": "whole_angle"}}}})
    live.command(gyroscope["id"], "step", ticks=500)
    tripped = live.bench("first-look", paused=True)
    live.command(tripped["id"], set={"guard.travel_um": 0.01})
    live.command(tripped["id"], "step", ticks=5000)
    assert live.get(tripped["id"])["state"] == "tripped"
    for bench in (gyroscope, tripped):
        again = opened(live, share(live, bench=bench["id"])["id"])
        assert again["opened"]["same_bits"] and digest(live, again["id"]) == digest(live, bench["id"])
        assert again["state"] == live.get(bench["id"])["state"]


def test_it_says_so_when_today_gives_other_bits(live: Any) -> None:
    bench = worked_on(live, paused=True)
    link = share(live, bench=bench["id"])

    async def age() -> None:
        content = {**link["content"], "experiment": {**link["content"]["experiment"], "version": "0.0.9 abc"}}
        content["experiment"]["digest"] = "0" * 64
        statement = update(LinkRow).where(LinkRow.id == link["id"]).values(content=content)
        await live.service.database.run(lambda session: session.execute(statement))

    asyncio.run_coroutine_threadsafe(age(), live.service._loop).result(10)
    again = opened(live, link["id"])["opened"]
    assert again["same_bits"] is False
    assert (again["version"], again["version_now"]) == ("0.0.9 abc", THIS_VERSION)


def test_a_scenario_and_a_layout_are_kept_too_listed_renamed_and_deleted(live: Any) -> None:
    kept = share(live, scenario="ch5-seven-step", title="Mine")
    layout = share(live, layout=LAYOUT, title="Two scopes")
    assert (kept["kind"], kept["tick"], layout["kind"], layout["tick"]) == ("experiment", 0, "layout", None)
    assert opened(live, kept["id"])["scenario_id"] == "ch5-seven-step"
    assert "layout" in live.http.post(f"/api/v1/links/{layout['id']}/open").json()["error"]["message"]
    listed = live.http.get("/api/v1/links", params={"kind": "experiment"}).json()["links"]
    assert kept["id"] in [one["id"] for one in listed] and "content" not in listed[0]
    changed = live.http.patch(f"/api/v1/links/{kept['id']}", json={"title": "Ours"}).json()
    assert (changed["title"], changed["content"]) == ("Ours", kept["content"])
    for one in (kept, layout):
        assert live.http.delete(f"/api/v1/links/{one['id']}").status_code == 204
        assert live.http.get(f"/api/v1/links/{one['id']}").status_code == 404


def test_bad_wishes_get_one_line_and_nothing_is_kept(live: Any) -> None:
    before = live.http.get("/api/v1/links").json()
    for body, status, words in (
        ({}, 422, "needs a bench"),
        ({"bench": "x", "scenario": "first-look"}, 422, "not both"),
        ({"bench": "nobody"}, 404, "no bench 'nobody'"),
        ({"scenario": "no-such"}, 422, "no-such"),
        ({"scenario": "sample_rate_khz = -1\n"}, 422, "sample_rate_khz"),
        ({"scenario": "first-look", "note": "x" * 2001}, 422, "2000"),
        ({"layout": {"a": "x" * 200_001}}, 422, "at most 200000"),
    ):
        answer = live.http.post("/api/v1/links", json=body)
        said = answer.json()["error"]
        assert answer.status_code == status and words in said["message"] + said["field"], said
        assert live.http.get("/api/v1/links").json() == before
    for bad in ("nothere1", "x" * 3000, "%00", "..%2f..%2f", "é"):
        for method, path in (("GET", ""), ("POST", "/open"), ("DELETE", "")):
            answer = live.http.request(method, f"/api/v1/links/{bad}{path}")
            assert answer.status_code in (404, 405), answer.text
            assert "\n" not in answer.json()["error"]["message"]


def test_there_are_limits(serve: Any) -> None:
    with serve(max_links=1, max_run_ticks=100) as live:
        bench = worked_on(live, paused=True)
        link = share(live, bench=bench["id"])
        full = live.http.post("/api/v1/links", json={"bench": bench["id"]})
        assert full.status_code == 409 and "max_links" in full.json()["error"]["message"]
        long = live.http.post(f"/api/v1/links/{link['id']}/open")
        assert long.status_code == 409 and "170 ticks; at most 100" in long.json()["error"]["message"]
