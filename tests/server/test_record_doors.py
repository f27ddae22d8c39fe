"""Every door of a bench that plays a record: one that is whole, one that grows, one that has ended."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import numpy as np
import pytest

from core.measured_record import find_on
from scenarios.record_folders import FOLDER
from scenarios.records.shelf import RecordFolder
from tests.server.conftest import Live, serving
from tests.server.instrument import FakeInstrument

SAMPLES = 1200
BENCH = "/api/v1/benches/{bench_id}"
RNG = np.random.default_rng(5)
DRIVE = np.repeat(RNG.normal(0.0, 5.0, SAMPLES // 8), 8)
DISPLACEMENT = np.cumsum(RNG.normal(0.0, 0.01, SAMPLES))
KINDS = ("whole", "growing", "ended")


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    folder = tmp_path_factory.mktemp("doors")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(FOLDER, str(folder / "records"))
        with serving(folder, instrument_port=0, instrument_samples=SAMPLES + 100) as live:
            yield live
    find_on(RecordFolder())


@pytest.fixture
def bench(server: Live, request: pytest.FixtureRequest) -> Iterator[str]:
    """A bench that has played all samples of its record; it is paused, and all benches close behind it."""
    with ExitStack() as stack:
        if request.param == "whole":
            yield _whole(server)
        else:
            yield _live(server, stack, is_growing=request.param == "growing")
    for one in server.http.get("/api/v1/benches").json()["benches"]:
        server.http.delete(f"/api/v1/benches/{one['id']}")
    server.advance(seconds=1.5)


def _whole(server: Live) -> str:
    rows = zip((np.arange(SAMPLES) * 0.02).tolist(), DRIVE.tolist(), DISPLACEMENT.tolist(), strict=True)
    content = "\n".join(["time_ms,drive,displacement", *(f"{t!r},{u!r},{y!r}" for t, u, y in rows)])
    made = server.http.post("/api/v1/records", content=content, params={"name": "device.csv"}).json()
    bench = str(server.bench("first-look", record=made["id"], paused=True)["id"])
    assert server.command(bench, "step", ticks=SAMPLES).status_code == 200
    return bench


def _live(server: Live, stack: ExitStack, *, is_growing: bool) -> str:
    scope = stack.enter_context(FakeInstrument(server.http.get("/api/v1/instruments").json()["listens"]))
    assert scope.begin() == {"ok": True}
    bench = str(server.http.post("/api/v1/instruments/scope/benches", json={}).json()["id"])
    for number in range(4):
        part = slice(300 * number, 300 * number + 300)
        scope.block(number, part.start, DRIVE[part], DISPLACEMENT[part])
    server.until(bench, lambda one: one["tick"] == SAMPLES)
    if not is_growing:  # one block more is too much
        scope.block(4, SAMPLES, DRIVE[:300], DISPLACEMENT[:300])
        server.until(bench, lambda one: one["state"] == "tripped")
    server.command(bench, "pause")
    return bench


class Doors:
    """Knocks at doors of a bench, and notes which."""

    def __init__(self, server: Live, bench: str) -> None:
        self.server, self.bench = server, bench
        self.seen: set[tuple[str, str]] = set()

    def ask(self, method: str, path: str, wanted: int | tuple[int, ...] = 200, named: str = "", **fields: Any) -> Any:
        """Ask at a door below the bench; the answer is as wanted, and a refusal is one line in the one shape."""
        template = BENCH + path
        self.seen.add((method, template))
        inner = path[path.find("{") : path.find("}") + 1] if "{" in path else ""
        address = template.replace("{bench_id}", self.bench).replace(inner or "{}", named)
        answer = self.server.http.request(method, address, **fields)
        assert answer.status_code in np.ravel(wanted), (method, path, answer.status_code, answer.text[:500])
        if answer.status_code >= 400:
            found = answer.json()["error"]
            assert found["message"] and "\n" not in found["message"]
            return found
        is_json = answer.content and "json" in answer.headers.get("content-type", "")
        return answer.json() if is_json else answer.content


@pytest.mark.parametrize("bench", KINDS, indirect=True)
def test_every_door_of_a_record_answers_or_refuses_in_a_line(server: Live, bench: str) -> None:
    doors = Doors(server, bench)
    ask = doors.ask
    status = ask("GET", "")
    assert status["tick"] == SAMPLES and status["record"]["samples"] == SAMPLES
    assert ask("PATCH", "", json={"name": "mine"})["name"] == "mine"
    assert ask("POST", "/reopen")["id"] == bench
    assert ask("GET", "/events")["events"] and b"plant" in ask("GET", "/scenario")
    digest = ask("GET", "/digest")["digest"]
    assert ask("GET", "/claims")["reason"] == ""
    assert ask("GET", "/printed") == {"marks": []}
    assert ask("GET", "/narration")["sentences"] is not None
    plants = ask("GET", "/plants")["plants"]
    assert plants and all(one["ns_per_tick"] is None and one["refused"] for one in plants)
    assert ask("GET", "/flops")["loads"]
    assert ask("GET", "/unstable-region")["folds"] == []
    assert "cannot be driven" in ask("POST", "/identification", 422, json={})["message"]
    assert ask("GET", "/diagnosers/{name}/explain", named="kalman")
    assert ask("GET", "/diagnosers/{name}/turn", named="kalman")
    assert ask("GET", "/diagnosers/{name}/aliases", named="kalman")
    assert ask("POST", "/diagnosers/{name}/aliases", named="kalman", json={})
    assert ask("GET", "/readouts/{name}", (404, 422), named="kalman")["message"]
    assert ask("GET", "/captures") is not None and ask("GET", "/audit") is not None
    assert ask("GET", "/trace", params={"signals": "sensor.displacement"})
    assert "record" in ask("GET", "/file.html", 422)["message"]

    kept = ask("POST", "/snapshots", 201, json={"name": "end"})["id"]
    assert len(ask("GET", "/snapshots")["snapshots"]) == 1
    assert ask("POST", "/fork", 201, json={"snapshot": kept})["tick"] == SAMPLES
    twin = ask("POST", "/fork", 201, json={})["id"]
    assert server.http.get(f"/api/v1/benches/{twin}/digest").json()["digest"] == digest
    early = ask("POST", "/fork", 201, json={"tick": 700, "paused": True, "window_ticks": 300})["id"]
    assert server.command(early, "seek", tick=400).status_code == 200 and server.get(early)["tick"] == 400
    assert server.command(early, "step", ticks=SAMPLES - 400).status_code == 200
    assert server.http.get(f"/api/v1/benches/{early}/digest").json()["digest"] == digest
    assert ask("POST", "/variant", 201, json={"set": {"sensor.noise_um": 0.2}})["tick"] < SAMPLES
    assert ask("POST", "/variant", 201, json={"set": {"sensor.noise_um": 0.2}, "repeat": True})["tick"] == SAMPLES
    assert ask("POST", "/snapshots/{snapshot_id}/restore", named=kept)
    assert ask("DELETE", "/snapshots/{snapshot_id}", 204, named=kept) == b""

    values = ask("POST", "/parameter-sets", 201, json={"name": f"of {bench}"})["id"]
    assert ask("POST", "/parameter-sets/{set_id}", named=values)["result"] is None
    recording = ask("POST", "/recordings", 201, json={"past_ticks": 500})["id"]
    assert ask("GET", "/recordings")["recordings"]
    assert ask("POST", "/recordings/{recording_id}/stop", named=recording) is not None
    assert ask("POST", "/driving", (200, 409), json={"do": "take"}) is not None
    assert ask("GET", "/blind")["question"] is None
    assert "no fault can act" in ask("POST", "/blind", 422, json={"seed": 1})["message"]
    assert ask("POST", "/blind/answer", 409, json={"said": "healthy", "confidence": 0.5})
    assert ask("DELETE", "/blind", 409)
    watcher = ask("POST", "/watchers", 201, json={})["id"]
    assert ask("GET", "/watchers")["watchers"]
    ask("DELETE", "/watchers/{watcher_id}", 204, named=watcher)
    ask("POST", "/commands", json={"kind": "pause"})
    assert ask("GET", "/digest")["digest"] == digest
    ask("DELETE", "", 204)

    document = json.loads(server.http.get("/api/v1/openapi.json").content)
    known = {(method.upper(), path) for path, one in document["paths"].items() if BENCH in path for method in one}
    assert doors.seen == known


COMMANDS: list[tuple[dict[str, Any], str]] = [
    ({"kind": "start"}, ""),
    ({"kind": "pause"}, ""),
    ({"set": {"reference.amplitude_v": 3.0}}, ""),
    ({"set": {"sensor.noise_um": 0.2}}, ""),
    ({"set": {"plant.offset_um": 0.1}}, ""),
    ({"kind": "undo"}, ""),
    ({"kind": "redo"}, ""),
    ({"set": {"plant.model": "linear"}}, "for record only"),
    ({"set": {"plant.model": "linear", "sensor.kind": "ideal"}}, "for record only"),
    ({"set": {"plant.record": "0" * 64}}, "no record"),
    ({"switch": "pid"}, ""),
    ({"fault": "added_mass", "severity": 0.05}, "added_mass"),
    ({"heal": "all"}, ""),
    ({"kind": "seek", "tick": 100}, "only a recording"),
    ({"kind": "loop", "start_tick": 1, "end_tick": 50}, "only a recording"),
    ({"kind": "time_scale", "value": 0.01}, ""),
    ({"kind": "reset", "values": {"sensor.noise_um": 0.3}}, ""),
    ({"kind": "step", "ticks": 300}, ""),
    ({"kind": "step_period"}, ""),
    ({"kind": "fast_forward", "before_tick": 1000}, ""),
    ({"kind": "pause"}, ""),
    ({"make_safe": "by hand"}, ""),
    ({"reset_trip": True}, ""),
    ({"kind": "undo"}, ""),
]


@pytest.mark.parametrize("bench", KINDS, indirect=True)
def test_every_command_over_a_stream_is_carried_out_or_refused_in_a_line(server: Live, bench: str) -> None:
    if server.get(bench)["trip"]:
        assert server.command(bench, reset_trip=True).status_code == 200
    with server.stream(bench) as stream:
        for command, refusal in COMMANDS:
            reply = stream.command(**command)
            said = (reply.get("error") or {}).get("message", "")
            assert (refusal in said and bool(said)) if refusal else not said, (command, reply)
            assert "\n" not in said
    assert server.get(bench)["record"]["samples"] == SAMPLES
