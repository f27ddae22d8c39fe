"""Recordings of a live bench, by the interface."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pyarrow.parquet as pq

from server.bench.bench import LiveBench
from server.store.models import RecordingRow


def record(live: Any, bench: dict[str, Any], seconds: float = 0.3) -> dict[str, Any]:
    path = f"/api/v1/benches/{bench['id']}/recordings"
    started = live.http.post(path, json={"name": "mine"}).json()
    assert started["state"] == "recording"
    assert live.get(bench["id"])["recording"] == [started["id"]]
    live.advance(seconds=seconds)
    answer = live.http.post(f"{path}/{started['id']}/stop")
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_a_recording_is_what_the_history_holds(live: Any) -> None:
    bench = live.bench(time_scale=0.05)
    stopped = record(live, bench)
    assert stopped["state"] == "done" and stopped["ticks"] > 100
    assert live.get(bench["id"])["recording"] == []
    answer = live.http.get(f"/api/v1/recordings/{stopped['id']}/trace")
    assert 'filename="mine.parquet"' in answer.headers["content-disposition"]
    table = pq.read_table(io.BytesIO(answer.content))
    ticks = table["tick"].to_numpy()
    first, last = int(ticks[0]), int(ticks[-1])
    assert ticks.tolist() == list(range(first, first + stopped["ticks"]))
    query = {"signals": "plant.displacement", "start_tick": first, "end_tick": last + 1, "format": "npz"}
    trace = np.load(io.BytesIO(live.http.get(f"/api/v1/benches/{bench['id']}/trace", params=query).content))
    np.testing.assert_array_equal(trace["plant.displacement"], table["plant.displacement"].to_numpy())
    for kind in ("csv", "npz", "mat"):
        answer = live.http.get(f"/api/v1/recordings/{stopped['id']}/trace", params={"format": kind})
        assert answer.status_code == 200 and len(answer.content) > 1000


def test_recordings_outlive_their_bench_and_end_with_it(live: Any) -> None:
    bench = live.bench(time_scale=0.05)
    path = f"/api/v1/benches/{bench['id']}/recordings"
    first, second = (live.http.post(path).json() for _ in range(2))
    third = live.http.post(path)
    assert third.status_code == 409 and third.json()["error"]["code"] == "conflict"
    live.advance(seconds=0.2)
    assert live.http.delete(f"/api/v1/benches/{bench['id']}").status_code == 204
    for one in (first, second):
        found = live.http.get(f"/api/v1/recordings/{one['id']}").json()
        assert found["state"] == "done" and found["ticks"] > 0
        assert found["reason"] == "the bench was closed"
        assert live.http.get(f"/api/v1/recordings/{one['id']}/trace").status_code == 200
    ids = {one["id"] for one in live.http.get("/api/v1/recordings").json()["recordings"]}
    assert {first["id"], second["id"]} <= ids


def test_a_jump_in_time_ends_a_recording(live: Any) -> None:
    bench = live.bench(time_scale=0.05)
    path = f"/api/v1/benches/{bench['id']}/recordings"
    started = live.http.post(path).json()
    live.advance(seconds=0.2)
    live.command(bench["id"], "reset")
    while live.http.get(f"/api/v1/recordings/{started['id']}").json()["state"] == "recording":
        pass
    assert live.http.get(f"/api/v1/recordings/{started['id']}").json()["reason"] == "the bench was reset"
    assert live.http.post(f"{path}/{started['id']}/stop").status_code == 404


def test_a_recording_under_way_has_no_trace_yet(live: Any) -> None:
    bench = live.bench()
    started = live.http.post(f"/api/v1/benches/{bench['id']}/recordings").json()
    answer = live.http.get(f"/api/v1/recordings/{started['id']}/trace")
    assert answer.status_code == 404 and "stop" in answer.json()["error"]["hint"]


def test_one_that_reaches_its_limit_ends_by_itself(serve: Any) -> None:
    with serve(max_recording_ticks=1000) as live:
        bench = live.bench(time_scale=0.1)
        started = live.http.post(f"/api/v1/benches/{bench['id']}/recordings").json()
        live.advance(bench=bench["id"], ticks=1100)
        while (found := live.http.get(f"/api/v1/recordings/{started['id']}").json())["state"] == "recording":
            pass
        assert found["state"] == "done" and found["reason"] == "it reached its size limit"
        events = live.http.get(f"/api/v1/benches/{bench['id']}/events").json()["events"]
        assert any(event["kind"] == "recording_stopped" for event in events)
        assert live.get(bench["id"])["recording"] == []


def test_what_was_under_way_at_a_crash_is_marked_and_kept(serve: Any, tmp_path: Any) -> None:
    with serve(folder=tmp_path) as live:
        bench = live.bench(time_scale=0.05)
        finished = record(live, bench)
        # As a power cut leaves it: the row says "recording", the file is a stream.
        path = live.service.recordings.path(finished["id"])
        table = pq.read_table(path)
        session: LiveBench = live.service.benches.get(bench["id"])
        assert len(session.recordings) == 0
    import pyarrow as pa

    from server.store.database import Database

    with pa.OSFile(str(path.with_suffix(".arrows")), "wb") as sink, pa.ipc.new_stream(sink, table.schema) as stream:
        stream.write_table(table)
    path.unlink()
    database = Database(tmp_path / "combbench.sqlite3")
    database.transact(lambda s: setattr(s.get(RecordingRow, finished["id"]), "state", "recording"))
    database.close()
    with serve(folder=tmp_path) as live:
        found = live.http.get(f"/api/v1/recordings/{finished['id']}").json()
        assert found["state"] == "aborted" and found["ticks"] == finished["ticks"]
        assert live.http.get(f"/api/v1/recordings/{finished['id']}/trace").status_code == 200


def test_a_recording_whose_file_is_damaged_says_so_and_is_not_called_done(serve: Any, tmp_path: Any) -> None:
    def asked(live: Any, recording: dict[str, Any]) -> list[tuple[int, str]]:
        path = f"/api/v1/recordings/{recording['id']}"
        answers = [
            live.http.get(f"{path}/trace?format=csv"),
            live.http.get(f"{path}/trace"),
            live.http.post(f"{path}/replay", json={}),
            live.http.post(f"{path}/compare", json={"other": recording["id"]}),
        ]
        return [(answer.status_code, answer.json()["error"]["code"]) for answer in answers]

    def state(live: Any, recording: dict[str, Any]) -> tuple[str, int]:
        found = live.http.get(f"/api/v1/recordings/{recording['id']}").json()
        return found["state"], found["ticks"]

    with serve(folder=tmp_path) as live:
        bench = live.bench(time_scale=0.05)
        cut, garbled, later = (record(live, bench) for _ in range(3))
        file = live.service.recordings.path
        whole = file(cut["id"]).read_bytes()
        file(cut["id"]).write_bytes(whole[: len(whole) // 2])
        assert asked(live, cut) == [(410, "damaged")] * 4
        assert state(live, cut) == ("failed", 0)
        data = bytearray(file(garbled["id"]).read_bytes())
        data[4 : len(data) // 2] = b"x" * (len(data) // 2 - 4)  # its description is whole
        file(garbled["id"]).write_bytes(bytes(data))
        answer = live.http.get(f"/api/v1/recordings/{garbled['id']}/trace?format=csv")
        assert (answer.status_code, answer.json()["error"]["code"]) == (410, "damaged")
        file(later["id"]).write_bytes(b"no recording")
    with serve(folder=tmp_path) as live:  # a start looks at all of them
        assert [state(live, one) for one in (cut, later)] == [("failed", 0)] * 2
