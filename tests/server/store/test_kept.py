"""A data folder of an earlier version, whose events are in the earlier notation: all in it is still of use.

It has a recording, a recording that the server's end cut off, and a run. While the first was made a user injected
faults, switched, set values, healed, let commands wait, tripped the board and reset it.
"""

from __future__ import annotations

import io
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from core.board.commands import parse_command
from scenarios.run import run
from scenarios.schema import Scenario
from tests.server.conftest import serving

KEPT = Path(__file__).with_name("kept")
WHOLE, CUT = "1f5eaeb37d2e7da52ef20d22d8142a04", "fb56c048c5c92537fe867cc5f940c8a8"
DEEDS = ("inject", "heal", "set", "switch", "reset_trip")


@pytest.fixture(scope="module")
def old(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A server on a copy of the folder."""
    folder = tmp_path_factory.mktemp("old") / "data"
    shutil.copytree(KEPT, folder)
    with serving(folder) as live:
        yield live


def recording(old: Any, key: str = WHOLE) -> dict[str, Any]:
    return dict(old.http.get(f"/api/v1/recordings/{key}").json())


def told(events: list[dict[str, Any]]) -> list[tuple[Any, ...]]:
    return [(event["tick"], event["actor"], event["kind"], event["text"], event["command"]) for event in events]


def deeds(kept: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the user's commands after the scenario of a recording, as events of a scenario."""
    first = kept["scenario"]["samples"]
    done = [e for e in kept["events"] if e["kind"] in DEEDS and e["actor"] != "scenario" and e["tick"] > first]
    return [{**event["command"], "at_sample": event["tick"]} for event in done]


def test_its_events_are_those_of_a_scenario(old: Any) -> None:
    kept = recording(old)
    commands = [event["command"] for event in kept["events"] if event["command"]]
    known = [command for command in commands if "kind" not in command]
    assert {command["kind"] for command in commands if "kind" in command} == {"step"}
    assert all(parse_command(command).document() == command for command in known)
    assert {field for command in known for field in command} >= {"fault", "heal", "set", "switch", "reset_trip"}
    assert {event["kind"] for event in kept["events"]} >= {*DEEDS, "scheduled", "refused", "tripped"}
    waits = [event["command"] for event in kept["events"] if event["kind"] == "scheduled"]
    assert waits == [
        {"fault": "damping", "severity": 0.5, "profile": waits[0]["profile"], "at_sample": 120},
        {"switch": "open_loop", "at_ms": 1.3},
        {"heal": "all", "when": "plant.displacement > 1000"},
    ]
    assert (waits[0]["profile"]["period_ms"], waits[0]["profile"]["duty"]) == (0.2, 0.3)


def test_it_is_played_with_its_events(old: Any) -> None:
    kept = recording(old)
    replay = old.http.post(f"/api/v1/recordings/{WHOLE}/replay", json={"paused": True}).json()
    listed = old.http.get(f"/api/v1/benches/{replay['id']}/events").json()["events"]
    assert told(listed[: len(kept["events"])]) == told(kept["events"])
    assert [event["seq"] for event in listed] == list(range(1, len(listed) + 1))
    assert old.command(replay["id"], "step", ticks=500).json()["entry"]["text"] == "stepped 181 of 500 ticks"
    assert old.get(replay["id"])["tick"] == 191


def test_what_was_done_gives_the_same_trace_headless(old: Any) -> None:
    kept = recording(old)
    scenario = {**kept["scenario"], "samples": 191, "events": [*kept["scenario"]["events"], *deeds(kept)]}
    result = run(Scenario.load(scenario))
    assert result.board.tick == 191 and len(deeds(kept)) == 10
    trace = old.http.get(f"/api/v1/recordings/{WHOLE}/trace", params={"format": "parquet"}).content
    table = pq.read_table(io.BytesIO(trace))
    for name in ("plant.displacement", "sensor.displacement", "drive.voltage", "kalman.probability.m+5"):
        np.testing.assert_allclose(table[name].to_numpy(), result.signal(name)[10:], rtol=1e-4, atol=1e-6)


def test_a_bench_branches_off_from_it_and_is_saved(old: Any) -> None:
    kept = recording(old)
    scenario = {key: value for key, value in kept["scenario"].items() if key != "samples"}
    bench = old.bench(scenario, paused=True)
    for command in deeds(kept):
        assert old.command(bench["id"], **command).status_code == 200
    old.command(bench["id"], "step", ticks=191)
    fork = old.http.post(f"/api/v1/benches/{bench['id']}/fork", json={}).json()
    digests = []
    for key in (bench["id"], fork["id"]):
        old.command(key, "step", ticks=20)
        saved = Scenario.load(old.http.get(f"/api/v1/benches/{key}/scenario").text)
        digests += [old.http.get(f"/api/v1/benches/{key}/digest").json()["digest"], run(saved).digest]
    assert len(set(digests)) == 1


def test_a_recording_that_was_cut_off_has_its_events_too(old: Any) -> None:
    kept = recording(old, CUT)
    assert kept["state"] == "aborted" and kept["ticks"] > 0
    done = [event["command"] for event in kept["events"] if event["kind"] in DEEDS]
    assert done[-3:] == [{"fault": "drive_gain", "severity": -0.1}, {"switch": "pid"}, {"heal": ["drive_gain"]}]
    assert {"fault": "point_adhesion", "severity": 1.0, "parameters": {"beam": "outer", "position": 0.5}} in done


def test_its_run_is_listed(old: Any) -> None:
    (kept,) = old.http.get("/api/v1/runs").json()["runs"]
    assert kept["state"] == "done" and kept["summary"]["ticks"] == 191
