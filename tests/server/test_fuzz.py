"""Unexpected requests, generated from the OpenAPI document: never a failure of the server, one error shape.

Schemathesis makes them, one by one for each operation and in sequences that follow what earlier answers gave. Names a
guess would never hit (of scenarios, faults, benches) are put in now and then, so that requests get beyond the door.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.errors import Flaky
from schemathesis.checks import CheckContext, not_a_server_error
from schemathesis.core.failures import Failure, FailureGroup
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from scenarios.benchmark.seeds import BENCHMARK
from scenarios.edit import with_values
from scenarios.library import get
from tests.server.classroom.group import join, watcher
from tests.server.conftest import TOKEN, Live, serving
from tests.server.runs.test_runs import wait

SCENARIO = "first-look"
HEADERS = {"Authorization": f"Bearer {TOKEN}"}
KNOWN: dict[str, Any] = {
    "scenario": SCENARIO,
    "set": {"samples": 300},
    "sweep": {"schema": 1, "scenario": SCENARIO, "set": {"samples": 200}, "seeds": {"count": 2}},
    "only": "ch3-mrac-spring*",
    "fault": "added_mass",
    "severity": 0.05,
    "controller": "pid",
    "values": {"sensor.noise_um": 0.06},
    "when": "plant.displacement > 0.1",
    "sheet": SCENARIO,
}

CLAIM = {"metric": "control.effort_ratio", "path": "events.1.severity", "low": 0.0, "high": 8.0, "points": 3}


def one_error_shape(_context: CheckContext, response: Any, _case: Any) -> None:
    """Whatever is refused says so in the one shape, in one line."""
    if response.status_code < 400:
        return
    found = json.loads(response.content)
    is_shaped = set(found) == {"error"} and set(found["error"]) == {"code", "message", "field", "hint"}
    if not is_shaped or not found["error"]["message"] or "\n" in found["error"]["message"]:
        raise Failure(operation="error", title="Another error shape", message=response.text[:500])


CHECKS = [
    not_a_server_error,
    one_error_shape,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
]
EASY = settings(deadline=None, derandomize=True, database=None, suppress_health_check=list(HealthCheck))


@pytest.fixture
def target(tmp_path: Path) -> Iterator[Live]:
    """A server of its own with small limits: generated requests are not to keep the machine busy."""
    small = {"max_run_ticks": 5000, "max_sweep_runs": 10, "max_recording_ticks": 5000, "history_ticks": 2000}
    with serving(tmp_path, max_benches=16, **small) as live:
        yield live


@pytest.fixture
def things(target: Live) -> dict[str, str]:
    """One of each thing that a path may name."""
    bench = target.bench(SCENARIO, paused=True, set={"samples": 5000})
    path = f"/api/v1/benches/{bench['id']}"
    assert target.command(bench["id"], "step", ticks=500).status_code == 200
    recording = target.http.post(f"{path}/recordings", json={"past_ticks": 400, "ticks": 0}).json()
    snapshot = target.http.post(f"{path}/snapshots", json={"name": "here"}).json()
    run = wait(
        target, target.http.post("/api/v1/runs", json={"scenario": SCENARIO, "set": {"samples": 300}}).json()["id"]
    )
    sweep = target.http.post("/api/v1/sweeps", json={"sweep": KNOWN["sweep"]}).json()
    link = target.http.post("/api/v1/links", json={"bench": bench["id"]}).json()
    kept = target.http.post(f"{path}/parameter-sets", json={"name": "kept"}).json()
    group = target.http.post("/api/v1/classes", json={"name": "Fuzz"}).json()
    claimed = with_values(get("ch3-case1-aged-mass"), {"duration_ms": 5.0}).document
    search = target.http.post("/api/v1/thresholds", json={"scenario": claimed, **CLAIM}).json()
    vote = target.http.post("/api/v1/votes", json={"text": "Which?", "answers": ["one", "other"]}).json()
    assert target.http.post(f"/api/v1/sheets/{SCENARIO}/begin").status_code == 200
    return {
        "class_id": group["id"],
        "member_id": join(target, group, "Ada").id,
        "watcher_id": watcher(target, bench["id"]).id,
        "link_id": link["id"],
        "set_id": kept["id"],
        "bench_id": bench["id"],
        "recording_id": recording["id"],
        "snapshot_id": snapshot["id"],
        "run_id": run["id"],
        "sweep_id": sweep["id"],
        "scenario_id": SCENARIO,
        "sheet_id": SCENARIO,
        "step_id": "running",
        "lecture_id": "ch1-device",
        "number": "1",
        "vote_id": vote["id"],
        "name": "kalman",
        "threshold_id": search["id"],
        "benchmark_id": BENCHMARK,
        "game_id": "be-the-filter",
    }


@pytest.fixture
def api(target: Live, things: dict[str, str]) -> Any:
    schema = schemathesis.openapi.from_dict(target.http.get("/api/v1/openapi.json").json())
    schema.config.update(base_url=target.address)
    names = {**KNOWN, "bench": things["bench_id"], "class_id": things["class_id"]}

    def known(context: Any, body: Any) -> Any:
        """Put names that exist where the document says no more than text; two times in three."""
        if isinstance(body, dict) and len(json.dumps(body, default=str)) % 3:
            return {name: names.get(name, value) if value is not None else None for name, value in body.items()}
        return body

    def there(context: Any, parameters: Any) -> Any:
        """Name an existing object, two times in three; deleting it is left to the sequences."""
        if (
            not parameters
            or context.operation.method == "delete"
            or not sum(map(len, map(str, parameters.values()))) % 3
        ):
            return parameters
        return {name: things.get(name, value) for name, value in parameters.items()}

    schema.hooks.hook("map_body")(known)
    schema.hooks.hook("map_path_parameters")(there)
    return schema


def accepted(operation: Any, examples: int) -> int:
    """Ask in many ways; return how many of the requests were accepted."""
    good = 0

    @settings(EASY, max_examples=examples)
    @given(case=operation.as_strategy())
    def ask(case: Any) -> None:
        nonlocal good
        response = case.call(headers=HEADERS, timeout=60)
        case.validate_response(response, checks=CHECKS)
        good += response.status_code < 300

    ask()
    return good


@pytest.mark.parametrize("examples", [1, pytest.param(8, marks=pytest.mark.long)])
def test_no_request_brings_a_failure(api: Any, examples: int) -> None:
    operations = [found.ok() for found in api.get_all_operations()]
    # requests that remove or hide objects come last, so that the others find them
    last = ("/remove", "/blind", "/games")
    operations.sort(key=lambda one: one.method == "delete" or any(name in one.path for name in last))
    counts = {operation.label: accepted(operation, examples) for operation in operations}
    assert len(counts) > 50
    never = [label for label, good in counts.items() if not good and not label.startswith("DELETE")]
    asked = sum(operation.method != "delete" for operation in operations)  # deleting is left to the sequences
    assert examples == 1 or len(never) < 0.25 * asked, f"too few get beyond the door: {never}"


def sequences(api: Any, least: int, first_seed: int) -> None:
    """Ask at least so many requests in sequences.

    The answers of a server depend on its objects, so the maker of sequences may find itself contradicted and stop. It
    is then started anew; failures are collected here, where no contradiction can hide them.
    """
    asked: list[int] = []
    failures: list[FailureGroup] = []

    class Sequence(api.as_state_machine()):  # type: ignore[misc]
        def get_call_kwargs(self, case: Any) -> dict[str, Any]:
            return {"headers": HEADERS, "timeout": 60}

        def validate_response(self, response: Any, case: Any, **more: Any) -> None:
            asked.append(response.status_code)
            try:
                case.validate_response(response, checks=CHECKS)
            except FailureGroup as failure:
                failures.append(failure)

    once = settings(EASY, derandomize=False, max_examples=4, stateful_step_count=20, phases=[Phase.generate])
    for seed in range(first_seed, first_seed + 200):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("hypothesis.core.global_force_seed", seed)
            with contextlib.suppress(Flaky):
                Sequence.run(settings=once)
        if len(asked) >= least:
            break
    assert not failures, failures
    assert len(asked) >= least and sum(code < 300 for code in asked) > 0.3 * len(asked)


def test_no_sequence_of_requests_brings_a_failure(api: Any) -> None:
    sequences(api, 40, 0)


@pytest.mark.long
def test_no_sequence_drawn_by_chance_brings_a_failure(api: Any, drawn_seed: int) -> None:
    sequences(api, 400, drawn_seed)
