"""The stages of a board over REST: on a new bench, on a bench that runs, and in a run."""

from __future__ import annotations

from typing import Any

from tests.server.runs.test_runs import wait


def test_stages_are_set_on_a_new_bench_and_while_it_runs(live: Any) -> None:
    bench = live.bench(set={"board.delay_samples": 2}, paused=True)
    assert live.get(bench["id"])["parameters"]["board"] == {"delay_samples": 2}
    live.command(bench["id"], "step", samples=50)
    values = {"board.delay_samples": 0, "board.jitter_us": 0.1}
    answer = live.command(bench["id"], set=values)
    assert answer.status_code == 200
    assert live.get(bench["id"])["parameters"]["board"] == values_of(values)
    refused = live.command(bench["id"], set={"board.delay_fraction": 1.5})
    assert refused.status_code == 422 and refused.json()["error"]["field"] == "board.delay_fraction"


def values_of(paths: dict[str, float]) -> dict[str, float]:
    return {path.removeprefix("board."): value for path, value in paths.items()}


def test_a_run_has_the_stages_it_is_given(live: Any) -> None:
    found = []
    for samples in (0, 1):
        asked = {"scenario": "ch3-mrac-spring-x2", "set": {"board.delay_samples": samples, "duration_ms": 20}}
        answer = live.http.post("/api/v1/runs", json=asked)
        found.append(wait(live, answer.json()["id"])["summary"]["metrics"]["control.peak_error_um"])
    assert found[0] < found[1]
