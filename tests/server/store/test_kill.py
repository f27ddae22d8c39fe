"""A server killed at any moment of a recording: the database is whole, a second at most is lost, files can be read."""

from __future__ import annotations

import io
import os
import random
import sqlite3
import threading
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pyarrow.parquet as pq
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.server.forks import Forks, Served

PACE = 0.02
PER_SECOND = 2000
"""Ticks of a wall second at that pace and 100 kHz."""
SIGNAL = "sensor.displacement"


def truth(ticks: int) -> Any:
    """The run of the bench, headless; noise included."""
    return run(with_values(get("first-look"), {"samples": ticks})).signal(SIGNAL).astype(np.float32)


def record_and_kill(served: Served, moments: random.Random) -> tuple[str, int]:
    """Record for a while, sometimes stop, and kill; return the recording, and a tick seen just before."""
    for killed in served.http.get("/api/v1/benches").json()["benches"]:  # it came back; a server has so many
        served.http.delete(f"/api/v1/benches/{killed['id']}")
    bench = served.http.post("/api/v1/benches", json={"scenario": "first-look", "time_scale": PACE}).json()
    path = f"/api/v1/benches/{bench['id']}/recordings"
    recording = served.http.post(path, json={"name": "to be killed"}).json()
    goal = moments.randrange(2500)
    while served.http.get(f"/api/v1/benches/{bench['id']}").json()["tick"] < goal:
        os.sched_yield()
    if moments.random() < 0.3:  # while its file is made whole

        def stop() -> None:
            try:
                served.http.post(f"{path}/{recording['id']}/stop")
            except httpx.HTTPError:
                pass

        thread = threading.Thread(target=stop)
        tick = served.http.get(f"/api/v1/benches/{bench['id']}").json()["tick"]
        thread.start()
        for _ in range(moments.randrange(20)):
            served.http.get("/health/live")
        served.kill()
        thread.join()
    else:
        tick = served.http.get(f"/api/v1/benches/{bench['id']}").json()["tick"]
        served.kill()
    return recording["id"], tick


def check(served: Served, recording_id: str, tick: int, expected: Any) -> int:
    """Check the rest of a recording: no more than a second is missing, every tick is right. Returns the missing
    ticks."""
    found = served.http.get(f"/api/v1/recordings/{recording_id}").json()
    assert found["state"] in ("aborted", "done") and found["finished"], found
    last = found["start_tick"] + found["ticks"]
    lost = max(0, tick - last)
    assert lost <= PER_SECOND, f"{lost} ticks of {tick} are lost"
    trace = served.http.get(f"/api/v1/recordings/{recording_id}/trace")
    if not found["ticks"] and trace.status_code == 404:  # of less than a second of ticks there may be no file
        return lost
    table = pq.read_table(io.BytesIO(trace.content))
    assert table["tick"].to_pylist() == list(range(found["start_tick"], last))
    length = min(last, len(expected))
    np.testing.assert_array_equal(
        table[SIGNAL].to_numpy()[: length - found["start_tick"]], expected[found["start_tick"] : length]
    )
    return lost


@pytest.mark.parametrize("times", [2, pytest.param(50, marks=[pytest.mark.long, pytest.mark.timeout(600)])])
def test_a_server_killed_while_it_records_loses_a_second_at_most(loaded: Forks, tmp_path: Path, times: int) -> None:
    data, moments, expected = tmp_path / "data", random.Random(times), truth(6000)
    lost: list[int] = []
    last: tuple[str, int] | None = None
    for _ in range(times):
        with loaded.serve(data, figures=False, run_workers=0) as served:
            if last is not None:
                lost.append(check(served, *last, expected))
            last = record_and_kill(served, moments)
        with sqlite3.connect(data / "combbench.sqlite3") as connection:
            assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        connection.close()
    with loaded.serve(data, figures=False, run_workers=0) as served:
        assert last is not None
        lost.append(check(served, *last, expected))
        rows = served.http.get("/api/v1/recordings").json()["recordings"]
    print(f"{times} kills, ticks lost at most {max(lost)} of {PER_SECOND} a second")
    assert len(rows) == times == len(lost)
    left = {path.suffix for path in (data / "recordings").iterdir()}
    assert left <= {".parquet"}, "nothing half made is left behind"
