"""A class on the network: who may use the token from where, and under which names the page is opened."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
from starlette.requests import HTTPConnection
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from server.app import create_app
from server.classroom.addresses import network_addresses
from server.security.identity import Identity
from server.security.origin import OriginPolicy
from server.settings import Settings
from server.stream.wire import SUBPROTOCOL
from tests.server.conftest import TOKEN, serving

HTML = {"Accept": "text/html"}
HERE = ["127.0.0.1", "127.0.0.9", "::1", "::ffff:127.0.0.1"]
ELSEWHERE = "192.168.1.7 ::ffff:192.168.1.7 fd00::7 fe80::7%eth0 0.0.0.0 :: ::127.0.0.1 localhost".split()


def caller(peer: Any, headers: dict[str, str] | None = None, query: str = "", own: Any = ("127.0.0.1", 8000)) -> Any:
    """A request as the server describes it."""
    lines = [(name.lower().encode(), value.encode()) for name, value in (headers or {}).items()]
    scope = {"type": "http", "method": "GET", "headers": lines, "query_string": query.encode(), "server": own}
    return HTTPConnection({**scope, "client": peer})


@pytest.fixture(scope="module")
def classroom(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with serving(tmp_path_factory.mktemp("class"), classroom=True) as live:
        yield live


@pytest.fixture(scope="module")
def outside() -> str:
    """An address of this machine that is not loopback: who comes by it looks like another machine."""
    found = [str(address) for address in network_addresses() if address.version == 4]
    if not found:
        pytest.skip("this machine has no address but loopback")
    return found[0]


@pytest.fixture
def network(classroom: Any, outside: str) -> Iterator[httpx.Client]:
    """A client that comes by the network."""
    port = classroom.http.base_url.port
    with httpx.Client(base_url=f"http://{outside}:{port}", timeout=60, trust_env=False, verify=False) as client:
        yield client


@pytest.mark.parametrize("peer", [*HERE, *ELSEWHERE, "", None])
def test_a_caller_on_this_machine_may_use_the_token(peer: str | None) -> None:
    end = None if peer is None else (peer, 50000)
    everyone, here = Identity(TOKEN), Identity(TOKEN, loopback_only=True)
    ways = {"bearer": {"Authorization": f"Bearer {TOKEN}"}, "cookie": {"Cookie": f"{here.cookie_name}={here.cookie}"}}
    by_bearer, by_cookie = (caller(end, headers) for headers in ways.values())
    by_address = caller(end, query=f"token={TOKEN}")
    for identity, welcome in ((everyone, True), (here, peer in HERE)):
        assert identity.has_bearer(by_bearer) is identity.knows(by_bearer) is welcome
        assert identity.has_cookie(by_cookie) is identity.knows(by_cookie) is welcome
        assert identity.has_token_in_address(by_address) is identity.may_use_token(by_address) is welcome
        assert not identity.knows(caller(end)) and not identity.has_token_in_address(caller(end))
        assert not identity.has_token_in_address(caller(end, query="token="))


@pytest.mark.parametrize("in_class", [True, False])
def test_the_right_token_is_refused_elsewhere_like_a_wrong_one(tmp_path: Path, in_class: bool) -> None:
    app = create_app(Settings(data=tmp_path, token=TOKEN, host="0.0.0.0", classroom=in_class))  # type: ignore[arg-type]

    async def answers(peer: str, token: str) -> tuple[Any, ...]:
        transport = httpx.ASGITransport(app, client=(peer, 50000))
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as client:
            opened = await client.get("/", params={"token": token}, headers=HTML)
            asked = await client.get("/api/v1/nothing", headers={"Authorization": f"Bearer {token}"})
        return opened.status_code, opened.text, "set-cookie" in opened.headers, asked.status_code, asked.text

    for peer in ("127.0.0.1", "192.168.1.7"):
        right, wrong = (asyncio.run(answers(peer, token)) for token in (TOKEN, "another-token-just-as-long"))
        assert wrong[0] == wrong[3] == 401 and not wrong[2]
        if in_class and peer != "127.0.0.1":
            assert right == wrong
            continue
        assert (right[0], right[2], right[3]) == (303, True, 404)
        assert "works on the teacher" not in wrong[1] + wrong[4]


def test_the_token_is_for_the_teachers_machine_alone(classroom: Any, network: httpx.Client) -> None:
    identity = classroom.app.state.identity
    bearer = {"Authorization": f"Bearer {TOKEN}"}
    cookie = {"Cookie": f"{identity.cookie_name}={identity.cookie}"}
    for headers in (bearer, cookie):
        with classroom.anonymous() as teacher:
            assert teacher.get("/api/v1/benches", headers=headers).status_code == 200
        refused = network.get("/api/v1/benches", headers=headers)
        assert refused.status_code == 401
        assert "works on the teacher's machine only" in refused.json()["error"]["hint"]
        # The headers of a proxy about the caller are ignored.
        forged = {"X-Forwarded-For": "127.0.0.1", "X-Real-IP": "127.0.0.1", "Forwarded": "for=127.0.0.1"}
        assert network.get("/api/v1/benches", headers=headers | forged).status_code == 401
    page = network.get("/", params={"token": TOKEN}, headers=HTML)
    assert page.status_code == 401 and "set-cookie" not in page.headers and TOKEN not in page.text
    assert "machine only" in page.text and 'href="/join"' in page.text and "<form" not in page.text
    assert 'role="alert"' in page.text and 'role="alert"' not in network.get("/", headers=HTML).text


def test_no_stream_opens_with_the_token_from_elsewhere(classroom: Any, outside: str) -> None:
    bench = classroom.bench(paused=True)
    url = f"ws://{outside}:{classroom.http.base_url.port}/api/v1/benches/{bench['id']}/stream"
    with (
        connect(
            url,
            additional_headers={"Authorization": f"Bearer {TOKEN}"},
            origin=url.replace("ws", "http").partition("/api")[0],  # type: ignore[arg-type]
            subprotocols=[SUBPROTOCOL],  # type: ignore[list-item]
            proxy=None,
        ) as stream,
        pytest.raises(ConnectionClosed) as caught,
    ):
        stream.recv(timeout=60)
    assert caught.value.rcvd is not None and caught.value.rcvd.code == 4401
    with classroom.stream(bench["id"]) as stream:
        assert stream.step()["type"] == "hello"


NAMES = [
    ("{outside}:{port}", True),
    ("{outside}", True),
    ("{machine}:{port}", True),
    ("{machine}.local:{port}", True),
    ("127.0.0.1:{port}", True),
    ("198.51.100.1:{port}", False),
    ("{outside}.evil.example:{port}", False),
    ("evil.{outside}:{port}", False),
    ("1{outside}:{port}", False),
    ("{outside}1:{port}", False),
    ("{machine}.evil.example:{port}", False),
    ("evil.{machine}:{port}", False),
    ("{machine}.local.evil.example", False),
    ("rebound.example:{port}", False),
    ("[::ffff:{outside}]:{port}", False),
    ("0.0.0.0:{port}", False),
    ("{outside}@evil.example", False),
    ("evil.example#{outside}", False),
    (".local", False),
    ("local", False),
    ("", False),
]


def test_students_come_by_the_address_or_the_name_of_the_machine(network: httpx.Client, outside: str) -> None:
    for host, welcome in NAMES:
        given = host.format(outside=outside, port=network.base_url.port, machine=socket.gethostname())
        status = network.get("/api/v1/benches", headers={"Host": given}).status_code
        assert status in ((401,) if welcome else (400, 403)), host


def test_an_address_of_another_connection_is_not_ours(classroom: Any, outside: str) -> None:
    """Who came by loopback did not open the address on the network."""
    host = {"Host": f"{outside}:{classroom.http.base_url.port}"}
    assert classroom.http.get("/api/v1/benches", headers=host).status_code == 403


ORIGINS = [
    ("http://{outside}:{port}", True),
    ("https://{outside}:{port}", False),
    ("http://{outside}:1", False),
    ("http://{outside}", False),
    ("http://198.51.100.1:{port}", False),
    ("http://127.0.0.1:{port}", False),
    ("http://{machine}:{port}", False),  # ours, but not the one this page was opened under
    ("http://{outside}:{port}.evil.example", False),
    ("http://evil.example/{outside}:{port}", False),
    ("http://1{outside}:{port}", False),
    ("http://evil.example", False),
    ("HTTP://{outside}:{port}", False),
    ("null", False),
    ("", False),
]


def test_only_the_page_that_was_opened_may_ask(network: httpx.Client, outside: str) -> None:
    for origin, welcome in ORIGINS:
        given = origin.format(outside=outside, port=network.base_url.port, machine=socket.gethostname())
        answer = network.post("/api/v1/benches", json={"scenario": "first-look"}, headers={"Origin": given})
        assert answer.status_code == (401 if welcome else 403), origin


OWN = [
    ("192.168.1.5", "192.168.1.5:8000", True),
    ("::ffff:192.168.1.5", "192.168.1.5:8000", True),
    ("fd00::5", "[fd00::5]:8000", True),
    ("fd00::5", "[fd00::6]:8000", False),
    ("fd00::5", "192.168.1.5:8000", False),
    ("192.168.1.5", "[fd00::5]:8000", False),
    ("/run/socket", "/run/socket", False),
    ("", "", False),
]


def test_the_address_of_the_connection_is_ours_in_a_class_alone() -> None:
    for own, host, welcome in OWN:
        connection = caller(("192.168.1.7", 50000), {"Host": host}, own=(own, 8000))
        refusal = OriginPolicy("0.0.0.0", [], classroom=True).refusal(connection, False)
        assert (refusal is None) is welcome, (own, host)
        assert OriginPolicy("0.0.0.0", []).refusal(connection, False) is not None, (own, host)


def test_a_machine_without_a_name_adds_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(socket, "gethostname", lambda: "")
    policy = OriginPolicy("0.0.0.0", [], classroom=True)
    for host in ("", ".local", "local"):
        assert policy.refusal(caller(("127.0.0.1", 1), {"Host": host}), True) is not None
