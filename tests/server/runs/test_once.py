"""A run and a campaign are one mechanism: every single run is computed once, whatever the requests and
interruptions."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from scenarios.campaign.executor import Processes
from scenarios.campaign.single import run_seeds
from scenarios.edit import with_values
from scenarios.library import get
from server.cli.main import app
from server.store.database import Database
from server.store.models import ResultRow
from tests.server.conftest import serving
from tests.server.forks import Forks
from tests.server.runs.test_large_campaign import ended
from tests.server.runs.test_listing import refused
from tests.server.runs.test_runs import until_running, wait

RUNS, SWEEPS = "/api/v1/runs", "/api/v1/sweeps"
NAME = "ch3-mrac-spring-x2"
"""A scenario with a controller: it is computed with the open loop too."""
SHORT: dict[str, Any] = {"duration_ms": 12.0}
VALUES: dict[str, Any] = {**SHORT, "comparator": {"pole": 2.0, "feedforward": 1.0}}
"""With a PID that is named, which the scenario is computed with as well."""


@pytest.fixture
def handed(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int]]:
    """The work of the worker processes: scenario by its controller, seed."""
    found: list[tuple[str, int]] = []
    submit = Processes.submit

    def count(self: Processes, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Any:
        tasks = {"compute": arguments[:1], "compute_traced": ([arguments[1]],) if len(arguments) > 1 else ()}
        for _, point, seed in (task for some in tasks.get(function.__name__, ()) for task in some):
            found.append((point.document.get("controller", {}).get("kind", ""), seed))
        return submit(self, function, *arguments, **named)

    monkeypatch.setattr(Processes, "submit", count)
    return found


def ask(live: Any, seeds: str, **more: Any) -> dict[str, Any]:
    body = {"scenario": NAME, "set": VALUES, "seeds": seeds, **more}
    found = wait(live, live.http.post(RUNS, json=body).json()["id"])
    assert found["state"] == "done", found["error"]
    return found


def campaign(live: Any, seeds: str, values: Any = None) -> dict[str, Any]:
    body = {"sweep": {"schema": 1, "id": "c", "scenario": NAME, "set": values or VALUES, "seeds": seeds}}
    found = ended(live, live.http.post(SWEEPS, json=body).json()["id"])
    assert found["state"] == "done" and found["done"] == found["runs"]
    return found


def test_what_is_in_the_table_is_not_computed_again(serve: Any, handed: list[tuple[str, int]]) -> None:
    own = get(NAME).spec.active

    def new() -> list[tuple[str, int]]:
        fresh = sorted(handed)
        handed.clear()
        return fresh

    with serve() as live:
        campaign(live, "1:4")
        assert new() == [(own, seed) for seed in (1, 2, 3, 4)]
        found = ask(live, "1:5")  # the first again, for its trace
        beside = [(kind, seed) for kind in ("open_loop", "pid") for seed in range(1, 6)]
        assert new() == sorted([*beside, (own, 1), (own, 5)])
        campaign(live, "1:5")
        assert new() == []
        alone = ask(live, "2:2")
        assert new() == [(own, 2)] and alone["summary"]["digest"] == found["summary"]["digests"][1]
        ask(live, "7:7")
        assert new() == sorted([("open_loop", 7), ("pid", 7), (own, 7)])
        points = campaign(live, "6:7")
        assert new() == [(own, 6)]
        # removed and asked for again: only the trace is missing
        live.http.post(f"{RUNS}/remove", json={"ids": [found["id"]]})
        again = ask(live, "1:5")
        assert new() == [(own, 1)]
        assert again["summary"]["metrics"] == found["summary"]["metrics"]
        # of one kind, each has its own address
        refused(live.http.get(f"{RUNS}/{points['id']}"), 404, "not_found")
        refused(live.http.delete(f"{SWEEPS}/{found['id']}"), 404, "not_found")


def test_one_summary_whoever_makes_it(live: Any) -> None:
    """REST, command line, in process; and the sums of a campaign."""
    found = ask(live, "3:5", set=SHORT)["summary"]
    expected = run_seeds(with_values(get(NAME), SHORT), [3, 4, 5])
    told = CliRunner().invoke(app, ["run", NAME, "--set", "duration_ms=12.0", "--seeds", "3:5", "--json"]).stdout
    same = ("digest", "digests", "metrics", "metrics_std", "seeds", "warnings", "verdict", "ok", "ticks", "trip")
    for one in (expected, json.loads(told)):
        assert {name: one[name] for name in same} == {name: found[name] for name in same}
    beside = {row["metric"]: (row["open_loop"], row["pid"]) for row in found["expectations"]}
    assert any(open_loop is not None for open_loop, _ in beside.values())
    sweep = campaign(live, "3:5", SHORT)
    (point,) = live.http.get(f"{SWEEPS}/{sweep['id']}/points").json()["points"]
    assert {name: spread["mean"] for name, spread in point["metrics"].items()} == found["metrics"]
    assert {name: spread["std"] for name, spread in point["metrics"].items()} == found["metrics_std"]


def rows(data: Path) -> dict[str, Any]:
    """The table of results, with times."""
    database = Database(data / "combbench.sqlite3")
    try:
        return {row.key: row.created for row in database.transact(lambda session: session.query(ResultRow).all())}
    finally:
        database.close()


LONG = {"scenario": "ch5-seven-step", "set": {"samples": 120_000}, "seeds": "1:4"}


@pytest.mark.long
def test_a_server_that_is_killed_between_two_seeds_goes_on_with_the_next(loaded: Forks, tmp_path: Path) -> None:
    data = tmp_path / "data"
    with loaded.serve(data, figures=False) as served:
        run_id = served.http.post(RUNS, json=LONG).json()["id"]
        while not rows(data):
            os.sched_yield()
        served.kill()
    before = rows(data)
    assert 1 <= len(before) < 4
    with loaded.serve(data, figures=False) as served:
        while (found := served.http.get(f"{RUNS}/{run_id}").json())["state"] != "done":
            os.sched_yield()
    after = rows(data)
    assert before.items() <= after.items() and len(after) == 4
    expected = run_seeds(with_values(get("ch5-seven-step"), LONG["set"]), range(1, 5))
    assert found["summary"]["digest"] == expected["digest"]


def test_a_run_that_is_cancelled_in_mid_tick_goes_on_from_there(tmp_path: Path) -> None:
    """Rows of the table stay, no file does, and no request waits for the active seed."""
    with serving(tmp_path) as live:
        run_id = live.http.post(RUNS, json={**LONG, "set": {"samples": 100_000}}).json()["id"]
        live.wait(lambda: rows(tmp_path))
        assert 0.0 < until_running(live, run_id)["progress"] < 1.0
        assert live.http.delete(f"{RUNS}/{run_id}").json()["state"] == "cancelled"
        before = rows(tmp_path)
        assert 1 <= len(before) < 4 and not (tmp_path / "runs" / run_id).exists()
        found = wait(live, live.http.post(RUNS, json={**LONG, "set": {"samples": 100_000}}).json()["id"])
        assert (found["id"], found["state"], found["progress"]) == (run_id, "done", 1.0)
        assert before.items() <= rows(tmp_path).items() and len(rows(tmp_path)) == 4
        assert live.http.get(f"{RUNS}/{run_id}/report").status_code == 200


def test_a_short_run_does_not_wait_for_a_long_campaign(serve: Any) -> None:
    """And both count for the limit of the queue."""
    with serve(max_queued_runs=2) as live:
        sweep = {"schema": 1, "id": "long", "scenario": "ch5-seven-step", "seeds": "1:50000"}
        long = live.http.post(SWEEPS, json={"sweep": sweep}).json()["id"]
        live.wait(lambda: live.http.get(f"{SWEEPS}/{long}").json()["done"])
        ask(live, "1:1")
        assert live.http.get(f"{SWEEPS}/{long}").json()["state"] == "running"
        for seed in (1, 2):
            answer = live.http.post(SWEEPS, json={"sweep": {**sweep, "seeds": f"{seed}:60000"}})
        assert "max_queued_runs" in refused(answer, 429, "too_many_runs")
        assert live.http.delete(f"{SWEEPS}/{long}").json()["state"] == "cancelled"


def test_a_run_is_carried_out_on_this_machine_where_campaigns_go_to_a_cluster(serve: Any) -> None:
    with serve(scheduler="tcp://127.0.0.1:1") as live:
        assert ask(live, "1:2")["state"] == "done"
