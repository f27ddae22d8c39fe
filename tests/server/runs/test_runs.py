"""Headless runs by the interface: the same result as in process, honest about failure."""

from __future__ import annotations

import io
import json
import os
import signal
import statistics
from typing import Any

import pyarrow.parquet as pq
import pytest

from scenarios.campaign.single import run_seeds
from scenarios.edit import with_values
from scenarios.library import get, library
from scenarios.run import build, run
from scenarios.schema import Scenario
from server.runs.queue import check_length
from server.settings import Settings
from server.store.models import RequestRow


def wait(live: Any, run_id: str, seconds: float = 240.0) -> dict[str, Any]:
    """Return a run once it has ended."""
    while True:
        live.ended(run_id, seconds)
        found: dict[str, Any] = live.http.get(f"/api/v1/runs/{run_id}").json()
        if found["state"] not in ("queued", "running"):
            return found


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
    body = {"scenario": "ch5-seven-step", "seeds": "1:3"}
    found = wait(live, live.http.post("/api/v1/runs", json=body).json()["id"])
    single = [run(get("ch5-seven-step"), seed).metrics for seed in (1, 2, 3)]
    name = "diagnosis.kalman.correct_fraction"
    values = [metrics[name] for metrics in single]
    assert found["seeds"] == [1, 2, 3]
    assert found["summary"]["metrics"][name] == pytest.approx(sum(values) / 3, rel=1e-12)
    assert found["summary"]["metrics_std"][name] == pytest.approx(statistics.stdev(values))
    assert len(set(found["summary"]["digests"])) == 3
    # scripts from earlier send the first seed and the one behind the last
    earlier = live.http.post("/api/v1/runs", json={**body, "seeds": [1, 4]})
    assert earlier.status_code == 200 and earlier.json()["id"] == found["id"]
    # one digest and one spread on every path
    assert found["summary"]["digest"] == run_seeds(get("ch5-seven-step"), [1, 2, 3])["digest"]


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"seeds": [5, 5]}, "seeds"),
    ({"seeds": "5:4"}, "seeds"),
    ({"seeds": "1:100000"}, "seeds"),
    ({"seeds": "1-3"}, "seeds"),
    ({"seeds": [0, 100_000]}, "seeds"),
    ({"seeds": [1]}, "seeds"),
    ({"seed": 1, "seeds": [1, 2]}, "seed or seeds"),
    ({"seed": -1}, "seed"),
    ({"set": {"samples": 50_000_000}}, "max_run_ticks"),
    ({"set": {"samples": 0}}, "samples"),
]


def test_a_wrong_run_is_refused(live: Any) -> None:
    for body, word in WRONG:
        answer = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step", **body})
        assert answer.status_code == 422 and word in answer.json()["error"]["message"], body


def long_run(number: int = 0) -> dict[str, Any]:
    return {"scenario": "ch5-seven-step", "set": {"samples": 9_000_000}, "seed": number}


def until_running(live: Any, run_id: str) -> dict[str, Any]:
    """Return a run once a worker has done some of it."""

    def look() -> dict[str, Any] | None:
        found: dict[str, Any] = live.http.get(f"/api/v1/runs/{run_id}").json()
        return found if found["state"] == "running" and found["progress"] else None

    return dict(live.wait(look))


def cancel(live: Any, run_id: str) -> dict[str, Any]:
    """Ask for the end, and wait for it: a worker that is only starting sees it once it has started."""
    assert live.http.delete(f"/api/v1/runs/{run_id}").status_code == 200
    return wait(live, run_id)


