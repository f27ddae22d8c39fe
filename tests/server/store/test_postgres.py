"""The service on PostgreSQL: runs, campaigns and recordings work as on SQLite."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from core.errors import InputError
from server.store.database import Database
from server.store.models import RequestRow, ResultRow
from server.store.results import Results
from tests.server.runs.test_large_campaign import ended as campaign_ended
from tests.server.runs.test_runs import wait
from tests.server.store.postgres import ROOT, new_database
from tests.server.store.test_taking import ended, recordings, stepped

SWEEP = {"schema": 1, "id": "small", "scenario": "ch5-seven-step", "set": {"samples": 1000}, "seeds": {"count": 4}}


def test_results_are_put_once(place: Any) -> None:
    database = Database(place)
    database.migrate()
    results = Results(database)
    results.put([(f"{number:064}", json.dumps({"seed": number})) for number in range(1200)])
    results.put([("0" * 64, '{"seed": 99}'), ("f" * 64, '{"seed": 1200}')])
    keys = [f"{number:064}" for number in range(1300)]
    assert results.have(keys) == set(keys[:1200])
    found = dict(results.outcomes(keys))
    assert len(found) == 1200 and json.loads(found["0" * 64]) == {"seed": 0}
    database.close()


@pytest.mark.long
def test_a_database_serves_one_server_at_a_time(postgres_server: str, tmp_path: Path) -> None:
    address = new_database(postgres_server, "claimed")
    first, second = Database(address), Database(address)
    first.claim()
    environment = os.environ | {"COMBBENCH_DATABASE_URL": address, "COMBBENCH_PORT": "0"}
    command = [sys.executable, "-m", "server.cli.main", "serve", "--data", str(tmp_path)]
    told = subprocess.run(command, env=environment, cwd=ROOT, capture_output=True, text=True, timeout=60, check=False)
    assert told.returncode == 2
    assert "database_url: the database is in use by another server" in told.stderr.splitlines()[-1]
    with pytest.raises(InputError, match="another server"):
        second.claim()
    first.close()
    second.claim()
    second.close()


@pytest.mark.long
def test_processes_that_start_at_once_migrate_once(postgres_server: str) -> None:
    address = new_database(postgres_server, "at-once")
    databases = [Database(address) for _ in range(4)]
    with ThreadPoolExecutor(len(databases)) as threads:
        list(threads.map(Database.migrate, databases))
    for database in databases:
        database.close()


@pytest.mark.long
def test_the_service_keeps_all_of_it_in_postgresql(serve: Any, postgres_server: str, tmp_path: Path) -> None:
    address = new_database(postgres_server, "service")
    with serve(database_url=address, folder=tmp_path) as live:
        assert live.http.get("/health/ready").status_code == 200
        body = {"scenario": "ch5-seven-step", "set": {"samples": 1500}, "seed": 5}
        done = wait(live, live.http.post("/api/v1/runs", json=body).json()["id"])
        assert done["state"] == "done"
        sweep = live.http.post("/api/v1/sweeps", json={"sweep": SWEEP}).json()
        found = campaign_ended(live, sweep["id"])
        assert (found["state"], found["done"]) == ("done", 4)
        assert live.http.patch(f"/api/v1/sweeps/{sweep['id']}", json={"label": "a % sign"}).status_code == 200
        for query, count in (("text=%25", 1), ("text=_", 0), ("scenario=ch5-seven-step&state=done", 1)):
            assert len(live.http.get(f"/api/v1/sweeps?{query}").json()["sweeps"]) == count
        assert live.http.get("/api/v1/runs?text=SEVEN-step").json()["runs"][0]["id"] == done["id"]
        bench = stepped(live, 500)
        kept = live.http.post(recordings(bench), json={"past_ticks": 400, "ticks": 0}).json()
        assert ended(live, kept["id"])["ticks"] == 400
    assert not (tmp_path / "combbench.sqlite3").exists()
    with serve(database_url=address, folder=tmp_path) as live:  # everything exists after a restart
        assert live.http.get(f"/api/v1/runs/{done['id']}").json()["summary"] == done["summary"]
        assert live.http.get(f"/api/v1/sweeps/{sweep['id']}").json()["done"] == 4
        points = live.http.get(f"/api/v1/sweeps/{sweep['id']}/points").json()["points"]
        assert points[0]["runs"] == 4
        assert live.http.get(f"/api/v1/recordings/{kept['id']}/trace").status_code == 200
        assert live.http.post("/api/v1/sweeps/remove", json={"ids": [sweep["id"]]}).json() == {"removed": 1}
        assert live.http.get("/api/v1/sweeps").json()["sweeps"] == []
    database = Database(address)
    assert database.transact(lambda session: session.query(RequestRow).count()) == 1
    assert database.transact(lambda session: session.query(ResultRow).count()) == 5
    database.close()


@pytest.mark.long
def test_the_command_line_puts_a_campaign_into_postgresql(postgres_server: str, tmp_path: Path) -> None:
    address = new_database(postgres_server, "campaign")
    (tmp_path / "small.toml").write_text(
        'schema = 1\nid = "small"\nscenario = "ch5-seven-step"\nset.samples = 1000\nseeds.count = 4\n'
    )

    def sweep(url: str) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "COMBBENCH_DATABASE_URL": url}
        command = [sys.executable, "-m", "server.cli.main", "sweep", "small.toml", "--workers", "1", "--out", "out"]
        return subprocess.run(
            [*command, "--resume"], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=90
        )

    done = sweep(address)
    assert done.returncode == 0 and "4 of 4 runs" in done.stdout, done.stderr
    database = Database(address)
    assert database.transact(lambda session: session.query(ResultRow).count()) == 4
    database.close()
    gone = sweep("postgresql://bench@127.0.0.1:1/campaign")
    assert gone.returncode == 2 and "Traceback" not in gone.stderr
    assert "database" in gone.stderr and len(gone.stderr.strip().splitlines()) == 1, gone.stderr
