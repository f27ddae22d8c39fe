"""A campaign outlives its worker, its scheduler and its server: every run once, none lost, none repeated."""

from __future__ import annotations

import io
import random
import signal
import sqlite3
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pyarrow.csv
import pytest

from scenarios.campaign.sweep import Sweep
from scenarios.run import run
from scenarios.schema import Scenario
from tests.scenarios.campaign.cluster import Cluster
from tests.server.forks import Served, forks

RUNS = 200
CAMPAIGN = {
    "schema": 1,
    "id": "survivor",
    "scenario": "ch5-seven-step",
    "set": {"samples": 150_000},
    "seeds": {"count": RUNS // 2},
    "grid": {"sensor.noise_um": [0.05, 0.1]},
}


def rows(data: Path) -> dict[str, tuple[str, str]]:
    """Every result: what came out, and when it was put there."""
    with sqlite3.connect(f"file:{data / 'combbench.sqlite3'}?mode=ro", uri=True) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        found = {key: (outcome, created) for key, outcome, created in connection.execute("SELECT * FROM results")}
    connection.close()
    return found


def done(served: Served, sweep_id: str) -> dict[str, Any]:
    return dict(served.http.get(f"/api/v1/sweeps/{sweep_id}").json())


@pytest.mark.long
@pytest.mark.timeout(400)
def test_two_hundred_runs_though_worker_scheduler_and_server_are_killed(tmp_path: Path) -> None:
    data, moments = tmp_path / "data", random.Random(11)
    kills = ["worker", "server", "scheduler", "worker", "server"]
    moments.shuffle(kills)
    with forks(tmp_path / "log") as loaded, Cluster(tmp_path) as cluster, ExitStack() as stack:
        workers = [cluster.start_worker(), cluster.start_worker()]
        served = stack.enter_context(loaded.serve(data, scheduler=cluster.address, figures=False))
        sweep_id = served.http.post("/api/v1/sweeps", json={"sweep": CAMPAIGN}).json()["id"]
        seen: dict[str, tuple[str, str]] = {}
        for number, victim in enumerate(kills):
            goal = len(seen) + moments.randint(5, 30)
            end = time.monotonic() + 120
            while len(rows(data)) < goal:
                assert time.monotonic() < end, (number, victim, done(served, sweep_id))
                time.sleep(0.05)
            for worker in workers:  # so that no machine is too quick for the next kill
                worker.send_signal(signal.SIGSTOP)
            assert done(served, sweep_id)["state"] == "running", "too quick: it ended before all was killed"
            if victim == "worker":
                workers.pop(0).kill()
                workers.append(cluster.start_worker())
            elif victim == "scheduler":
                cluster.scheduler.kill()
                cluster.scheduler.wait()
                cluster.start_scheduler()
                for worker in workers:
                    worker.kill()
                workers = [cluster.start_worker(), cluster.start_worker()]
            else:
                served.kill()
                served = stack.enter_context(loaded.serve(data, scheduler=cluster.address, figures=False))
            for worker in workers:
                worker.send_signal(signal.SIGCONT)
            now = rows(data)
            assert seen.items() <= now.items(), "a result was lost or computed again"
            seen = now
        end = time.monotonic() + 200
        while (found := done(served, sweep_id))["state"] in ("queued", "running"):
            assert time.monotonic() < end, found
            time.sleep(0.2)
        assert (found["state"], found["done"], found["runs"]) == ("done", RUNS, RUNS), found
        table = pyarrow.csv.read_csv(io.BytesIO(served.http.get(f"/api/v1/sweeps/{sweep_id}/runs").content))
        report = served.http.get(f"/api/v1/sweeps/{sweep_id}/report").text
    last = rows(data)
    assert seen.items() <= last.items() and len(last) == RUNS == table.num_rows
    digests = table["digest"].to_pylist()
    assert len(set(digests)) == RUNS and f"{RUNS} of {RUNS} runs" in report
    for at, (_, point, seed) in list(enumerate(Sweep(CAMPAIGN).runs()))[::40]:
        assert digests[at] == run(Scenario.load(point.document), seed).digest
