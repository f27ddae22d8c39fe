"""While a fault is hidden, no door reveals it: the answers of all of them are the same for every fault."""

from __future__ import annotations

import http.client
import io
import json
import random
import re
from collections.abc import Collection, Iterator
from types import SimpleNamespace
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pyarrow.parquet as pq
import pytest

from scenarios.library import get
from server.bench.bench import LiveBench
from server.classroom import blind
from server.classroom.access import ALL, DOORS, OPEN_WHILE_BLIND, SOCKET, Need
from server.classroom.classes import Classes
from tests.server.classroom.group import Somebody, join, open_class, the_teacher
from tests.server.classroom.test_doors import COMMANDS
from tests.server.conftest import Live

BEFORE, AFTER = 50, 450
"""Ticks at which all doors are asked: the fault waits, and it has been there for a while."""
ENDING = {("DELETE", "/api/v1/benches/{bench_id}/blind"), ("DELETE", "/api/v1/benches/{bench_id}")}
WATCHING = {("GET", "/watch"), ("GET", "/watch/{secret}")}
JOINING = {("POST", "/join"), ("POST", "/api/v1/classes/{class_id}/join"), *WATCHING}
"""Doors that end the exercise, and doors without a bench that count tries."""
LONG = {("GET", f"/api/v1/{noun}") for noun in ("catalog", "gallery", "devices", "scenarios", "openapi.json")}
"""Doors that know no bench and say much: asked while the first two faults are hidden."""
FORBIDDEN = ("plant.displacement", "kalman.winner", "faults.added_mass", "effects.mass_scale", "nobody.knows")
BODIES: dict[str, list[Any]] = {
    "/api/v1/benches/{bench_id}/commands": [
        *[one for one in COMMANDS if one.get("kind") not in ("start", "step_period", "step")],
        {"set": {"plant.drive_noise_v": 0.1}},
        {"set": {"reference.amplitude_v": 9.0}, "when": "sensor.displacement > 0"},
        {"set": {"reference.amplitude_v": 9.0}, "at_sample": AFTER + 1},
        {"fault": "added_mass", "severity": 0.05, "when": "plant.displacement > 0"},
        {"kind": "fast_forward", "before_tick": 10**6},
    ],
    "/api/v1/benches/{bench_id}/identification": [
        {"points": 4, "cycles": 2, "settle": 1},
        {"points": 200, "cycles": 1000, "settle": 100},
        {"points": 4, "cycles": 2, "settle": 1, "amplitude_v": 20},
    ],
    "/api/v1/benches": [{"scenario": "first-look"}],
    "/api/v1/benches/{bench_id}/blind": [{"seed": 1}],
    "/api/v1/benches/{bench_id}/blind/answer": [{"said": "nothing", "confidence": 0.5}],
}
TIMES = re.compile(
    r'("(?:achieved_scale|given_up_ms|loop_lag_ms|wake_late_ms|overruns|capped|watchers)":) ?[^,}]*'
    r"|\d{4}-\d\d-\d\dT[\d:.]+Z"
    r"|(?<='nonce-)[\w-]+|(?<=name=.nonce. content=.)[\w-]+|(?<=name=.{2}nonce.{2} content=.{2})[\w-]+"
)


