"""A class from its opening to its end, through the doors that the teacher and the students use."""

from __future__ import annotations

import contextlib
import re
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed

from server.api.gate import REQUESTS_AT_ONCE, REQUESTS_PER_S
from server.classroom.joining import join_page
from server.errors import ErrorBody
from server.store.base import now
from tests.server.classroom.group import Somebody, advance, closed_with, join, open_class, tried, watcher
from tests.server.conftest import Live

MASS = {"fault": "added_mass", "severity": 0.05}


def refused(live: Live, group: dict[str, Any], code: str, name: str = "Eve") -> dict[str, Any]:
    answer = tried(live, group, name, code=code)
    return {"status": answer.status_code, **answer.json()["error"]}


def later(patch: pytest.MonkeyPatch, module: str, **by: float) -> None:
    """Let a module of the server read a later date."""
    patch.setattr(f"server.classroom.{module}.now", lambda: now() + timedelta(**by))


def test_a_student_joins_by_the_form_and_finds_a_bench_of_ones_own(live: Live, group: dict[str, Any]) -> None:
    with live.anonymous(headers={"Origin": live.address, "Accept": "text/html"}) as browser:
        form = browser.get(group["path"])
        assert form.headers["referrer-policy"] == "same-origin"  # else a browser posts it with `Origin: null`
        assert form.status_code == 200 and f'value="{group["path"].partition("=")[2]}"' in form.text
        sent = browser.post("/join", data={"code": group["code"], "name": "  Grace \n Hopper "})
        assert sent.status_code == 303 and sent.headers["location"] == "/"
        assert "HttpOnly" in sent.headers["set-cookie"] and "SameSite=strict" in sent.headers["set-cookie"]
        me = browser.get("/api/v1/me").json()
        assert me["role"] == "student" and me["name"] == "Grace Hopper" and me["class_name"] == "Tuesday"
        assert browser.get("/api/v1/me").json()["bench"] == me["bench"]  # made once
        assert browser.get(f"/api/v1/benches/{me['bench']}").json()["state"] == "running"
    assert live.http.get("/api/v1/me").json()["role"] == "teacher"


def test_a_code_is_read_as_people_type_it(live: Live, group: dict[str, Any]) -> None:
    code = group["code"]
    typed = [code.lower(), code.upper(), code.replace(" ", "-"), f" {code} "]
    assert all(join(live, group, f"Ada {number}", code=one).bench for number, one in enumerate(typed))


