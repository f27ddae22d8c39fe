"""Progress as server-sent events: to the end of the work, resumed, bounded, and gone with its reader."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import pytest

from server.clock import ManualClock
from server.errors import not_found
from server.progress import BEAT_S, HEARTBEAT_S, MOST, MOST_EACH, Ending, ProgressStreams, WorkProgress
from tests.server.classroom.group import join, open_class
from tests.server.runs.test_runs import long_run, wait

BASE = "/api/v1"


class Sent(NamedTuple):
    """An event as it came."""

    event: str
    id: str
    data: dict[str, Any]


def sent(lines: Iterator[str]) -> Iterator[Sent]:
    """Go through the events of a stream; the time to connect again comes first."""
    fields: dict[str, str] = {}
    for line in lines:
        if line:
            name, _, value = line.partition(": ")
            fields[name] = value
        elif "event" in fields:
            yield Sent(fields["event"], fields["id"], json.loads(fields["data"]))
            fields = {}
        else:
            assert fields.keys() <= {"retry", ""}
            fields = {}


@contextmanager
def following(live: Any, path: str, client: Any = None, **headers: str) -> Iterator[Iterator[Sent]]:
    with (client or live.http).stream("GET", f"{BASE}{path}/progress", headers=headers) as answer:
        assert answer.status_code == 200, answer.read()
        assert answer.headers["content-type"].startswith("text/event-stream")
        assert answer.headers["cache-control"] == "no-store, no-transform"
        assert answer.headers["x-accel-buffering"] == "no"
        yield sent(answer.iter_lines())


def all_gone(live: Any) -> None:
    live.wait(lambda: not live.service.progress.open)


def test_a_run_is_followed_to_its_end_and_not_beyond(live: Any) -> None:
    body = {"scenario": "ch5-seven-step", "set": {"samples": 800}, "seed": 77}
    made = live.http.post(f"{BASE}/runs", json=body).json()
    path = f"/runs/{made['id']}"
    with following(live, path) as events:
        *before, last = events
    whole = live.http.get(f"{BASE}{path}").json()
    assert last.event == "done" and last.data == whole and whole["state"] == "done"
    assert {one.event for one in before} <= {"progress"} and len({one.id for one in before}) == len(before)
    known = live.http.get(f"{BASE}{path}/progress", headers={"Last-Event-ID": last.id})
    assert known.status_code == 204
    with following(live, path, **{"Last-Event-ID": "of another time"}) as events:
        assert [*events] == [last]
    assert live.http.head(f"{BASE}{path}/progress").status_code == 200
    all_gone(live)


def test_a_cancelled_run_and_its_stream_end_together(serve: Any) -> None:
    with serve() as live:
        made = live.http.post(f"{BASE}/runs", json=long_run()).json()
        with following(live, f"/runs/{made['id']}") as events:
            assert next(events).data["state"] in ("queued", "running")
            live.http.delete(f"{BASE}/runs/{made['id']}")
            *_, last = events
            assert last.event == "cancelled" and last.data["state"] == "cancelled"
        wait(live, made["id"])


def test_a_campaign_counts_its_runs(live: Any) -> None:
    sweep = {"schema": 1, "id": "told", "scenario": "ch5-seven-step", "set": {"samples": 400}, "seeds": {"count": 3}}
    made = live.http.post(f"{BASE}/sweeps", json={"sweep": sweep}).json()
    with following(live, f"/sweeps/{made['id']}") as events:
        *_, last = events
    assert (last.event, last.data["done"], last.data["runs"]) == ("done", 3, 3)
    assert live.http.get(f"{BASE}/runs/{made['id']}/progress").status_code == 404, "a campaign is no run"
    assert live.http.get(f"{BASE}/thresholds/{made['id']}/progress").status_code == 404


def test_a_recording_counts_its_ticks_until_its_file_is_whole(live: Any) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    made = live.http.post(f"{BASE}/benches/{bench}/recordings", json={"ticks": 400}).json()
    with following(live, f"/recordings/{made['id']}") as events:
        first = next(events)
        assert (first.event, first.data["state"], first.data["done"], first.data["total"]) == (
            "progress", "recording", 0, 400
        )  # fmt: skip
        live.command(bench, "step", ticks=100)
        live.advance(seconds=BEAT_S)
        second = next(events)
        assert (second.data["done"], second.data["fraction"]) == (100, 0.25)
        live.command(bench, "step", ticks=300)
        live.wait(lambda: live.service.records.progress(made["id"]) is None)
        live.advance(seconds=BEAT_S)
        *_, last = events
        assert last.event == "done" and last.data["ticks"] == 400
    live.http.delete(f"{BASE}/recordings/{made['id']}")
    assert live.http.get(f"{BASE}/recordings/{made['id']}/progress").status_code == 404


def test_a_reader_who_leaves_leaves_nothing_behind(live: Any) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    made = live.http.post(f"{BASE}/benches/{bench}/recordings", json={}).json()
    with live.anonymous(headers=live.http.headers) as reader:
        with following(live, f"/recordings/{made['id']}", reader) as events:
            next(events)
            assert live.service.progress.open.total() == 1
    all_gone(live)


def test_streams_end_when_the_server_stops(serve: Any) -> None:
    with contextlib.ExitStack() as stack:
        with serve() as live:
            bench = live.bench("first-look", paused=True)["id"]
            made = live.http.post(f"{BASE}/benches/{bench}/recordings", json={}).json()
            reader = stack.enter_context(live.anonymous(headers=live.http.headers))
            events = stack.enter_context(following(live, f"/recordings/{made['id']}", reader))
            assert next(events).event == "progress"
        assert [one for one in events if one.event != "progress"] == []


def test_a_stream_too_many_is_refused_before_it_begins(live: Any) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    made = live.http.post(f"{BASE}/benches/{bench}/recordings", json={}).json()
    live.service.progress.open["somebody"] = MOST
    try:
        answer = live.http.get(f"{BASE}/recordings/{made['id']}/progress")
    finally:
        live.service.progress.open.clear()
    assert answer.status_code == 503
    assert answer.json()["error"]["code"] == "limit" and str(MOST) in answer.json()["error"]["message"]


def test_a_student_follows_own_recordings_alone(live: Any) -> None:
    group = open_class(live)
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    made = ada.ask("POST", f"{BASE}/benches/{ada.bench}/recordings", json={}).json()
    path = f"/recordings/{made['id']}"
    with live.anonymous(headers=ada.headers) as reader, following(live, path, reader) as events:
        assert next(events).data["state"] == "recording"
        live.service.progress.open[ada.id] = MOST_EACH
        assert ada.ask("GET", f"{BASE}{path}/progress").status_code == 503
        live.service.progress.open[ada.id] = 1
        assert ben.ask("GET", f"{BASE}{path}/progress").status_code == 404
        live.http.delete(f"{BASE}/classes/{group['id']}/members/{ada.id}")  # the session ends, and the stream with it
        live.advance(seconds=BEAT_S)
        assert [one.event for one in events if one.event != "progress"] == []
    assert ben.ask("GET", f"{BASE}/runs/none/progress").status_code == 403
    live.http.delete(f"{BASE}/classes/{group['id']}")


class Work:
    """Some work whose progress a test sets."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.streams = ProgressStreams(self.clock)
        self.now: WorkProgress | Ending | None = WorkProgress(state="queued", fraction=0.0, done=0, total=0)

    async def look(self) -> WorkProgress | Ending | None:
        return self.now

    def at(self, done: int, seconds: float) -> None:
        self.now = WorkProgress(state="running", fraction=done / 4, done=done, total=4)
        self.pass_time(seconds)

    def pass_time(self, seconds: float) -> None:
        self.clock._now += seconds
        self.streams.ring()


