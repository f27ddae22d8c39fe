"""A server that ends in mid-class: students come back to their benches, which continue bit for bit."""

from __future__ import annotations

import json
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenarios.run import build
from scenarios.schema import Scenario
from tests.server.classroom.group import Somebody, advance, join, open_class, the_teacher
from tests.server.conftest import Live

LEFT_OR_KILLED = ["left", pytest.param("killed", marks=pytest.mark.long)]
Servers = list[AbstractContextManager[Live]]


def got(somebody: Somebody, path: str) -> Any:
    answer = somebody.ask("GET", path)
    assert answer.status_code == 200, answer.text
    return answer.json()


@pytest.mark.parametrize("servers", [*LEFT_OR_KILLED, "stopped"], indirect=True)
def test_students_come_back_to_their_benches(servers: Servers) -> None:
    first, second = servers
    with first as live:
        group = open_class(live)
        path, teacher = f"/api/v1/classes/{group['id']}", the_teacher(live)
        students = [join(live, group, name) for name in ("Ada", "Ben", "Cy")]
        ada = f"/api/v1/benches/{students[0].bench}"
        for command in (
            {"fault": "added_mass", "severity": 0.05},
            {"switch": "mrac"},
            {"set": {"reference.amplitude_v": 9}},
            {"fault": "shock", "severity": 0.1, "at_ms": 1e5},
        ):
            assert students[0].ask("POST", f"{ada}/commands", json=command).is_success
            advance(live, seconds=0.05)
        own = live.http.post("/api/v1/benches", json={"scenario": "first-look"}).json()["id"]
        bench = f"/api/v1/benches/{own}"
        given = {"name": "mine", "layout": {"dock": {}, "large": True, "axes": False}}
        for answer in (
            live.http.put(f"{path}/shown", json={"bench": own}),
            live.http.put(f"{path}/layout", json=given),
            live.http.post(f"{bench}/driving", json={"do": "hand_over", "to": students[2].id}),
        ):
            assert answer.is_success
        seen = [one.me() for one in students]
        advance(live, seconds=1.0)  # checkpoints are less than a second old
        shown, before = got(teacher, bench), [got(teacher, f"/api/v1/benches/{one.bench}") for one in students]
        events = got(teacher, f"{ada}/events")["events"]

    with second as live:
        teacher = the_teacher(live)
        back = [Somebody(live, one.secret, one.bench) for one in students]
        assert back[2].ask("POST", f"{bench}/commands", json={"switch": "mrac"}).is_success
        assert [one.me() for one in back] == seen
        assert [me["shown"] for me in seen] == [own] * 3 and [me["lent"] for me in seen] == [None, None, own]
        assert got(back[0], "/api/v1/me/layout") == {"id": seen[0]["layout"], **given}
        now = got(back[0], bench)
        assert now["state"] == "running" and now["created"] == shown["created"] and now["controller"] == "mrac"
        assert now["tick"] >= shown["tick"] - 200 and got(teacher, path)["shown"] == own
        for one, was in zip(back, before, strict=True):
            now = got(one, f"/api/v1/benches/{one.bench}")
            assert now["state"] == "running" and now["seed"] == was["seed"] and now["created"] == was["created"]
            assert now["tick"] >= was["tick"] - 100_000 * 0.002 * 1.0  # a second of device time at this scale
        now = got(teacher, ada)
        assert [fault["name"] for fault in now["faults"]] == ["added_mass"] and now["controller"] == "mrac"
        assert len(now["pending"]) == 1 and now["parameters"]["reference"]["amplitude_v"] == 9
        again = got(teacher, f"{ada}/events")["events"]
        assert again[: len(events)] == events  # the log is complete and continues
        advance(live, seconds=0.2)
        assert back[0].ask("POST", f"{ada}/commands", json={"kind": "pause"}).is_success
        saved, digest = teacher.ask("GET", f"{ada}/scenario").text, got(teacher, f"{ada}/digest")

    # a straight run from tick 0 has the same bits
    board = build(Scenario.load(saved))
    while board.tick < digest["tick"]:
        board.advance(digest["tick"] - board.tick)
    board.apply_due()
    assert board.digest() == digest["digest"] and digest["tick"] > before[0]["tick"] - 200


