"""Hidden faults: for a class and for a single user, from the question to the answer and its storage."""

from __future__ import annotations

import re
from typing import Any

import pytest

from core.board.commands import parse_command
from core.device.drawn import device_of
from scenarios.library import get
from server.api.view3d import SUBPROTOCOL as SCENE
from server.classroom.access import DOORS, OPEN_WHILE_BLIND, SOCKET, Need
from server.classroom.hiding import STOPPED
from server.stream.hub import CLOSE_TURNED
from tests.server.classroom.group import (
    Somebody,
    advance,
    closed_with,
    compute_nothing,
    join,
    open_class,
    the_teacher,
    watcher,
)
from tests.server.classroom.test_blind_doors import ENDING
from tests.server.classroom.test_doors import code_of
from tests.server.conftest import Live


def hide(live: Live, group: dict[str, Any], *students: Somebody, **fields: Any) -> dict[str, Any]:
    """Hide a fault for the class; the students have new benches then."""
    done: dict[str, Any] = live.http.post(f"/api/v1/classes/{group['id']}/blind", json=fields).json()
    for student in students:
        student.bench = student.me()["bench"]
    return done


def answers(live: Live, group: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = live.http.get(f"/api/v1/classes/{group['id']}/blind").json()
    return found


def test_each_student_has_a_device_and_noise_of_ones_own(live: Live, group: dict[str, Any]) -> None:
    students = [join(live, group, name) for name in ("Ada", "Ben", "Cy")]
    assert hide(live, group, *students) == {"done": 3, "failed": []}
    benches = [live.get(student.bench) for student in students]
    assert len({bench["seed"] for bench in benches}) == 3
    assert len({bench["parameters"]["device"]["mass_kg"] for bench in benches}) == 3
    for student in students:  # they see the device as designed
        seen = student.ask("GET", f"/api/v1/benches/{student.bench}").json()
        assert seen["parameters"]["device"] == get("ch5-seven-step").document["device"]
        assert (seen["seed"], seen["samples"], seen["diagnosers"]) == (0, None, {})
        assert seen["blind"]["answers"] == ["healthy", "m+5", "m+10", "k+5", "k+10", "b+30"]
    kept = answers(live, group)
    assert kept["hidden"] == 3 and len({one["exercise"] for one in kept["answers"]}) == 1
    for one, bench in zip(kept["answers"], benches, strict=True):
        assert len(bench["pending"]) == (one["truth"] != "healthy")
        assert one["bench"] == bench["id"]


def test_an_answer_ends_it_for_one_and_all_answers_for_all(live: Live, group: dict[str, Any]) -> None:
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    hide(live, group, ada, ben)
    truth = {one["name"]: one["truth"] for one in answers(live, group)["answers"]}
    path = f"/api/v1/benches/{ada.bench}"
    refused = ada.ask("POST", f"{path}/blind/answer", json={"said": "m+50", "confidence": 0.9})
    assert refused.status_code == 422 and refused.json()["error"]["field"] == "said"
    assert live.http.post(f"{path}/blind/answer", json={"said": "m+5", "confidence": 1}).status_code == 403
    other = ada.ask("POST", "/api/v1/benches", json={"scenario": "first-look"})
    assert other.status_code == 409 and "give up" in other.json()["error"]["hint"]
    said = ada.ask("POST", f"{path}/blind/answer", json={"said": truth["Ada"], "confidence": 1}).json()
    assert (said["points"], said["state"], set(said["verdicts"])) == (100.0, "answered", {"kalman"})
    assert ada.ask("GET", f"{path}/digest").status_code == 200
    assert ada.ask("GET", path).json()["blind"] is None
    assert ada.ask("POST", f"{path}/blind/answer", json={"said": "m+5", "confidence": 1}).status_code == 409
    assert ada.ask("GET", f"{path}/blind").json()["answers"] == [said]
    assert ben.ask("GET", f"/api/v1/benches/{ben.bench}/blind").json()["answers"] == []
    wrong = "m+5" if truth["Ben"] == "healthy" else "healthy"
    lost = ben.ask("POST", f"/api/v1/benches/{ben.bench}/blind/answer", json={"said": wrong, "confidence": 1}).json()
    assert lost["points"] == pytest.approx(-140.0)  # 100 (1 - 6/5 * 2)
    tiles = live.http.get(f"/api/v1/classes/{group['id']}/members").json()["members"]
    assert [tile["blind"]["points"] for tile in tiles] == [100.0, pytest.approx(-140.0)]
    assert answers(live, group)["hidden"] == 0
    assert [one.said for one in live.service.blinds.of_person(ben.id)] == [wrong]
    assert other.status_code == 409 and ada.ask("POST", "/api/v1/benches", json={"scenario": "first-look"}).is_success


def test_the_answer_says_what_a_sweep_shows_with_the_fault_and_without(live: Live) -> None:
    moved = {}
    for seed in range(40):
        bench = live.bench("first-look", paused=True)["id"]
        live.http.post(f"/api/v1/benches/{bench}/blind", json={"seed": seed})
        path = f"/api/v1/benches/{bench}/blind"
        shown = live.http.delete(path).json()
        moved[shown["truth"]] = {name: shown["faulty"][name] / value for name, value in shown["healthy"].items()}
        device = live.service.benches.get(bench).board.spec.quoted
        assert shown["healthy"]["f0_hz"] == pytest.approx(device["f0_hz"])
        assert shown["healthy"]["rest_um_per_v"] == pytest.approx(abs(device["static_gain_um_per_v"]))
        if moved.keys() >= {"healthy", "m+10", "k+10", "b+30"}:
            break
    names = ("f0_hz", "quality_factor", "rest_um_per_v")
    found = {truth: [ratios[name] for name in names] for truth, ratios in moved.items()}
    assert found["healthy"] == [1.0, 1.0, 1.0]
    assert found["m+10"] == pytest.approx([1.1**-0.5, 1.1**0.5, 1.0])
    assert found["k+10"] == pytest.approx([1.1**0.5, 1.1**0.5, 1 / 1.1])
    assert found["b+30"] == pytest.approx([1.0, 1 / 1.3, 1.0])
    assert moved["b+30"]["peak_um_per_v"] < 1.0


def test_the_teacher_reveals_for_all_and_is_not_blind(live: Live, group: dict[str, Any]) -> None:
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    hide(live, group, ada, ben)
    before = answers(live, group)["answers"]
    assert live.http.get(f"/api/v1/benches/{ada.bench}/digest").status_code == 200
    assert ada.ask("DELETE", f"/api/v1/benches/{ada.bench}/blind").json()["points"] == 0.0  # gave up
    assert live.http.delete(f"/api/v1/classes/{group['id']}/blind").json() == {"done": 1, "failed": []}
    after = answers(live, group)
    assert after["hidden"] == 0 and [one["state"] for one in after["answers"]] == ["revealed"] * 2
    assert [one["truth"] for one in after["answers"]] == [one["truth"] for one in before]
    assert ben.ask("GET", f"/api/v1/benches/{ben.bench}/scenario").status_code == 200


def test_what_replaces_a_blind_bench_reveals_it(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    hide(live, group, ada)
    live.http.post(f"/api/v1/classes/{group['id']}/scenario", json={"scenario": "first-look"})
    assert [one["state"] for one in answers(live, group)["answers"]] == ["revealed"]
    live.http.delete(f"/api/v1/classes/{group['id']}")
    assert live.service.blinds.of_class(group["id"]) == []
    group |= open_class(live)  # for the fixture to end


def test_pages_come_back_to_what_may_be_seen_now(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    hide(live, group, ada)
    with ada.stream() as stream:
        assert stream.until_type("hello")["bench"]["blind"] is not None
        ada.ask("DELETE", f"/api/v1/benches/{ada.bench}/blind")
        assert closed_with(stream) == CLOSE_TURNED
    with ada.stream() as stream:
        assert stream.until_type("hello")["bench"]["blind"] is None


def test_a_diagnoser_may_be_what_is_asked_about(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    hide(live, group, ada, shows=True)
    bench = ada.ask("GET", f"/api/v1/benches/{ada.bench}").json()
    names = {signal["name"] for signal in bench["signals"]}
    assert {"kalman.winner", "kalman.probability.m+5", "kalman.residual.healthy"} <= names
    assert not names & {"kalman.truth", "kalman.correct_fraction", "kalman.delay", "kalman.false_switches"}
    assert set(bench["diagnosers"]) == {"kalman"} and bench["scores"] == {}


def test_what_has_no_bank_or_no_resonator_is_refused(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    names = ("gyro-diagnosis", "ch5-flops", "ch1-step", "no-such")
    assert [name for name in names if "error" not in hide(live, group, scenario=name)] == []
    assert ada.me()["bench"] == ada.bench


def test_alone_the_page_is_blind_too_and_the_same_seed_hides_the_same(live: Live) -> None:
    def scheduled() -> float:
        return sum(map(float, re.findall(r'events_total\{kind="scheduled"\} (\S+)', live.http.get("/metrics").text)))

    truths = []
    for seed in (7, 7, 8, 9):
        bench = live.bench("first-look")["id"]
        path = f"/api/v1/benches/{bench}"
        live.command(bench, fault="damping", severity=0.5)
        before = scheduled()
        with live.stream(bench) as stream:
            stream.until_type("hello")
            assert live.http.post(f"{path}/blind", json={"seed": seed}).status_code == 201
            assert closed_with(stream) == CLOSE_TURNED
            said = [event["kind"] for event in stream.events]
        assert "scheduled" not in said and "heal" not in said  # nothing came before it was closed
        assert live.http.post(f"{path}/blind", json={"seed": seed}).status_code == 409
        assert live.get(bench)["faults"] == [] and live.http.get(f"{path}/scenario").status_code == 403
        listed = live.http.get("/api/v1/benches").json()["benches"]
        assert [one["seed"] for one in listed if one["id"] == bench] == [0]
        assert live.http.post("/api/v1/links", json={"bench": bench}).json()["error"]["code"] == "blind"
        assert scheduled() == before  # the number of events tells nothing either
        shown = live.http.delete(f"{path}/blind").json()
        truths.append((shown["truth"], (shown["came_tick"] or 0) > 0))
        assert live.http.get(f"{path}/scenario").status_code == 200
    assert truths[0] == truths[1] and len({truth for truth, _ in truths}) > 1


def test_a_gyroscope_hides_faults_of_its_own(live: Live) -> None:
    bench = live.bench("gyro-diagnosis", paused=True)["id"]
    found = set()
    for seed in (0, 1, 2, 4):
        live.http.post(f"/api/v1/benches/{bench}/blind", json={"seed": seed})
        signals = {one["name"] for one in live.get(bench)["signals"]}
        assert {"sensor.x.displacement", "drive.x.force"} <= signals and "plant.x" not in signals
        found.add(live.http.delete(f"/api/v1/benches/{bench}/blind").json()["truth"])
        waiting = [entry["command"]["fault"] for entry in live.get(bench)["pending"]]
        assert set(waiting) <= {"quadrature", "drive_loss", "sense_stiffness", "damping"}
    assert len(found) > 2


def test_a_trip_says_only_that_the_board_has_stopped(live: Live) -> None:
    bench = live.bench("first-look", time_scale=None)["id"]
    live.http.post(f"/api/v1/benches/{bench}/blind", json={"seed": 3})
    session = live.service.benches.get(bench)
    assert live.command(bench, "time_scale", value=0.1).status_code == 200
    trips = parse_command({"fault": "short_circuit", "severity": 1.0})
    live.service.engine.submit(session.board.apply, trips, "board").result(10)
    advance(live, bench=bench, ticks=2_000)
    assert live.get(bench)["state"] == "tripped"
    trip = live.get(bench)["trip"]
    assert (trip["reason"], trip["signal"], trip["value"]) == (STOPPED, "", None)
    assert session.board.trip.reason != STOPPED
    refused = live.command(bench, "start").json()["error"]
    assert refused["message"] == STOPPED and refused["code"] == "tripped"
    events = live.http.get(f"/api/v1/benches/{bench}/events").json()["events"]
    assert [one["text"] for one in events if one["kind"] == "tripped"] == [STOPPED]
    live.http.delete(f"/api/v1/benches/{bench}/blind")
    assert live.get(bench)["trip"]["reason"] == session.board.trip.reason


ROLES = ("teacher", "student", "watcher")


@pytest.mark.parametrize("role", ROLES)
def test_every_door_by_role_while_blind(
    live: Live, group: dict[str, Any], role: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    compute_nothing(monkeypatch)
    ada = join(live, group, "Ada")
    hide(live, group, ada)
    guest = watcher(live, ada.bench)
    somebody = {"teacher": the_teacher(live), "student": ada, "watcher": guest}[role]
    blind = set()
    for (method, path), need in DOORS.items():
        if method == SOCKET or (method, path) in ENDING or "/join" in path or (role == "teacher" and method != "GET"):
            continue
        filled = path.replace("{bench_id}", ada.bench).replace("{name}", "kalman").replace("{", "").replace("}", "")
        answer = somebody.ask(method, filled, **({} if method == "GET" else {"json": []}))
        if answer.status_code == 403 and answer.json()["error"]["code"] == "blind":
            blind.add((method, path))
        elif role != "teacher" and (method, path) not in OPEN_WHILE_BLIND and need is not Need.NOTHING:
            assert answer.status_code == 403, (method, path)
    mine = {Need.SESSION, Need.WATCH}
    mine |= {Need.DRIVE, Need.MAY_DRIVE, Need.MEMBER} if role == "student" else set()
    closed = {door for door, need in DOORS.items() if need in mine} - OPEN_WHILE_BLIND
    assert blind == (set() if role == "teacher" else {door for door in closed if door[0] != SOCKET})


def test_the_scene_by_role_while_blind(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    hide(live, group, ada)
    people, path = [the_teacher(live), ada, watcher(live, ada.bench)], f"/benches/{ada.bench}/3d"
    assert [code_of(one, path, SCENE) for one in people] == [0, 4403, 4403]
    for one in people[1:]:
        with one.stream(ada.bench) as stream:
            assert stream.until_type("hello")["bench"]["view3d"] is None


def test_the_teacher_freezes_blind_benches_and_leaves_the_fault_alone(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    hide(live, group, ada)
    path = f"/api/v1/classes/{group['id']}/commands"
    assert live.http.post(path, json={"command": {"kind": "pause"}}).json()["done"] == 1
    assert live.http.post(path, json={"command": {"heal": "all"}}).json()["done"] == 0
    assert live.http.post(path, json={"command": {"kind": "start"}}).json()["done"] == 1
    assert advance(live, bench=ada.bench, ticks=5)[ada.bench] >= 5


def test_a_device_is_drawn_from_the_process() -> None:
    device = get("ch5-seven-step").spec.device
    drawn = [device_of(device, seed) for seed in range(200)]
    assert drawn[3] == device_of(device, 3)
    mass = [one["device.mass_kg"] / device.mass_kg for one in drawn]
    # thickness 2 um +- 0.05 um alone moves the mass by 2.5 %; three deviations of everything stay within 10 %
    assert 0.9 < min(mass) < 0.97 and 1.03 < max(mass) < 1.1
    assert set(drawn[0]) == {f"device.{name}" for name in ("mass_kg", "damping_ns_m", "stiffness_n_m", "force_n_per_v")}