def test_events_tell_changes_alone_and_the_time_that_is_left() -> None:
    async def told() -> list[bytes]:
        work = Work()
        stream = work.streams.events(work.look, "")
        found = [await anext(stream), await anext(stream)]
        work.at(0, 1.0)
        found.append(await anext(stream))
        work.at(1, 2.0)
        found.append(await anext(stream))
        work.pass_time(HEARTBEAT_S)
        found.append(await anext(stream))  # nothing has changed: a comment
        work.now = Ending(state="aborted", result=WorkProgress(state="aborted", fraction=0.25, done=1, total=4))
        work.pass_time(0.0)
        found += [event async for event in stream]
        return found

    retry, queued, running, quarter, comment, failed = asyncio.run(told())
    assert retry == b"retry: 2000\n\n" and comment.startswith(b": ") and b"event" not in comment
    for event, state, left in ((queued, "queued", None), (running, "running", None), (quarter, "running", 6.0)):
        [one] = sent(iter(event.decode().split("\n")[:-1]))
        assert (one.event, one.data["state"], one.data["seconds_left"]) == ("progress", state, left)
    assert failed.startswith(b"event: failed\n")


@pytest.mark.parametrize("how", ["gone", "stopped"])
def test_a_stream_ends_when_its_work_is_gone_or_the_server_stops(how: str) -> None:
    async def told() -> list[bytes]:
        work = Work()

        async def gone() -> WorkProgress:
            raise not_found("run", "x")

        assert isinstance(work.now, WorkProgress)
        stream = work.streams.events(work.look if how == "stopped" else gone, work.now.id)
        found = [await anext(stream)]
        if how == "stopped":
            work.streams.close()
        return found + [event async for event in stream]

    assert asyncio.run(told()) == [b"retry: 2000\n\n"]
