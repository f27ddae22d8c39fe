"""The doors of learning platforms: there where one is configured, for whom the table says, framed by whom it may."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from core.errors import InputError
from server.api.view3d import SUBPROTOCOL as SCENE
from server.app import create_app
from server.classroom.access import DOORS, LTI_DOORS, TESTING_DOORS, Need
from server.security.once import Once
from server.settings import Settings, load_settings
from server.stream.wire import SUBPROTOCOL
from tests.server.classroom.group import Somebody, join, open_class
from tests.server.classroom.lti.conftest import FRAMES
from tests.server.classroom.test_doors import doors
from tests.server.conftest import Live

PLATFORM = {
    "issuer": "https://moodle.example",
    "client_id": "combbench",
    "auth_login_url": "https://moodle.example/auth",
    "auth_token_url": "https://moodle.example/token",
    "key_set_url": "https://moodle.example/keys",
    "deployment_ids": ["1"],
    "frames": FRAMES,
}
ANCESTORS = "frame-ancestors 'self' https://moodle.example https://moodle.example:8443"


@pytest.fixture
def student(lab: Live) -> Iterator[Somebody]:
    group = open_class(lab)
    yield join(lab, group, "Ada")
    lab.http.delete(f"/api/v1/classes/{group['id']}")


def policy(answer: Any) -> str:
    return str(answer.headers["content-security-policy"])


MODULES = ("server.classroom.lti", "jwt")


def loaded() -> list[str]:
    """List the modules of learning platforms that are loaded."""
    return [name for name in sys.modules if name.startswith(MODULES)]


def test_without_a_platform_no_door_is_there_and_no_code_is_loaded(
    live: Live, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not doors(live.app) & set(LTI_DOORS)
    for method, path in LTI_DOORS:
        assert live.http.request(method, path, **({"json": {}} if method == "POST" else {})).status_code == 404
    with live.anonymous(headers={"Accept": "text/html"}) as stranger:
        assert stranger.get("/lti").status_code == 404
        assert stranger.get("/assets/any.js").status_code == 401
    for name in loaded():
        monkeypatch.delitem(sys.modules, name)
    create_app(Settings(data=tmp_path))
    assert loaded() == []


def test_with_a_platform_the_doors_of_the_table_are_there_and_no_other(lab: Live) -> None:
    assert doors(lab.app) == {*DOORS, *LTI_DOORS, *TESTING_DOORS}
    with lab.anonymous(headers={"Origin": lab.address}) as stranger:
        for (method, path), need in LTI_DOORS.items():
            answer = stranger.request(method, path, **({"json": {}} if method == "POST" else {}))
            assert (answer.status_code == 401) == (need is Need.SESSION), (method, path, answer.status_code)


def test_only_the_pages_of_a_launch_may_be_framed_and_only_by_platforms(lab: Live, student: Somebody) -> None:
    with lab.anonymous(headers={"Accept": "text/html"}) as stranger:
        assert ANCESTORS in policy(stranger.get("/lti/login"))
        assert ANCESTORS in policy(stranger.get("/lti"))
        assert "frame-ancestors 'none'" in policy(stranger.get("/join"))
        assert "frame-ancestors 'none'" in policy(stranger.get("/ltix"))
    assert ANCESTORS in policy(student.ask("GET", f"/benches/{student.bench}/3d/"))
    assert "frame-ancestors 'none'" in policy(student.ask("GET", "/"))


def test_other_sites_send_browsers_to_a_launch_and_nowhere_else(lab: Live) -> None:
    with lab.anonymous(headers={"Origin": "https://moodle.example"}) as other:
        assert "did not open" in other.post("/lti/launch", data={"state": "x"}).text
        for path in ("/lti/session", "/lti/link", "/join"):
            assert other.post(path, data={}).json()["error"]["code"] == "forbidden_origin"
        assert other.post("/lti/launch", headers={"Host": "rebound.example"}).status_code == 403


def test_a_ticket_opens_one_path_once(lab: Live, student: Somebody) -> None:
    path = f"/api/v1/benches/{student.bench}"

    def ticket(path: str) -> str:
        answer = student.ask("POST", "/lti/ticket", json={"path": path})
        assert answer.status_code == 200, answer.text
        return str(answer.json()["ticket"])

    with lab.anonymous() as nobody:
        one = ticket(path)
        assert nobody.get(path, params={"ticket": one}).status_code == 200
        assert nobody.get(path, params={"ticket": one}).status_code == 401
        assert nobody.get("/api/v1/me", params={"ticket": ticket(path)}).status_code == 401
        foreign = lab.bench("first-look", paused=True)["id"]
        elsewhere = f"/api/v1/benches/{foreign}"
        assert nobody.get(elsewhere, params={"ticket": ticket(elsewhere)}).status_code == 403
        lab.http.delete(elsewhere)
    assert student.ask("POST", "/lti/ticket", json={"path": "https://x.example"}).status_code == 422


@pytest.mark.parametrize("good", [True, False])
def test_sockets_without_a_cookie(lab: Live, student: Somebody, good: bool) -> None:
    base, options = lab.address.replace("http", "ws"), {"proxy": None, "max_size": None, "origin": lab.address}
    scene, secret = f"/benches/{student.bench}/3d", student.secret if good else "nobodys"
    ticket = student.ask("POST", "/lti/ticket", json={"path": scene}).json()["ticket"] if good else "x"
    for url, protocols in (
        (f"{base}/api/v1/benches/{student.bench}/stream", [SUBPROTOCOL, f"combbench.session.{secret}"]),
        (f"{base}{scene}?ticket={ticket}", [SCENE]),
    ):
        with connect(url, subprotocols=protocols, **options) as socket:  # type: ignore[arg-type]
            assert socket.subprotocol == protocols[0]
            if good:
                assert socket.recv(timeout=60)
                continue
            with pytest.raises(ConnectionClosed) as closed:
                socket.recv(timeout=60)
            assert closed.value.rcvd is not None and closed.value.rcvd.code == 4401


def test_a_bearer_of_a_student_counts_before_the_cookie_of_the_teacher(lab: Live, student: Somebody) -> None:
    identity = lab.app.state.identity
    cookie = {"Cookie": f"{identity.cookie_name}={identity.cookie}"}
    with lab.anonymous(headers={**student.headers, **cookie}) as client:
        assert client.get("/api/v1/me").json()["role"] == "student"
    with lab.anonymous(headers=cookie) as client:
        assert client.get("/api/v1/me").json()["role"] == "teacher"


def test_things_behind_a_secret_of_one_use() -> None:
    clock = [0.0]
    store = Once[str](10.0, most=2, clock=lambda: clock[0])
    first, second = store.put("a"), store.put("b")
    assert store.take(first) == "a" and store.take(first) is None
    clock[0] = 11.0
    assert store.take(second) is None
    kept = [store.put(word) for word in "cde"]
    assert [store.take(secret) for secret in kept] == [None, "d", "e"]


def test_a_platform_that_is_not_right_is_refused(monkeypatch: Any, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    for field, value in (
        ("frames", ["https://moodle.example/path"]),
        ("frames", ["*"]),
        ("key_set_url", "file:///etc/passwd"),
        ("deployment_ids", []),
        ("client", "x"),
    ):
        monkeypatch.setenv("COMBBENCH_LTI", json.dumps([{**PLATFORM, field: value}]))
        with pytest.raises(InputError, match=rf"lti\.0\.{field}"):
            load_settings()


def test_platforms_are_read_from_the_file(monkeypatch: Any, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    lines = [f"{name} = {json.dumps(value)}" for name, value in PLATFORM.items()]
    (tmp_path / "combbench.toml").write_text("\n".join(["[[lti]]", *lines]))
    assert load_settings().lti[0].frames == ["https://moodle.example", "https://moodle.example:8443"]