def test_the_queue_is_bounded_and_any_run_can_be_cancelled(serve: Any) -> None:
    with serve(max_queued_runs=3) as live:
        ids = [live.http.post("/api/v1/runs", json=long_run(number)).json()["id"] for number in range(3)]
        refused = live.http.post("/api/v1/runs", json=long_run(9))
        assert refused.status_code == 429 and refused.json()["error"]["code"] == "too_many_runs"
        cancelled = live.http.delete(f"/api/v1/runs/{ids[2]}")
        assert cancelled.status_code == 200 and cancelled.json()["state"] == "cancelled"
        assert live.http.delete(f"/api/v1/runs/{ids[2]}").status_code == 409
        # One under way ends as well, at the next look of its worker, and a live bench does not notice any of it.
        bench = live.bench()
        assert until_running(live, ids[0])["progress"] < 1.0
        live.advance(seconds=0.1)
        assert cancel(live, ids[0])["state"] == "cancelled"
        assert until_running(live, ids[1])["state"] == "running"
        status = live.get(bench["id"])
        assert status["state"] == "running" and status["tick"] > 0
    # The server has gone while one was under way: it begins again, and cancelled runs stay cancelled.
    with serve() as live:
        states = {found["id"]: found["state"] for found in live.http.get("/api/v1/runs").json()["runs"]}
        assert states[ids[0]] == states[ids[2]] == "cancelled"
        assert states[ids[1]] in ("queued", "running")
        assert cancel(live, ids[1])["state"] == "cancelled"
        # A cancelled run may be asked for again.
        assert live.http.post("/api/v1/runs", json=long_run(0)).status_code == 202


def test_a_trace_without_room_for_taps_holds_the_outputs(serve: Any) -> None:
    body = {"scenario": "ch5-seven-step"}
    with serve(max_run_mb=2) as live:
        found = wait(live, live.http.post("/api/v1/runs", json=body).json()["id"])
        assert found["state"] == "done", found["error"]
        assert found["summary"]["digest"] == run(get("ch5-seven-step")).digest
        trace = live.http.get(f"/api/v1/runs/{found['id']}/trace?format=csv").text.splitlines()
        assert len(trace) == 9001
        names = trace[0].replace('"', "").split(",")
        assert "kalman.probability.healthy" in names
        assert not any(name.startswith("kalman.nis") for name in names)
        tap = live.http.get(f"/api/v1/runs/{found['id']}/trace?format=csv&signals=kalman.nis.healthy")
        assert tap.status_code == 422 and "kalman.nis.healthy" in tap.json()["error"]["message"]


def names_of(live: Any, run_id: str) -> list[str]:
    content = live.http.get(f"/api/v1/runs/{run_id}/trace").content
    return list(pq.read_schema(io.BytesIO(content)).names)


def test_a_run_keeps_all_signals_when_it_is_asked_to(live: Any) -> None:
    """It is computed again for its trace alone: one run, one digest, one set of figures."""
    body = {"scenario": "ch5-seven-step", "set": {"samples": 1300}}
    run_id = live.http.post("/api/v1/runs", json=body).json()["id"]
    few, names = wait(live, run_id), names_of(live, run_id)
    assert few["all"] is False and "mrac.voltage" not in names and "kalman.nis.healthy" in names
    asked = live.http.post("/api/v1/runs", json={**body, "all": True})
    assert asked.status_code == 202 and asked.json()["id"] == run_id
    every = wait(live, run_id)
    assert every["all"] is True
    assert names_of(live, run_id)[2:] == build(with_values(get("ch5-seven-step"), body["set"])).signals.names
    assert all(every["summary"][key] == few["summary"][key] for key in ("digest", "metrics", "warnings"))
    # a run with all signals has the usual signals
    again = live.http.post("/api/v1/runs", json=body)
    assert again.status_code == 200 and again.json()["all"] is True


def test_a_run_under_way_does_not_change_what_it_keeps(live: Any) -> None:
    run_id = live.http.post("/api/v1/runs", json=long_run(77)).json()["id"]
    answer = live.http.post("/api/v1/runs", json={**long_run(77), "all": True})
    assert answer.status_code == 409 and answer.json()["error"]["field"] == "all"
    assert cancel(live, run_id)["state"] == "cancelled"


def test_the_same_run_asked_twice_is_one_run(live: Any) -> None:
    body = {"scenario": "ch5-seven-step", "set": {"samples": 2500}, "seed": 3}
    first = live.http.post("/api/v1/runs", json=body)
    found = wait(live, first.json()["id"])
    document = {**get("ch5-seven-step").document, "samples": 2500, "seed": 3}
    second = live.http.post("/api/v1/runs", json={"scenario": dict(reversed(document.items()))})
    assert (first.status_code, second.status_code) == (202, 200)
    assert second.json()["id"] == found["id"] and second.json()["summary"] == found["summary"]
    assert second.headers["location"].endswith(found["id"])
    other = live.http.post("/api/v1/runs", json={**body, "seed": 4})
    assert other.status_code == 202 and other.json()["id"] != found["id"]