def test_files_that_a_crash_has_torn_or_lost_do_no_harm(serve: Any, tmp_path: Path, caplog: Any) -> None:
    folder = tmp_path / "data"
    with serve(folder=folder, clock="manual") as live:
        group = open_class(live)
        ada, ben, cy = (join(live, group, name) for name in ("Ada", "Ben", "Cy"))
        lost = live.bench("first-look")["id"]
        live.http.put(f"/api/v1/classes/{group['id']}/shown", json={"bench": lost})
        live.http.post(f"/api/v1/benches/{lost}/driving", json={"do": "hand_over", "to": ada.id})
        assert ada.me()["shown"] == ada.me()["lent"] == lost
        assert ada.ask("POST", f"/api/v1/benches/{ada.bench}/commands", json={"kind": "pause"}).is_success
        last = live.get(ada.bench)["last_event"]
    benches = folder / "benches"
    with (benches / f"{ada.bench}.events").open("a") as file:
        file.write('{"seq": 99, "tick": 5, "ac')
    torn = benches / f"{ben.bench}.npz"
    torn.write_bytes(torn.read_bytes()[:1000])
    with np.load(benches / f"{cy.bench}.npz") as file:
        arrays = dict(file)
    document = json.loads(arrays["document"].tobytes())
    arrays["document"] = np.frombuffer(json.dumps({**document, "version": "older"}).encode(), np.uint8)
    np.savez(benches / f"{cy.bench}.npz", **arrays)
    (benches / f"{lost}.npz").unlink()
    for turn in (1, 2):  # the second start finds nothing of it either
        with serve(folder=folder, clock="manual") as live:
            me = [Somebody(live, one.secret).me() for one in (ada, ben, cy)]
            assert me[0]["bench"] == ada.bench and live.get(ada.bench)["state"] == "paused"
            assert live.get(ada.bench)["last_event"] == last + turn  # opened again
            for now, was in zip(me[1:], (ben, cy), strict=True):
                assert now["bench"] != was.bench and live.get(now["bench"])["state"] == "running"
            assert {one[what] for one in me for what in ("shown", "lent")} == {None}
            assert live.http.get(f"/api/v1/classes/{group['id']}").json()["shown"] is None
            assert Somebody(live, ada.secret).ask("GET", f"/api/v1/benches/{lost}").status_code == 403
            live.wait(lambda: lost not in {path.stem for path in benches.iterdir()})  # once all that can come have come
    assert "was kept by version older" in caplog.text


def test_the_files_of_a_bench_go_with_it(live: Live) -> None:
    group = open_class(live)
    ids = [join(live, group, name) for name in ("Ada", "Ben")]
    advance(live, seconds=0.7)

    def kept() -> list[bool]:
        there = {path.stem for path in (live.service.settings.data / "benches").iterdir()}
        return [one.bench in there for one in ids]

    assert kept() == [True, True]
    live.http.delete(f"/api/v1/classes/{group['id']}/members/{ids[0].id}")
    assert kept() == [False, True]
    live.http.delete(f"/api/v1/classes/{group['id']}")
    assert kept() == [False, False]


@pytest.mark.parametrize("servers", LEFT_OR_KILLED, indirect=True)
def test_a_blind_bench_comes_back_blind_and_answers_stay(servers: Servers) -> None:
    first, second = servers
    with first as live:
        group = open_class(live)
        path = f"/api/v1/classes/{group['id']}/blind"
        students = [join(live, group, name) for name in ("Ada", "Ben")]
        assert live.http.post(path, json={}).json()["done"] == 2
        benches = [f"/api/v1/benches/{one.me()['bench']}" for one in students]
        asked, events = got(students[0], benches[0])["blind"], got(students[0], f"{benches[0]}/events")["events"]
        answer = {"said": "m+5", "confidence": 0.7}
        said = students[1].ask("POST", f"{benches[1]}/blind/answer", json=answer).json()
        kept = got(the_teacher(live), path)

    with second as live:
        ada = Somebody(live, students[0].secret)
        assert f"/api/v1/benches/{ada.me()['bench']}" == benches[0]
        bench = got(ada, benches[0])
        assert bench["blind"] == asked and bench["faults"] == bench["pending"] == []
        assert got(ada, f"{benches[0]}/events")["events"][: len(events)] == events
        closed = ada.ask("GET", f"{benches[0]}/digest")
        assert closed.status_code == 403 and closed.json()["error"]["code"] == "blind"
        assert got(the_teacher(live), path) == kept and kept["hidden"] == 1 and said in kept["answers"]
        truth = next(one["truth"] for one in kept["answers"] if one["name"] == "Ada")
        right = ada.ask("POST", f"{benches[0]}/blind/answer", json={"said": truth, "confidence": 1.0}).json()
        assert right["points"] == 100.0 and len(got(ada, f"{benches[0]}/digest")["digest"]) == 64


@pytest.mark.parametrize("servers", ["left"], indirect=True)
def test_a_bench_is_there_for_who_asks_before_all_have_come_back(
    servers: Servers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From the first request on, and a bench that hides a fault hides it from then on too."""
    first, second = servers
    with first as live:
        group = open_class(live)
        ada, ben, cy = (join(live, group, name) for name in ("Ada", "Ben", "Cy"))
        assert ben.ask("POST", f"/api/v1/benches/{ben.bench}/blind", json={"seed": 1}).status_code == 201
        assert cy.ask("POST", f"/api/v1/benches/{cy.bench}/blind", json={"seed": 1}).status_code == 201
        advance(live, seconds=1.0)

    async def nothing(*_: Any) -> None:
        """Bring none back in the background."""

    monkeypatch.setattr("server.classroom.student_benches.StudentBenches.recover", nothing)
    with second as live:
        ada, ben, cy = (Somebody(live, one.secret, one.bench) for one in (ada, ben, cy))
        assert len(live.service.benches) == 0
        assert got(ada, f"/api/v1/benches/{ada.bench}")["id"] == ada.bench
        assert ben.ask("GET", f"/api/v1/benches/{ben.bench}/scenario").json()["error"]["code"] == "blind"
        assert cy.ask("GET", "/api/v1/recordings").json()["error"]["code"] == "blind"
        assert got(the_teacher(live), f"/api/v1/benches/{cy.bench}")["id"] == cy.bench
        assert ada.ask("GET", "/api/v1/benches/..%2f..").status_code in (403, 404)