def test_a_code_that_is_wrong_old_or_over_opens_nothing(
    live: Live, group: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    old, path = group["code"], f"/api/v1/classes/{group['id']}"
    assert refused(live, group, old[:-1] + ("2" if old[-1] != "2" else "3"))["code"] == "wrong_code"
    assert refused(live, group, old[:4])["code"] == "wrong_code"
    assert refused(live, group, f"xxxx{old[4:]}")["field"] == "code"
    new = live.http.post(f"{path}/code", json={"minutes": 2}).json()
    assert refused(live, group, old)["code"] == "wrong_code"
    with monkeypatch.context() as patch:
        later(patch, "classes", minutes=1)
        assert join(live, new, "Ada").bench
        later(patch, "classes", minutes=2)
        assert refused(live, group, new["code"])["code"] == "wrong_code"
    last = live.http.post(f"{path}/code", json={}).json()
    live.http.delete(f"{path}/code")
    assert refused(live, group, last["code"])["code"] == "wrong_code"
    assert live.http.get(path).json()["code"] is None


def test_a_form_with_anything_in_it_is_answered_by_the_form(live: Live) -> None:
    bodies = (b"", b"&" * 3000, b"a=1&" * 3000, b"%ff=%fe", b"code=" + b"x" * 100_000, b"\xff\x00")
    with live.anonymous(headers={"Origin": live.address}) as browser:
        answers = [browser.post("/join", content=body) for body in bodies]
    assert [(answer.status_code, "<form" in answer.text) for answer in answers] == [(403, True)] * len(bodies)


def test_names_are_one_to_a_class_and_no_accounts(live: Live, group: dict[str, Any]) -> None:
    join(live, group, "Ada")
    assert refused(live, group, group["code"], "ADA")["status"] == 409
    assert refused(live, group, group["code"], "\uff21da")["status"] == 409  # the same letters, another width
    for bad in ("", " \t", "x" * 41, "board", "Page 7", "api 127.0.0.1", "TEACHER", "\u202escenario"):
        assert refused(live, group, group["code"], bad)["field"] == "name", bad
    other = open_class(live, "Wednesday")
    assert join(live, other, "Ada").bench
    live.http.delete(f"/api/v1/classes/{other['id']}")


def test_tries_are_limited(live: Live, group: dict[str, Any]) -> None:
    def statuses(count: int) -> list[int]:
        return [refused(live, group, f"{group['id']}xxxxxxxx")["status"] for _ in range(count)]

    assert statuses(14) == [403] * 8 + [429] * 6
    assert join(live, group, "Ada").bench  # a right code never pays for wrong ones
    with live.anonymous(headers={"Accept": "text/html"}) as browser:
        page = browser.get("/watch/guessed")
    assert page.status_code == 429 and "Too many tries" in page.text and page.headers["Retry-After"]
    advance(live, seconds=5.5)
    assert statuses(2) == [403, 429]


def test_a_student_who_is_sent_away_is_gone_from_sockets(live: Live, group: dict[str, Any]) -> None:
    student = join(live, group, "Ada")
    with student.stream() as stream:
        stream.until_type("hello")
        assert live.http.delete(f"/api/v1/classes/{group['id']}/members/{student.id}").status_code == 204
        assert closed_with(stream) == 4401
    assert student.ask("GET", "/api/v1/me").status_code == 401
    assert live.http.get(f"/api/v1/benches/{student.bench}").status_code == 404


def test_a_link_to_watch_ends_when_the_teacher_says_so_or_its_time_is_over(
    live: Live, group: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    student = join(live, group, "Ada")
    guest, brief = watcher(live, student.bench), watcher(live, student.bench, hours=0.1)
    with live.anonymous(headers={"Accept": "text/html"}) as browser:
        assert browser.get(f"/watch/{guest.secret}").status_code == 303
        me = {name: value for name, value in browser.get("/api/v1/me").json().items() if value}
        assert me == {"id": guest.id, "role": "watcher", "name": "watcher", "bench": student.bench}
    with monkeypatch.context() as patch:
        later(patch, "people", hours=0.2)
        assert [one.ask("GET", "/api/v1/me").status_code for one in (guest, brief)] == [200, 401]
    with guest.stream() as stream:
        stream.until_type("hello")
        live.http.delete(f"/api/v1/benches/{student.bench}/watchers/{guest.id}")
        assert closed_with(stream) == 4401
    with live.anonymous() as browser:
        refused = browser.get(f"/watch/{guest.secret}")
    assert (refused.status_code, refused.json()["error"]["code"]) == (403, "wrong_link")


def test_the_teacher_sees_and_moves_all_benches(live: Live, group: dict[str, Any]) -> None:
    students = [join(live, group, name) for name in ("Ada", "Ben", "Cy")]
    path, last = f"/api/v1/classes/{group['id']}", students[2].bench
    assert live.http.post(f"{path}/commands", json={"command": {"kind": "pause"}}).json() == {"done": 3, "failed": []}
    assert live.command(last, "step", ticks=501).status_code == 200
    some = {"command": MASS, "members": [students[1].id]}
    assert live.http.post(f"{path}/commands", json=some).json()["done"] == 1
    students[0].ask("PUT", "/api/v1/me/hand", json={"raised": True})
    tiles = live.http.get(f"{path}/members").json()["members"]
    assert [(tile["name"], tile["state"], tile["hand"]) for tile in tiles] == [
        ("Ada", "paused", True), ("Ben", "paused", False), ("Cy", "paused", False)
    ]  # fmt: skip
    assert [[one["name"] for one in tile["faults"]] for tile in tiles] == [[], ["added_mass"], []]
    assert tiles[0]["verdicts"] == []  # it has judged no sample
    assert tiles[2]["verdicts"][0]["diagnoser"] == "kalman" and tiles[2]["verdicts"][0]["factors"]["healthy"] == {}
    assert tiles[2]["time_ms"] >= 5.0 and len(tiles[2]["trace"]) == 48
    columns = list(zip(*tiles[2]["trace"], strict=True))
    asked = {"signals": "plant.displacement", "start_tick": live.get(last)["tick"] - 400, "format": "csv"}
    trace = live.http.get(f"/api/v1/benches/{last}/trace", params=asked)
    samples = [float(line.split(",")[-1]) for line in trace.text.strip().splitlines()[1:]]
    assert max(columns[1]) == pytest.approx(max(samples), rel=1e-3, abs=1e-4)
    wrong = live.http.post(f"{path}/commands", json={"command": {"kind": "pause"}, "members": ["nobody"]}).json()
    assert wrong["error"]["field"] == "members.0"


def test_a_scenario_begins_on_all_benches_or_on_none(live: Live, group: dict[str, Any]) -> None:
    students = [join(live, group, name) for name in ("Ada", "Ben")]
    path = f"/api/v1/classes/{group['id']}/scenario"
    assert live.http.post(path, json={"scenario": "no-such"}).status_code == 422
    assert [one.me()["bench"] for one in students] == [one.bench for one in students]
    done = live.http.post(path, json={"scenario": "ch5-seven-step", "paused": True})
    assert done.json() == {"done": 2, "failed": []}
    for student in [*students, join(live, group, "Cy")]:
        bench = live.get(student.me()["bench"])
        assert bench["scenario_id"] == "ch5-seven-step" and bench["state"] == "paused"
    assert live.http.get(f"/api/v1/benches/{students[0].bench}").status_code == 404  # the one before was closed


def test_a_student_has_one_bench_and_takes_no_room_from_the_teacher(serve: Any) -> None:
    with serve(max_benches=1, max_students=2, clock="manual") as live:
        group = open_class(live)
        ada = join(live, group, "Ada")
        join(live, group, "Ben")
        assert refused(live, group, group["code"], "Cy")["code"] == "limit"
        live.bench("first-look")
        second = ada.ask("POST", "/api/v1/benches", json={"scenario": "ch5-seven-step"})
        assert second.status_code == 201
        assert ada.me()["bench"] == second.json()["id"]
        assert live.http.get(f"/api/v1/benches/{ada.bench}").status_code == 404
        assert second.json()["history_ticks"] < live.http.get("/api/v1/benches").json()["benches"][0]["history_ticks"]


def test_what_people_did_survives_the_bench_and_ends_with_the_class(live: Live) -> None:
    group = open_class(live)
    ada = join(live, group, "Ada")
    with ada.stream() as stream:
        tick = stream.command(**MASS)["tick"]
    ada.ask("POST", f"/api/v1/benches/{ada.bench}/commands", json={"kind": "pause"})
    live.http.delete(f"/api/v1/classes/{group['id']}/members/{ada.id}")
    done = live.http.get(f"/api/v1/benches/{ada.bench}/audit").json()["entries"]
    kinds = [(entry["actor"], entry["kind"], entry["tick"]) for entry in done]
    assert ("Ada", "inject", tick) in kinds and "pause" in [kind for actor, kind, _ in kinds if actor == "Ada"]
    whole = live.http.get(f"/api/v1/classes/{group['id']}/audit").json()["entries"]
    assert {"class", "joined", "removed"} <= {entry["kind"] for entry in whole}
    assert [entry["at"] for entry in whole] == sorted((entry["at"] for entry in whole), reverse=True)
    live.http.delete(f"/api/v1/classes/{group['id']}")
    assert live.http.get(f"/api/v1/benches/{ada.bench}/audit").json()["entries"] == []
    assert live.http.get(f"/api/v1/classes/{group['id']}/audit").status_code == 404


def test_sessions_survive_a_restart_no_secret_is_on_the_disk_and_a_class_ends_by_itself(
    serve: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "kept"
    with serve(folder=folder, clock="manual") as live:
        group = open_class(live, hours=1.0)
        ada = join(live, group, "Ada Lovelace")
        guest = watcher(live, ada.bench)
    written = b"".join(path.read_bytes() for path in folder.rglob("*") if path.is_file())
    code = group["code"].replace(" ", "").lower()[4:]
    assert b"Ada Lovelace" in written
    assert not [one for one in (ada.secret, guest.secret, code, code.upper()) if one.encode() in written]
    with serve(folder=folder, clock="manual") as live:
        again = Somebody(live, ada.secret)
        me = again.me()
        assert me["name"] == "Ada Lovelace" and live.get(me["bench"])["state"] == "running"
        assert join(live, group, "Ben").bench  # the code lets students in still
        assert live.http.get(f"/api/v1/classes/{group['id']}").json()["code"] is None  # but only its hash is known
        live.http.post(f"/api/v1/classes/{group['id']}/commands", json={"command": {"kind": "pause"}})
        advance(live, seconds=30.0)
        assert len(live.http.get("/api/v1/classes").json()["classes"]) == 1
        later(monkeypatch, "classes", hours=1.1)
        advance(live, seconds=30.0)
        assert live.http.get("/api/v1/classes").json()["classes"] == []
        assert again.ask("GET", "/api/v1/me").status_code == 401
        assert live.http.get(f"/api/v1/benches/{me['bench']}").status_code == 404
        rows = live.service.database.transact(
            lambda session: [
                list(session.connection().exec_driver_sql(f"SELECT * FROM {table}"))
                for table in ("classes", "people", "audit")
            ]
        )
    assert rows == [[], [], []]


def test_the_addresses_to_join_are_those_that_students_can_open(serve: Any, live: Live, group: dict[str, Any]) -> None:
    assert group["addresses"] == []  # no other machine can reach loopback
    with serve(public_origin="https://lab.example/bench") as live:
        headers = {"Host": "lab.example", "Origin": "https://lab.example"}
        made = live.http.post("/api/v1/classes", json={"name": "Proxy"}, headers=headers).json()
        assert made["addresses"] == [f"https://lab.example/bench{made['path']}"]


def test_a_student_cannot_take_the_machine_from_the_others(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    path = f"/api/v1/benches/{ada.bench}/commands"
    fast = ada.ask("POST", path, json={"kind": "time_scale", "value": 1.0})
    assert fast.status_code == 422 and fast.json()["error"]["field"] == "value"
    assert "200 ms/s" in fast.json()["error"]["message"]  # 20 000 ticks a second of 10 us
    assert ada.ask("POST", path, json={"kind": "time_scale", "value": 0.2}).status_code == 200
    bench = ada.ask("POST", "/api/v1/benches", json={"scenario": "first-look", "time_scale": 1.0}).json()
    assert bench["time_scale"] == pytest.approx(0.2)
    advance(live, bench=bench["id"], ticks=6001)
    session = live.service.benches.get(bench["id"])
    past = live.service.engine.submit(lambda: session.journal(with_past=True)).result(10).past
    assert past.end_tick - past.first_tick == 2000  # a jump keeps little
    with contextlib.ExitStack() as pages:
        for _ in range(8):
            pages.enter_context(ada.stream(bench["id"])).until_type("hello")
        with ada.stream(bench["id"]) as ninth, pytest.raises(ConnectionClosed) as closed:
            ninth.step()
        assert closed.value.rcvd is not None and closed.value.rcvd.code == 1013


def test_a_student_who_asks_without_end_has_to_wait(live: Live, group: dict[str, Any]) -> None:
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    with live.anonymous(headers=ada.headers) as client:
        said = [client.get("/api/v1/me/layout").status_code for _ in range(REQUESTS_AT_ONCE + 2)]
        assert said == [404] * REQUESTS_AT_ONCE + [429] * 2
        assert ben.ask("GET", "/api/v1/me").status_code == 200  # the others notice nothing
        assert live.http.get("/api/v1/me").status_code == 200
        advance(live, seconds=0.1)
        said = [client.get("/api/v1/me/layout").status_code for _ in range(int(0.1 * REQUESTS_PER_S) + 2)]
    assert said[0] == 404 and said[-1] == 429


def test_a_refusal_to_join_says_what_to_do_and_gives_the_keys_to_its_field() -> None:
    wrong = ErrorBody(code="wrong_code", message="no class is open under this code", field="code", hint="ask again")
    page = join_page("/join", "ABCD", "Ada", wrong)
    assert ">No class is open under this code. Ask again.<" in page
    assert re.search(r'name="code"[^>]* autofocus', page) and not re.search(r'name="name"[^>]* autofocus', page)
    short = ErrorBody(code="invalid", message="needs 1 to 40 characters", field="name", hint="")
    page = join_page("/join", "ABCD", "", short)
    assert ">Name needs 1 to 40 characters.<" in page and re.search(r'name="name"[^>]* autofocus', page)
