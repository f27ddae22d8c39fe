"""A lesson over the network: who drives, what all are shown, all benches at once, and what outlives a bench."""

from __future__ import annotations

from typing import Any

import pytest

from server.classroom.people import People
from tests.server.classroom.group import Somebody, advance, closed_with, join, on_loop, the_teacher, watcher
from tests.server.conftest import Live


def turn(who: Somebody, bench: str, do: str, to: str = "") -> Any:
    answer = who.ask("POST", f"/api/v1/benches/{bench}/driving", json={"do": do, **({"to": to} if to else {})})
    return answer.json() if answer.status_code != 200 else answer.json()["company"]


def test_one_drives_the_others_are_refused_by_rest_and_stream(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    them = the_teacher(live, ada.bench)
    path = f"/api/v1/benches/{ada.bench}"
    with ada.stream() as hers, them.stream(ada.bench) as theirs:
        hers.until(lambda m: isinstance(m, dict) and m["type"] == "status" and m["company"] is not None)
        refused = theirs.command("pause")
        assert refused["error"] | {"field": ""} == {
            "code": "driving",
            "message": "Ada drives this bench",
            "field": "",
            "hint": "take it back, or ask for it",
        }
        for method, door in (("POST", "commands"), ("POST", "snapshots"), ("POST", "recordings")):
            answer = them.ask(method, f"{path}/{door}", json={"kind": "pause"})
            assert (answer.status_code, answer.json()["error"]["code"]) == (409, "driving")
        assert hers.command("pause")["ok"]
        assert [one["id"] for one in turn(them, ada.bench, "ask")["asking"]] == ["teacher"]
        assert turn(ada, ada.bench, "hand_over", "teacher")["driver"]["name"] == "teacher"
        assert theirs.command("start")["ok"] and hers.command("pause")["error"]["code"] == "driving"
        assert turn(ada, ada.bench, "take")["driver"]["name"] == "Ada"
        assert turn(them, ada.bench, "take")["driver"]["name"] == "teacher"
        assert turn(ada, ada.bench, "take")["error"]["code"] == "driving"
        replaced = ada.ask("POST", "/api/v1/benches", json={"scenario": "first-look"})
        assert replaced.json()["error"]["code"] == "driving"
        # a command to all passes any driver
        live.http.post(f"/api/v1/classes/{group['id']}/commands", json={"command": {"kind": "pause"}})
        advance(live, seconds=1.0)
        theirs.until_type("ping")
        theirs.send(type="pong")
    said = [entry["text"] for entry in live.http.get(f"{path}/audit").json()["entries"]]
    assert {"took the bench", "was handed the bench by Ada", "asked Ada for the bench"} <= set(said)


@pytest.mark.parametrize("what", ["hold", "safe"])
def test_a_driver_whose_connection_is_cut_loses_the_bench(live: Live, group: dict[str, Any], what: str) -> None:
    ada = join(live, group, "Ada")
    wanted = {"scenario": "first-look", "set": {"without_driver": what}}
    bench = ada.ask("POST", "/api/v1/benches", json=wanted).json()["id"]
    them = the_teacher(live, bench)
    with ada.stream(bench) as hers, them.stream(bench) as theirs:
        for stream in (hers, theirs):
            stream.until_type("status")
        hers.connection.socket.shutdown(2)  # no close, as of a machine that is switched off
        theirs.until_type("status", watchers=1)
        assert theirs.command("pause")["error"]["code"] == "driving"
        advance(live, seconds=4.5)
        assert theirs.command("pause")["error"]["code"] == "driving"
        advance(live, seconds=1.5)
        event = theirs.until_event(kind="driving" if what == "hold" else "make_safe")
        assert "Ada, who drove, has not been heard for 5 s" in event["text"]
        assert live.get(bench)["state"] == ("running" if what == "hold" else "tripped")
        if what == "safe":
            assert live.get(bench)["trip"]["tick"] == event["tick"]
            assert theirs.command(reset_trip=True)["ok"]
            # a repetition of the history has the same bits
            toml = live.http.get(f"/api/v1/benches/{bench}/scenario").text
            digest = toml.partition("digest ")[2].split()[0]
            again = live.http.post("/api/v1/benches", json={"scenario": toml, "time_scale": None}).json()["id"]
            while live.get(again)["state"] != "paused":
                advance(live, seconds=0.1)
            assert live.http.get(f"/api/v1/benches/{again}/digest").json()["digest"] == digest
        assert theirs.command("pause")["ok"]


def test_the_teachers_bench_is_lent_to_a_student(live: Live, group: dict[str, Any]) -> None:
    own = live.bench("first-look")["id"]
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    them = the_teacher(live, own)
    with ada.stream() as hers, them.stream(own) as theirs:
        assert turn(them, own, "hand_over", ada.id)["driver"]["name"] == "Ada"
        hers.until_type("notice", code="ask_me")
        assert ada.me()["lent"] == own
        assert ben.ask("GET", f"/api/v1/benches/{own}").status_code == 403
        with ada.stream(own) as lent:
            assert lent.command("pause")["ok"] and theirs.command("start")["error"]["code"] == "driving"
            assert turn(them, own, "take")["driver"]["name"] == "teacher"
            assert closed_with(lent) == 4403
        hers.until_type("notice", code="ask_me")
        assert ada.me()["lent"] is None
        assert ada.ask("GET", f"/api/v1/benches/{own}").status_code == 403
    assert "not lent" in turn(them, ben.bench, "hand_over", ada.id)["error"]["message"]


def test_a_bench_is_shown_to_all_until_the_teacher_ends_it(live: Live, group: dict[str, Any]) -> None:
    own = live.bench("first-look")["id"]
    path = f"/api/v1/classes/{group['id']}"
    ada = join(live, group, "Ada")
    with ada.stream() as hers:
        assert live.http.put(f"{path}/shown", json={"bench": own}).status_code == 204
        hers.until_type("notice", code="ask_me")
    late = join(live, group, "Ben")
    for who in (ada, late):
        me = who.me()
        assert me["shown"] == own and me["bench"] == who.bench
    assert live.http.get(path).json()["shown"] == own
    with ada.stream(own) as shown:
        shown.until_type("hello")
        assert shown.command("pause")["error"]["code"] == "forbidden"
        assert ada.ask("POST", f"/api/v1/benches/{own}/driving", json={"do": "take"}).status_code == 403
        assert live.http.get(f"{path}/members").json()["members"][0]["watchers"] == 1  # she is present
        assert live.http.delete(f"{path}/shown").status_code == 204
        assert closed_with(shown) == 4403
    assert ada.ask("GET", f"/api/v1/benches/{own}").status_code == 403
    assert ada.me()["shown"] is None
    live.http.put(f"{path}/shown", json={"bench": own})
    live.http.delete(f"/api/v1/benches/{own}")
    assert ada.me()["shown"] is None
    assert live.http.put(f"{path}/shown", json={"bench": own}).json()["error"]["field"] == "bench"


def test_all_benches_start_together_from_tick_0(live: Live, group: dict[str, Any]) -> None:
    students = [join(live, group, name) for name in ("Ada", "Ben", "Cy")]
    path = f"/api/v1/classes/{group['id']}"
    ticks = advance(live, bench=students[2].bench, ticks=101)
    assert all(ticks[one.bench] > 100 for one in students)
    students[0].ask("POST", f"/api/v1/benches/{students[0].bench}/commands", json={"kind": "pause"})
    students[0].ask("POST", f"/api/v1/benches/{students[0].bench}/commands", json={"kind": "reset"})
    fault = {"fault": "added_mass", "severity": 0.05}
    students[0].ask("POST", f"/api/v1/benches/{students[0].bench}/commands", json=fault)
    answer = live.http.post(f"{path}/start", json={"members": [one.id for one in students[:2]]})
    assert answer.json() == {"done": 2, "failed": []}
    assert live.get(students[0].bench)["faults"] != []  # at tick 0 already, it keeps its settings
    live.http.post(f"{path}/commands", json={"command": {"kind": "pause"}})
    for one in students[:2]:
        events = one.ask("GET", f"/api/v1/benches/{one.bench}/events").json()["events"]
        start = next(event for event in reversed(events) if event["kind"] == "start")
        assert (start["tick"], start["actor"]) == (0, "teacher")
    assert live.http.post(f"{path}/start", json={"members": ["nobody"]}).json()["error"]["field"] == "members.0"


def test_a_layout_is_given_to_all_and_a_hand_is_lowered(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    path = f"/api/v1/classes/{group['id']}"
    assert ada.ask("GET", "/api/v1/me/layout").status_code == 404
    given = {"name": "mine", "layout": {"dock": {}, "large": True, "axes": False}}
    with ada.stream() as hers:
        assert live.http.put(f"{path}/layout", json=given).status_code == 204
        hers.until_type("notice", code="ask_me")
        me = ada.me()
        assert ada.ask("GET", "/api/v1/me/layout").json() == {"id": me["layout"], **given}
        assert live.http.delete(f"{path}/members/{ada.id}/hand").json()["error"]["code"] == "conflict"
        ada.ask("PUT", "/api/v1/me/hand", json={"raised": True})
        assert live.http.delete(f"{path}/members/{ada.id}/hand").status_code == 204
        hers.until_type("notice", code="ask_me")
        assert not ada.me()["hand"]


def test_a_link_to_watch_ends_with_its_bench(live: Live) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    guest = watcher(live, bench)
    with guest.stream() as stream:
        stream.until_type("hello")
        live.http.delete(f"/api/v1/benches/{bench}")
        assert closed_with(stream) == 4401
    assert guest.ask("GET", "/api/v1/me").status_code == 401


def test_recordings_of_earlier_benches_stay_in_sight(live: Live, group: dict[str, Any]) -> None:
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    advance(live, bench=ada.bench, ticks=21)
    made = ada.ask("POST", f"/api/v1/benches/{ada.bench}/recordings", json={"ticks": 0, "past_ticks": 10}).json()
    live.http.post(f"/api/v1/classes/{group['id']}/scenario", json={"scenario": "first-look"})
    assert ada.me()["bench"] != ada.bench
    for who, expected in ((ada, 200), (ben, 404)):
        listed = [one["id"] for one in who.ask("GET", "/api/v1/recordings").json()["recordings"]]
        assert (made["id"] in listed) == (expected == 200)
        assert who.ask("GET", f"/api/v1/recordings/{made['id']}/trace").status_code == expected
    assert ada.ask("GET", f"/api/v1/benches/{ada.bench}").status_code == 403

    async def after_a_restart() -> list[str]:
        people = People(live.service.database)
        await people.recover()
        return next(people.benches_of(one) for one in people.students() if one.id == ada.id)

    kept = on_loop(live, after_a_restart())
    assert kept[0] == ada.bench and len(kept) == 2
    live.http.delete(f"/api/v1/recordings/{made['id']}")