@pytest.fixture
def live(serve: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[Live]:
    """A server whose students may ask as often as they like, and whose benches run by steps alone."""
    begin = LiveBench.begin
    monkeypatch.setattr(LiveBench, "begin", lambda self, _start: begin(self, False))
    monkeypatch.setattr("server.api.gate.REQUESTS_PER_S", 1e9)
    monkeypatch.setattr("server.api.gate.REQUESTS_AT_ONCE", 10**9)
    monkeypatch.setattr("server.computing.computing.BUDGET_S", 1e9)
    monkeypatch.setattr("server.classroom.blind_class.secrets", SimpleNamespace(token_hex=lambda n: "e" * 2 * n))
    with serve(clock="manual") as live:
        yield live


def hide(live: Live, group: str, student: Somebody, faults: list[Any], monkeypatch: pytest.MonkeyPatch) -> str:
    """Hide a fault of the test's own on a bench that is the same each time but for that; run it to before it comes."""
    draw = Classes.draw

    async def drawn(self: Any, person: Any, *what: str) -> int:
        return 1 if what[-1] == "fault" else await draw(self, person, *what)

    with monkeypatch.context() as patch:
        patch.setattr(Classes, "draw", drawn)
        patch.setattr(blind, "faults_of", lambda _: faults)
        done = live.http.post(f"/api/v1/classes/{group}/blind", json={"members": [student.id]}).json()
    assert done == {"done": 1, "failed": []}
    student.bench = live.service.people.bench_of(live.service.people.by_secret(student.secret))
    run(live, student.bench, BEFORE)
    return student.bench


def run(live: Live, bench: str, tick: int) -> None:
    """Run a paused bench to a tick."""
    session, submit = live.service.benches.get(bench), live.service.engine.submit
    while session.board.tick < tick:
        submit(session.advance, tick - session.board.tick).result(10)
    submit(session.refresh_status).result(10)


def plain(text: str, bench: str) -> str:
    """Return an answer without ids and times."""
    return TIMES.sub(r"\1", text.replace(bench, "BENCH"))


def fetched(student: Somebody, left_out: Collection[tuple[str, str]] = ()) -> dict[str, str]:
    """Ask at every door, with bodies that would tell if they could; return what came, without samples."""
    found: dict[str, str] = {}
    connection = http.client.HTTPConnection(urlsplit(student.live.address).netloc, timeout=30)
    for method, path in DOORS:
        if method == SOCKET or (method, path) in ENDING | JOINING or (method, path) in left_out:
            continue
        filled = path.replace("{bench_id}", student.bench).replace("{name}", "kalman")
        filled = filled.replace("{", "").replace("}", "")
        for body in [None] if method == "GET" else BODIES.get(path, [[]]):
            connection.request(
                method, filled, None if body is None else json.dumps(body),
                {**student.headers, "Content-Type": "application/json"},
            )  # fmt: skip
            answer = connection.getresponse()
            text, key = answer.read().decode("utf-8", "replace"), f"{method} {path} {body}"
            if path.endswith("/trace") and answer.status == 200:
                text = re.sub(r"\[[^\[\]]*\]", "[]", text)
            if path.endswith("/identification") and answer.status == 200:
                swept = json.loads(text)  # the measurement has a test of its own
                text = json.dumps([*swept, swept["tick"], swept["nominal"]])
            found[key] = plain(f"{answer.status} {text}", student.bench)
            kept = {name: value for name, value in answer.getheaders() if name not in ("date", "content-length")}
            found[f"{key} headers"] = plain(json.dumps(kept), student.bench)
    path = f"/api/v1/benches/{student.bench}/trace"
    connection.request("GET", f"{path}?format=csv", headers=student.headers)
    lines = connection.getresponse().read().decode().splitlines()
    found["csv"] = plain(f"{lines[0]} {[line.split(',')[:2] for line in lines[1:]]}", student.bench)
    for name in FORBIDDEN:
        connection.request("GET", f"{path}?signals={name}", headers=student.headers)
        answer = connection.getresponse()
        found[name] = f"{answer.status} {answer.read().decode()}"
        assert answer.status == 422
    connection.close()
    return found


def streamed(student: Somebody) -> dict[str, str]:
    """Watch and command over the socket; return every text that came, and frames without their samples."""
    found: dict[str, str] = {}
    with student.stream() as stream:
        hello = stream.until_type("hello")
        stream.send(type="resume", after=0)
        names = [signal["name"] for signal in hello["bench"]["signals"]]
        stream.send(type="subscribe", panel=1, signals=names, mode="frozen", start_tick=0, end_tick=AFTER)
        frame = stream.until_frame(1)
        found["frame"] = f"{frame.head} {frame.running} {[(p.start, p.end, p.columns.shape) for p in frame.panels]}"
        for name in FORBIDDEN:
            stream.send(type="subscribe", panel=2, signals=[name], mode="roll", window_ms=1.0)
            found[name] = json.dumps(stream.until_type("error"))
        replies = [stream.command(**one) for one in BODIES["/api/v1/benches/{bench_id}/commands"]]
        found["replies"] = json.dumps([{**one, "id": ""} for one in replies])
        stream.command("pause")  # answered behind the status it led to
        status = [one for one in stream.messages if one["type"] == "status"][-1]
        stream.until_event(seq=status["last_event"])
        found["status"] = plain(json.dumps(status), student.bench)
        found["hello"] = plain(json.dumps(hello), student.bench)
        found["events"] = plain(json.dumps(stream.events), student.bench)
        found["kinds"] = str(sorted({one["type"] for one in stream.messages} - {"notice"}))
    return found


def a_fault(chance: random.Random) -> list[Any]:
    """Draw a fault, its severity, or none."""
    kinds = {"added_mass": 0.3, "stiffness": 0.3, "damping": 1.0, "drive_gain": 0.3, "sensor_noise": 0.05}
    names = chance.sample(list(kinds), chance.choice([0, 1, 1, 1, 2]))
    return [{"fault": name, "severity": round(kinds[name] * chance.uniform(0.1, 1.0), 3)} for name in names]


FEW = [
    [{"fault": "added_mass", "severity": 0.05}],
    [],
    [{"fault": "stiffness", "severity": 0.2}, {"fault": "sensor_noise", "severity": 0.02}],
    [{"fault": "damping", "severity": 0.6}, {"fault": "drive_gain", "severity": 0.15}],
]


def test_every_door_says_the_same_of_few_faults(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    all_say_the_same(live, FEW, monkeypatch)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(5))
def test_every_door_says_the_same_of_many_faults(
    live: Live, drawn_seed: int, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    chance = random.Random(drawn_seed + seed)
    all_say_the_same(live, [a_fault(chance) for _ in range(41)], monkeypatch)


def all_say_the_same(live: Live, hidden: list[list[Any]], monkeypatch: pytest.MonkeyPatch) -> None:
    """Hide one after the other; while each is hidden, ask at every door before and after it comes."""
    group = open_class(live)
    student = join(live, group, "Ada")
    first: dict[str, str] = {}
    for turn, faults in enumerate(hidden):
        hide(live, group["id"], student, faults, monkeypatch)
        assert len(live.get(student.bench)["pending"]) == len(faults)
        early = {**fetched(student, set(DOORS) - OPEN_WHILE_BLIND | LONG), **streamed(student)}
        run(live, student.bench, AFTER)
        acting = live.get(student.bench)["faults"]
        assert {one["name"] for one in acting} == {one["fault"] for one in faults}
        left_out = () if turn < 2 else LONG
        got = {**fetched(student, left_out), **{f"socket {key}": text for key, text in streamed(student).items()}}
        got |= {f"early {key}": text for key, text in early.items()}
        first = first or got
        assert len(first) - len(got) in (0, 2 * len(LONG))
        assert [(key, got[key], first[key]) for key in got if got[key] != first[key]] == []
    assert len({json.dumps(faults) for faults in hidden}) > len(hidden) / 2
    path = f"/api/v1/benches/{student.bench}/events"  # the teacher, who is not blind, gets more
    assert the_teacher(live).ask("GET", path).json() != student.ask("GET", path).json()


def test_files_of_the_trace_say_nothing_of_the_bench(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    group = open_class(live)
    student = join(live, group, "Ada")
    hide(live, group["id"], student, [{"fault": "added_mass", "severity": 0.05}], monkeypatch)
    seed = str(live.get(student.bench)["seed"])
    shown = {one["name"] for one in student.ask("GET", f"/api/v1/benches/{student.bench}").json()["signals"]}
    assert shown == {"reference.voltage", "drive.voltage", "drive.saturated", "sensor.displacement"} | {
        "model.displacement",
        "model.velocity",
    }
    for kind in ("csv", "parquet", "npz", "mat"):
        answer = student.ask("GET", f"/api/v1/benches/{student.bench}/trace?format={kind}")
        assert answer.status_code == 200
        for word in (seed, "added_mass", "kalman", "stiffness_n_m"):
            assert word.encode() not in answer.content, (kind, word)
        if kind == "parquet":
            file = pq.read_table(io.BytesIO(answer.content))
            assert set(file.column_names) - shown == {"tick", "time_ms"}
            assert b"scenario" not in (file.schema.metadata or {})
        if kind == "npz":
            assert "scenario" not in str(dict(np.load(io.BytesIO(answer.content))))


def test_a_sweep_measures_the_hidden_fault_once_it_acts_and_says_nothing_of_it_before(
    live: Live, monkeypatch: pytest.MonkeyPatch
) -> None:
    group = open_class(live)
    student = join(live, group, "Ada")
    early, late = [], []
    for factor in (1.0, 1.2):
        faults = [{"fault": "added_mass", "severity": factor - 1.0}] if factor > 1.0 else []
        hide(live, group["id"], student, faults, monkeypatch)
        early.append(sweep(student))
        run(live, student.bench, AFTER)
        late.append(sweep(student))
    assert early[0] == early[1]
    meant = get("ch5-seven-step").spec.device
    assert early[0]["nominal"] == meant.metrics() != live.service.benches.get(student.bench).board.spec.device.metrics()
    found = [one["found"] for one in (*early, *late)]
    assert found[2]["f0_hz"] == pytest.approx(found[0]["f0_hz"], rel=2e-3)
    assert found[3]["f0_hz"] == pytest.approx(found[0]["f0_hz"] / 1.2**0.5, rel=2e-3)


def sweep(student: Somebody) -> dict[str, Any]:
    answer = student.ask("POST", f"/api/v1/benches/{student.bench}/identification", json={"points": 12, "cycles": 10})
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_doors_that_stay_open_are_in_the_table() -> None:
    assert not [door for door in OPEN_WHILE_BLIND if ALL[door] is Need.NOTHING]