def test_a_run_a_crash_interrupted_begins_again_but_not_for_ever(serve: Any, tmp_path: Any) -> None:
    with serve(folder=tmp_path) as live:
        found = wait(live, live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step"}).json()["id"])
        assert found["state"] == "done"
    from server.store.database import Database

    def as_after_a_crash(attempts: int) -> None:
        database = Database(tmp_path / "combbench.sqlite3")
        values = {"state": "running", "summary": None, "attempts": attempts}
        database.transact(lambda s: [setattr(s.get(RequestRow, found["id"]), *pair) for pair in values.items()])
        database.close()

    as_after_a_crash(1)
    with serve(folder=tmp_path) as live:
        after = wait(live, found["id"])
        assert after["state"] == "done" and after["summary"]["digest"] == found["summary"]["digest"]
    as_after_a_crash(3)
    with serve(folder=tmp_path) as live:
        after = live.http.get(f"/api/v1/runs/{found['id']}").json()
        assert after["state"] == "aborted" and "stopped" in after["error"]["message"]


def kill_workers(live: Any, killed: set[int]) -> set[int]:
    """Kill the present workers, except workers that were killed before; wait for some."""
    processes = live.service.queue.processes
    fresh = live.wait(lambda: set(getattr(processes._pool, "_processes", None) or {}) - killed)
    for pid in fresh:
        os.kill(pid, signal.SIGKILL)
    return set(fresh)


def test_a_run_whose_worker_dies_begins_again_but_not_for_ever(serve: Any) -> None:
    with serve() as live:
        run_id = live.http.post("/api/v1/runs", json=long_run()).json()["id"]
        killed: set[int] = set()
        for _ in range(3):
            until_running(live, run_id)
            killed |= kill_workers(live, killed)
        found = wait(live, run_id)
        assert found["state"] == "aborted" and "died 3 times in a row" in found["error"]["message"]
        again = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step"}).json()["id"]
        assert wait(live, again)["state"] == "done"


def test_a_server_may_refuse_runs(serve: Any) -> None:
    with serve(run_workers=0) as live:
        answer = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step"})
        assert answer.status_code == 409 and answer.json()["error"]["code"] == "runs_disabled"


def test_a_study_is_a_run_too(live: Any) -> None:
    """Detection delay at equal false alarms and its characteristic, by the interface."""
    few = {"study.runs": 4, "study.healthy_samples": 40_000, "study.signals": ["glr100.tone.healthy", "cusum.sum.m+5"]}
    body = {"scenario": "ch5-detectors", "set": {**few, "expect": []}, "seed": 3}
    found = wait(live, live.http.post("/api/v1/runs", json=body).json()["id"])
    assert found["state"] == "done", found["error"]
    expected = run(with_values(get("ch5-detectors"), body["set"]), 3).metrics
    metrics = found["summary"]["metrics"]
    assert metrics == json.loads(json.dumps(expected))
    for name in few["study.signals"]:
        assert 0.5 < metrics[f"roc.{name}.area"] <= 1.0 and metrics[f"detectors.{name}.missed"] <= 1.0
    assert metrics["detectors.glr100.tone.healthy.delay"] > 0


def test_every_scenario_of_the_library_may_run_on_a_server_as_it_comes() -> None:
    for scenario in library():
        check_length(scenario, 1, Settings(), scenario.id, "scenario")


def test_a_run_gives_its_scenario_back(live: Any) -> None:
    asked = {"scenario": "first-look", "set": {"samples": 900}, "seed": 7}
    made = live.http.post("/api/v1/runs", json=asked).json()
    found = live.http.get(f"/api/v1/runs/{made['id']}/scenario")
    assert found.status_code == 200 and found.headers["content-type"].startswith("text/plain")
    again = Scenario.load(found.text)
    assert (again.samples, again.spec.seed) == (900, 7)
    assert run(again).digest == wait(live, made["id"])["summary"]["digest"]
    assert live.http.get("/api/v1/runs/none/scenario").status_code == 404
