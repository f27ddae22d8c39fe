"""Every door of the service, by HTTP, WebSocket and command, for every role, on the own bench and on another's."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from server.api.view3d import SUBPROTOCOL as SCENE
from server.app import create_app
from server.bench.commands import RUN_KINDS
from server.classroom.access import DOORS, SOCKET, TESTING_DOORS, Need, need_of
from server.settings import Settings
from server.stream.wire import SUBPROTOCOL
from tests.server.classroom.group import (
    Somebody,
    compute_nothing,
    join,
    on_loop,
    open_class,
    the_teacher,
    watcher,
)

ROLES = ("teacher", "student", "other student", "borrower", "onlooker", "watcher", "other watcher", "stranger")
ALLOWED = {
    Need.NOTHING: set(ROLES),
    Need.SESSION: set(ROLES) - {"stranger"},
    Need.MEMBER: set(ROLES) - {"stranger", "watcher", "other watcher"},
    Need.WATCH: {"teacher", "student", "watcher", "borrower", "onlooker"},
    Need.MAY_DRIVE: {"teacher", "student", "borrower"},
    Need.DRIVE: {"teacher", "student", "borrower"},
    Need.TEACHER: {"teacher"},
}
"""Who may pass, at a bench of the student that the watcher has a link to, the borrower was lent and the class of the
onlooker is shown."""


@pytest.fixture(scope="module")
def people(shared: Any) -> Iterator[dict[str, Somebody]]:
    group, second = open_class(shared), open_class(shared, "Friday")
    student, other = join(shared, group, "Ada"), join(shared, group, "Ben")
    borrower, onlooker = join(shared, group, "Carl"), join(shared, second, "Dora")
    service, known = shared.service, {one.id: one for one in shared.service.people.students()}

    async def lend() -> None:  # the bench of a student is not lent over REST; the doors need not know
        service.people.lend(known[borrower.id], student.bench)

    on_loop(shared, lend())
    shown = shared.http.put(f"/api/v1/classes/{second['id']}/shown", json={"bench": student.bench})
    assert shown.status_code == 204, shown.text
    yield {
        "teacher": the_teacher(shared, student.bench),
        "student": student,
        "other student": other,
        "borrower": borrower,
        "onlooker": onlooker,
        "watcher": watcher(shared, student.bench),
        "other watcher": watcher(shared, other.bench),
        "stranger": Somebody(shared, "nobody's"),
    }
    for one in (group, second):
        shared.http.delete(f"/api/v1/classes/{one['id']}")


def doors(app: Any) -> set[tuple[str, str]]:
    """All doors of the application."""
    found = set()
    for route in app.routes:
        methods = getattr(route, "methods", None) or {SOCKET}
        path = route.path or route.starlette_route.path
        found |= {(method, path) for method in methods - {"HEAD"}}
    return found


@pytest.mark.parametrize(("clock", "more"), [("machine", {}), ("manual", TESTING_DOORS)])
def test_the_table_has_every_door_and_no_other(tmp_path: Path, clock: Any, more: dict[Any, Any]) -> None:
    assert doors(create_app(Settings(data=tmp_path, clock=clock))) == {*DOORS, *more}


def test_a_door_that_is_not_in_the_table_is_the_teachers() -> None:
    assert need_of("POST", "/api/v1/classes/a/new-route") == (Need.TEACHER, "")
    assert need_of("PATCH", "/") == (Need.TEACHER, "")
    assert need_of("GET", "/assets/index.js") == (Need.SESSION, "")
    assert need_of("HEAD", "/api/v1/benches/b7") == (Need.WATCH, "b7")
    for path in ("/api/v1/benches/b7/", "/api/v1//benches/b7", "/api/v1/benches/b7/stream/x", "/benches/b7/3d/x"):
        assert need_of("GET", path)[0] is Need.TEACHER


@pytest.mark.parametrize("role", ROLES)
def test_every_door_by_role(live: Any, people: dict[str, Somebody], role: str, monkeypatch: pytest.MonkeyPatch) -> None:
    compute_nothing(monkeypatch)
    somebody, bench = people[role], people["student"].bench
    for (method, path), need in {**DOORS, **TESTING_DOORS}.items():
        if method == SOCKET or (method, path) == ("DELETE", "/api/v1/benches/{bench_id}"):
            continue
        filled = path.replace("{bench_id}", bench).replace("{", "").replace("}", "")
        if role == "teacher" and method != "GET":
            assert live.service.people.may(None, need) == (need is Need.NOTHING)
            continue  # it would end or change the class of the other cases
        # a body of the wrong type is refused behind the door, and changes nothing
        answer = somebody.ask(method, filled, **({} if method == "GET" else {"json": []}))
        is_wrong = "/join" in filled or filled.startswith("/watch")  # a 403 of its own: the code or the link
        refused = not is_wrong and answer.status_code in (401, 403)
        if refused:
            assert answer.json()["error"]["code"] in ("unauthorised", "forbidden")
        assert refused == (role not in ALLOWED[need]), (role, method, filled, answer.status_code, answer.text[:200])
        if refused:
            assert answer.status_code == (401 if role == "stranger" else 403)


def code_of(somebody: Somebody, path: str, protocol: str = SUBPROTOCOL) -> int:
    """Open a socket; return the code that closes it, or 0 where it says something."""
    url = somebody.live.address.replace("http", "ws") + path
    options: dict[str, Any] = {"additional_headers": somebody.headers, "proxy": None, "max_size": None}
    with connect(url, subprotocols=[Subprotocol(protocol)], **options) as socket:
        try:
            return 0 if socket.recv(timeout=60) else -1
        except ConnectionClosed as closed:
            return closed.rcvd.code if closed.rcvd is not None else -1


@pytest.mark.parametrize("role", ROLES)
def test_every_socket_by_role(people: dict[str, Somebody], role: str) -> None:
    bench, expected = people["student"].bench, 4401 if role == "stranger" else 4403
    codes = [
        code_of(people[role], f"/api/v1/benches/{bench}/stream"),
        code_of(people[role], f"/benches/{bench}/3d", SCENE),
    ]
    assert codes == ([0, 0] if role in ALLOWED[Need.WATCH] else [expected, expected])


COMMANDS: list[dict[str, Any]] = [
    *({"kind": kind} for kind in RUN_KINDS if kind not in ("time_scale", "seek", "loop")),
    {"kind": "time_scale", "value": 0.002},
    {"fault": "added_mass", "severity": 0.05},
    {"heal": "all"},
    {"set": {"reference.amplitude_v": 9.0}},
    {"switch": "pid"},
    {"make_safe": "nobody is there"},
    {"kind": "reset_trip"},
]


def test_every_command_is_among_those_tried() -> None:
    assert {c.get("kind") for c in COMMANDS} >= set(RUN_KINDS) - {"seek", "loop"}  # those are for recordings
    assert len(COMMANDS) >= 14 and len(get_args(RUN_KINDS["start"].model_fields["kind"].annotation)) == 1


@pytest.mark.parametrize("role", ["student", "watcher", "borrower", "onlooker"])
def test_every_command_over_the_socket_by_role(live: Any, people: dict[str, Somebody], role: str) -> None:
    bench = people["student"].bench
    with people[role].stream(bench) as stream:
        last = live.get(bench)["last_event"]
        for command in COMMANDS:
            reply = stream.command(**command)
            if role not in ALLOWED[Need.DRIVE]:
                assert reply["error"]["code"] == "forbidden", command
            else:
                assert reply["ok"] or reply["error"]["code"] != "forbidden", command
        assert (live.get(bench)["last_event"] > last) == (role in ALLOWED[Need.DRIVE])


def test_a_list_shows_only_what_is_ones_own(live: Any, people: dict[str, Somebody]) -> None:
    alone = live.bench("first-look", paused=True)
    for role in ("student", "other student", "watcher", "other watcher"):
        listed = people[role].ask("GET", "/api/v1/benches").json()["benches"]
        assert [bench["id"] for bench in listed] == [people[role].bench]
    assert [bench["id"] for bench in live.http.get("/api/v1/benches").json()["benches"]] == [alone["id"]]


def test_a_recording_is_seen_by_who_may_see_its_bench(live: Any, people: dict[str, Somebody]) -> None:
    student = people["student"]
    started = student.ask("POST", f"/api/v1/benches/{student.bench}/recordings", json={"ticks": 0, "past_ticks": 10})
    assert started.status_code == 201, started.text
    path = f"/api/v1/recordings/{started.json()['id']}"
    live.http.post(f"/api/v1/benches/{student.bench}/recordings/{started.json()['id']}/stop")
    for role, expected in (("student", 200), ("watcher", 200), ("other student", 404), ("other watcher", 404)):
        assert people[role].ask("GET", path).status_code == expected
        assert people[role].ask("GET", f"{path}/trace").status_code == expected
        ids = [one["id"] for one in people[role].ask("GET", "/api/v1/recordings").json()["recordings"]]
        assert (started.json()["id"] in ids) == (expected == 200)
    live.http.delete(path)


def test_the_values_of_anothers_bench_are_not_compared(live: Any, people: dict[str, Somebody]) -> None:
    bench = people["student"].bench
    kept = live.http.post(f"/api/v1/benches/{bench}/parameter-sets", json={"name": "as Ada has it"}).json()
    path = f"/api/v1/parameter-sets/{kept['id']}/difference?bench={bench}"
    assert people["student"].ask("GET", path).status_code == 200
    assert people["other student"].ask("GET", path).json()["error"]["code"] == "forbidden"
    live.http.delete(f"/api/v1/parameter-sets/{kept['id']}")
