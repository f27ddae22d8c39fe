"""A full disk: the bench and its streams continue, the recording ends with an alarm and can be read."""

from __future__ import annotations

import asyncio
import io
import resource
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest
from sqlalchemy.exc import OperationalError

from server.store.database import Database
from tests.server.forks import forks
from tests.server.store.test_taking import recordings, until


def broken_off(live: Any, bench: dict[str, Any], recording_id: str) -> dict[str, Any]:
    """The recording once it has broken off, after the alarm was seen on the stream and the bench went on."""
    with live.stream(bench["id"]) as stream:
        stream.send(type="subscribe", panel=1, signals=["plant.displacement"], window_ms=1.0)
        while not (failed := [event for event in stream.events if event["kind"] == "recording_failed"]):
            live.advance(seconds=0.1)
            stream.step()
        assert "the disk failed" in failed[0]["text"]
        tick = live.get(bench["id"])["tick"]
        live.advance(seconds=0.1)
        stream.until(lambda message: not isinstance(message, dict) and message.head > tick)
    assert live.get(bench["id"])["recording"] == []
    return dict(until(lambda: (one := said(live, recording_id))["state"] != "recording" and one))


def said(live: Any, recording_id: str) -> dict[str, Any]:
    return dict(live.http.get(f"/api/v1/recordings/{recording_id}").json())


def is_whole(live: Any, found: dict[str, Any]) -> None:
    trace = live.http.get(f"/api/v1/recordings/{found['id']}/trace")
    ticks = pq.read_table(io.BytesIO(trace.content))["tick"].to_pylist()
    assert len(ticks) == found["ticks"] > 0
    assert ticks == list(range(found["start_tick"], found["start_tick"] + found["ticks"]))


