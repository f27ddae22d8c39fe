"""Headless runs by the interface: the same result as in process, honest about failure."""

from __future__ import annotations

import io
import json
import time
from typing import Any

import pyarrow.parquet as pq
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from server.store.models import RunRow


def wait(live: Any, run_id: str, seconds: float = 60.0) -> dict[str, Any]:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found: dict[str, Any] = live.http.get(f"/api/v1/runs/{run_id}").json()
        if found["state"] not in ("queued", "running"):
            return found
        time.sleep(0.05)
    raise TimeoutError(found)


def test_a_run_gives_what_a_run_in_process_gives(live: Any) -> None:
    answer = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step", "set": {"samples": 3000}, "seed": 7})
    assert answer.status_code == 202
    found = wait(live, answer.json()["id"])
    expected = run(with_values(get("ch5-seven-step"), {"samples": 3000}), 7).summary()
    assert found["state"] == "done" and found["progress"] == 1.0 and found["seeds"] == [7]
    summary = found["summary"]
    assert summary["digest"] == expected["digest"]
    assert summary["metrics"] == json.loads(json.dumps(expected["metrics"]))
    trace = live.http.get(f"/api/v1/runs/{found['id']}/trace")
    table = pq.read_table(io.BytesIO(trace.content))
    assert table.num_rows == 3000 and "plant.displacement" in table.column_names
    for kind in ("csv", "npz", "mat"):
        answer = live.http.get(f"/api/v1/runs/{found['id']}/trace", params={"format": kind})
        assert answer.status_code == 200 and len(answer.content) > 10_000
    assert found["id"] in {one["id"] for one in live.http.get("/api/v1/runs").json()["runs"]}


def test_several_seeds_give_means_and_deviations(live: Any) -> None:
    body = {"scenario": "ch5-seven-step", "seeds": [1, 4]}
    found = wait(live, live.http.post("/api/v1/runs", json=body).json()["id"])
    single = [run(get("ch5-seven-step"), seed).metrics for seed in (1, 2, 3)]
    name = "diagnosis.kalman.correct_fraction"
    values = [metrics[name] for metrics in single]
    assert found["seeds"] == [1, 2, 3]
    assert found["summary"]["metrics"][name] == pytest.approx(sum(values) / 3, rel=1e-12)
    assert found["summary"]["metrics_std"][name] >= 0
    assert len(set(found["summary"]["digests"])) == 3


@pytest.mark.parametrize(
    ("body", "word"),
    [
        ({"seeds": [5, 5]}, "seeds"),
        ({"seeds": [0, 100_000]}, "seeds"),
        ({"seeds": [1]}, "seeds"),
        ({"seed": 1, "seeds": [1, 2]}, "seed or seeds"),
        ({"seed": -1}, "seed"),
        ({"set": {"samples": 50_000_000}}, "max_run_ticks"),
        ({"set": {"samples": 0}}, "samples"),
    ],
)
def test_a_wrong_run_is_refused(live: Any, body: dict[str, Any], word: str) -> None:
    answer = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step", **body})
    assert answer.status_code == 422
    assert word in answer.json()["error"]["message"]


def test_the_queue_is_bounded_and_a_waiting_run_can_be_cancelled(serve: Any) -> None:
    with serve(max_queued_runs=4) as live:
        body = {"scenario": "ch5-seven-step", "set": {"samples": 2_000_000}}
        ids = [live.http.post("/api/v1/runs", json=body).json()["id"] for _ in range(4)]
        refused = live.http.post("/api/v1/runs", json=body)
        assert refused.status_code == 429 and refused.json()["error"]["code"] == "too_many_runs"
        cancelled = live.http.delete(f"/api/v1/runs/{ids[3]}")
        assert cancelled.status_code == 200 and cancelled.json()["state"] == "cancelled"
        again = live.http.delete(f"/api/v1/runs/{ids[3]}")
        assert again.status_code == 409
        # A live bench does not notice.
        bench = live.bench()
        time.sleep(1.5)
        status = live.get(bench["id"])
        assert status["state"] == "running" and status["tick"] > 50
    # The server has gone; what was waiting or running is not silently lost.
    with serve() as live:
        states = {found["id"]: found["state"] for found in live.http.get("/api/v1/runs").json()["runs"]}
        assert states[ids[3]] == "cancelled"
        assert set(states.values()) <= {"done", "cancelled", "aborted"}


def test_a_run_a_crash_interrupted_is_marked_aborted(serve: Any, tmp_path: Any) -> None:
    with serve(folder=tmp_path) as live:
        found = wait(live, live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step"}).json()["id"])
        assert found["state"] == "done"
    from server.store.database import Database

    database = Database(tmp_path / "combbench.sqlite3")
    database.transact(lambda s: setattr(s.get(RunRow, found["id"]), "state", "running"))
    database.close()
    with serve(folder=tmp_path) as live:
        after = live.http.get(f"/api/v1/runs/{found['id']}").json()
        assert after["state"] == "aborted" and "stopped" in after["error"]["message"]


def test_a_worker_that_dies_is_told_and_replaced(serve: Any) -> None:
    with serve() as live:
        body = {"scenario": "ch5-seven-step", "set": {"samples": 10_000_000}}
        run_id = live.http.post("/api/v1/runs", json=body).json()["id"]
        end = time.monotonic() + 30
        while live.http.get(f"/api/v1/runs/{run_id}").json()["state"] != "running":
            assert time.monotonic() < end
            time.sleep(0.05)
        for process in list(live.service.jobs._pool._processes.values()):
            process.kill()
        found = wait(live, run_id)
        assert found["state"] == "aborted" and "died" in found["error"]["message"]
        again = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step"}).json()["id"]
        assert wait(live, again)["state"] == "done"


def test_a_server_may_refuse_runs(serve: Any) -> None:
    with serve(run_workers=0) as live:
        answer = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step"})
        assert answer.status_code == 409 and answer.json()["error"]["code"] == "runs_disabled"
