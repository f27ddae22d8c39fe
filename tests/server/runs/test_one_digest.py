"""The same scenario and seed give the same bits on every path."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from scenarios.campaign.campaign import Campaign
from scenarios.campaign.sweep import Sweep
from server.cli.main import app
from tests.scenarios.campaign.cluster import Cluster
from tests.scenarios.campaign.test_campaign import Memory
from tests.server.runs.test_runs import wait

NAME, SEED = "ch5-seven-step", 23
VALUES = {"samples": 5000, "events.5.set": {"reference.amplitude_v": 9.0}}


def digests(live: Any) -> dict[str, str]:
    """Return the digest by each way that needs this machine alone."""
    found: dict[str, str] = {}
    changes = ["--set", "samples=5000", "--set", 'events.5.set={"reference.amplitude_v"=9.0}']
    told = CliRunner().invoke(app, ["run", NAME, "--seed", str(SEED), *changes, "--json"])
    found["command line"] = json.loads(told.stdout)["digest"]

    body = {"scenario": NAME, "set": VALUES, "seed": SEED}
    found["REST"] = wait(live, live.http.post("/api/v1/runs", json=body).json()["id"])["summary"]["digest"]

    bench = live.bench(NAME, set=VALUES, seed=SEED, paused=True)
    for ticks in (1, 998, 1, 4000):
        assert live.command(bench["id"], "step", ticks=ticks).status_code == 200
    seen = live.http.get(f"/api/v1/benches/{bench['id']}/digest").json()
    assert seen["tick"] == 5000
    found["live"] = seen["digest"]

    paced = live.bench(NAME, set=VALUES, seed=SEED)
    live.advance(bench=paced["id"], ticks=5000)
    found["paced"] = live.http.get(f"/api/v1/benches/{paced['id']}/digest").json()["digest"]
    return found


def is_one(found: dict[str, str]) -> bool:
    return len(set(found.values())) == 1 and all(len(one) == 64 for one in found.values())


def test_one_digest_from_command_line_rest_and_live(live: Any) -> None:
    found = digests(live)
    assert is_one(found), found


@pytest.mark.long
def test_one_digest_from_pool_and_cluster_too(live: Any, tmp_path: Path) -> None:
    found, pool, cluster = digests(live), Memory(), Memory()
    sweep = Sweep({"schema": 1, "scenario": NAME, "set": VALUES, "seeds": {"first": SEED, "count": 1}})
    assert Campaign(sweep, pool, workers=1).run()
    with Cluster(tmp_path) as dask:
        dask.start_worker()
        assert Campaign(sweep, cluster, scheduler=dask.address).run()
    for name, memory in (("pool", pool), ("cluster", cluster)):
        found[name] = next(iter(memory.found.values())).digest
    assert is_one(found), found
