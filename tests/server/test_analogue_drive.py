"""An analogue drive over REST: no feedback with it, and its loss is in the run."""

from __future__ import annotations

from typing import Any

import pytest

from tests.server.runs.test_runs import wait


@pytest.mark.parametrize("path", ["/api/v1/benches", "/api/v1/runs"])
def test_feedback_under_an_analogue_drive_is_refused_as_it_was_written(live: Any, path: str) -> None:
    values = {"plant.drive": "analogue", "controller.kind": "pid"}
    answer = live.http.post(path, json={"scenario": "ch5-seven-step", "set": values})
    assert answer.status_code == 422
    error = answer.json()["error"]
    assert error["code"] == "invalid" and error["field"].endswith("plant.drive") and "open_loop" in error["message"]


def test_a_switch_to_feedback_is_refused_and_the_bench_runs_on(live: Any) -> None:
    bench = live.bench(set={"plant.drive": "analogue"}, paused=False)
    for kind, fields in (("switch", {"controller": "mrac"}), ("set", {"values": {"controller.kind": "pid"}})):
        answer = live.command(bench["id"], kind, **fields)
        assert answer.status_code == 422 and answer.json()["error"]["field"].endswith("plant.drive")
    before = live.get(bench["id"])["tick"]
    assert live.command(bench["id"], fault="damping", severity=0.3).status_code == 200
    assert live.get(bench["id"])["tick"] >= before
    closed = live.bench(set={"controller.kind": "pid"})
    answer = live.command(closed["id"], set={"plant.drive": "analogue"})
    assert answer.status_code == 422 and answer.json()["error"]["field"].endswith("plant.drive")


def test_a_run_tells_its_warnings(live: Any) -> None:
    values = {"samples": 500, "diagnosers.slow.kind": "arx_bank", "diagnosers.slow.every": 5}
    answer = live.http.post("/api/v1/runs", json={"scenario": "ch5-seven-step", "set": values})
    found = wait(live, answer.json()["id"])
    assert len(found["summary"]["warnings"]) == 1 and found["summary"]["warnings"][0].startswith("slow weighs")
    report = live.http.get(f"/api/v1/runs/{found['id']}/report").text
    assert f"Warning: {found['summary']['warnings'][0]}" in report