def test_a_recording_ends_while_there_is_room_to_make_it_whole(serve: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [1e9]
    monkeypatch.setattr("server.store.recording.free_bytes", lambda _folder: now[0])
    monkeypatch.setattr("server.store.keeping.free_bytes", lambda _folder: now[0])
    with serve(disk_reserve_bytes=200_000_000) as live:
        bench = live.bench("first-look", time_scale=0.02)
        started = live.http.post(recordings(bench)).json()
        part = live.service.recordings.path(started["id"]).with_suffix(".arrows")
        while part.stat().st_size < 100_000:
            live.advance(seconds=0.1)
        now[0] = 1.5e8
        found = broken_off(live, bench, started["id"])
        assert found["state"] == "cut_short" and "150 MB are free" in found["reason"]
        is_whole(live, found)
        headless = {"scenario": "first-look"}
        for path, body in (
            (recordings(bench), {}),
            ("/api/v1/runs", headless),
            ("/api/v1/gallery/run", {"only": "first-look"}),
            ("/api/v1/sweeps", {"sweep": {"schema": 1, **headless}}),
        ):
            refused = live.http.post(path, json=body)
            assert refused.status_code == 507 and refused.json()["error"]["code"] == "no_space"
            assert "disk_reserve_bytes" in refused.text
        now[0] = 1e9
        assert live.http.post(recordings(bench)).status_code == 201


def test_what_a_full_disk_could_not_take_is_closed_later(serve: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    with serve() as live:
        bench = live.bench("first-look", time_scale=0.02)
        started = live.http.post(recordings(bench)).json()
        live.advance(bench=bench["id"], ticks=1000)
        database, transact = live.service.database, live.service.database.transact
        is_full = True

        def refuse(work: Any) -> Any:
            if is_full and work.__qualname__.startswith("Recordings._close"):
                raise OperationalError("UPDATE", {}, Exception("database or disk is full"))
            return transact(work)

        monkeypatch.setattr(database, "transact", refuse)
        answer = live.http.post(f"{recordings(bench)}/{started['id']}/stop")
        assert answer.status_code == 200 and answer.json()["state"] == "done"  # reported, though not yet stored
        before = said(live, started["id"])
        is_full = False
        after = said(live, started["id"])
        assert after == before and after["ticks"] > 0
        from server.store.models import RecordingRow

        row = database.transact(lambda session: session.get(RecordingRow, started["id"]))
        assert (row.state, row.ticks, row.reason) == ("done", after["ticks"], "stopped")
        is_whole(live, after)


@pytest.mark.long
def test_a_disk_that_takes_no_more(tmp_path: Path) -> None:
    """A real limit of the kernel: no file of the server may grow beyond 3 MB."""
    from tests.server.conftest import Live

    log = tmp_path / "log"
    with forks(log) as loaded, loaded.serve(tmp_path / "data", largest_file=3_000_000) as served:

        class Far(Live):
            def __init__(self) -> None:
                self.http, self.address = served.http, served.address

            def advance(self, *_: Any, **_more: Any) -> dict[str, int]:
                """Its time passes by itself."""
                return {}

        live = Far()
        bench = live.bench("first-look", time_scale=0.02)
        started = live.http.post(recordings(bench)).json()
        found = broken_off(live, bench, started["id"])
        assert found["state"] == "cut_short" and "File too large" in found["reason"]
        is_whole(live, found)
        run = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step", "set": {"samples": 30_000}}).json()
        ended = until(lambda: (one := live.http.get(f"/api/v1/runs/{run['id']}").json())["finished"] and one)
        assert ended["state"] == "failed" and ended["error"]["code"] == "no_space", ended
        assert live.get(bench["id"])["state"] == "running"
        again = live.http.post(recordings(bench), json={"past_ticks": 100, "ticks": 0}).json()
        assert (again["state"], again["ticks"]) == ("done", 100)
        live.command(bench["id"], "step", ticks=10_000)
        refused = live.http.get(f"/api/v1/benches/{bench['id']}/trace?format=csv")
        assert refused.status_code == 507 and refused.json()["error"]["code"] == "no_space", refused.text[:500]


def test_on_a_full_disk_a_recording_can_be_deleted(serve: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """The database takes nothing before the file has made room; a row that stays behind does no harm."""
    with serve() as live:
        bench = live.bench("first-look", paused=True)
        live.command(bench["id"], "step", ticks=50)
        kept = live.http.post(recordings(bench), json={"past_ticks": 50, "ticks": 0}).json()["id"]
        path, transact = live.service.recordings.path(kept), live.service.database.transact
        is_full = True

        def refuse(work: Any) -> Any:
            if work.__qualname__.startswith("Recordings.delete") and (path.exists() or is_full):
                raise OperationalError("DELETE", {}, Exception("database or disk is full"))
            return transact(work)

        monkeypatch.setattr(live.service.database, "transact", refuse)
        assert live.http.delete(f"/api/v1/recordings/{kept}").status_code == 503
        assert not path.exists() and said(live, kept)["state"] == "done"
        assert live.http.get(f"/api/v1/recordings/{kept}/trace").status_code == 404
        assert live.http.post(f"/api/v1/recordings/{kept}/replay", json={}).status_code == 404
        is_full = False
        assert live.http.delete(f"/api/v1/recordings/{kept}").status_code == 204
        assert live.http.get(f"/api/v1/recordings/{kept}").status_code == 404


def test_the_database_counts_as_used(serve: Any) -> None:
    """Results of campaigns are in it alone."""
    with serve(quota_bytes=50_000) as live:
        answer = live.http.post("/api/v1/sweeps", json={"sweep": {"schema": 1, "scenario": "first-look"}})
        assert answer.status_code == 507 and "quota_bytes" in answer.text


def test_a_database_that_takes_nothing_more_is_not_ready(tmp_path: Path) -> None:
    """A real limit of the kernel: no file may grow."""
    database = Database(tmp_path / "x.sqlite3")
    database.migrate()
    assert asyncio.run(database.is_writable())
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, ((tmp_path / "x.sqlite3-wal").stat().st_size, hard))
    try:
        assert not asyncio.run(database.is_writable())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert asyncio.run(database.is_writable())
    database.close()
