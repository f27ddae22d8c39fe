"""Two servers below two paths of one host, as docs/scaling.md sets them up: each knows its own students alone.

A few lines stand in for the proxy; the long suite has nginx in their place.
"""

from __future__ import annotations

import socket
import ssl
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from itertools import count
from typing import Any

import httpx
import pytest

from tests.server.conftest import TOKEN, serving
from tests.server.nginx import NAME, nginx
from tests.server.security.test_proxy import Here

RUNS = {"/a": "first-look", "/b": "ch5-seven-step"}


class Proxy(httpx.BaseTransport):
    """Leads by the first part of the path, takes it off, and ends TLS."""

    def __init__(self, ports: dict[str, int]) -> None:
        self._ports, self._line = ports, httpx.HTTPTransport()

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        prefix, path = request.url.raw_path[:2].decode(), request.url.raw_path[2:]
        there = request.url.copy_with(scheme="http", host="127.0.0.1", port=self._ports[prefix], raw_path=path)
        sent = httpx.Request(request.method, there, headers=request.headers, stream=request.stream)
        return self._line.handle_request(sent)

    def close(self) -> None:
        self._line.close()


class Host:
    """The host with both servers, which have the same token."""

    def __init__(
        self, origin: str, lives: dict[str, Any], line: Callable[[], httpx.BaseTransport], stack: ExitStack
    ) -> None:
        self.origin, self.lives, self._line, self._stack, self._numbers = origin, lives, line, stack, count(1)
        self.groups = {
            prefix: live.http.post("/api/v1/classes", json={"name": prefix, "bench": {"scenario": RUNS[prefix]}})
            for prefix, live in lives.items()
        }

    def browser(self) -> httpx.Client:
        client = httpx.Client(transport=self._line(), base_url=self.origin, headers={"Origin": self.origin}, timeout=60)
        return self._stack.enter_context(client)

    def join(self, browser: httpx.Client, prefix: str) -> str:
        """Join the class of a server; return the student's bench."""
        typed = {"code": self.groups[prefix].json()["code"], "name": f"Student {next(self._numbers)}"}
        assert browser.get(f"{prefix}/join").status_code == 200
        answer = browser.post(f"{prefix}/join", data=typed)
        assert (answer.status_code, answer.headers["location"]) == (303, f"{prefix}/")
        return str(browser.get(f"{prefix}/api/v1/me").json()["bench"])


@pytest.fixture(scope="module", params=["lines", pytest.param("nginx", marks=pytest.mark.long)])
def host(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Host]:
    with ExitStack() as stack:
        folder, free = tmp_path_factory.mktemp("host"), socket.create_server(("127.0.0.1", 0))
        port = free.getsockname()[1]  # kept until nginx takes it
        origin = f"https://{NAME}" if request.param == "lines" else f"https://{NAME}:{port}"
        lives = {
            prefix: stack.enter_context(serving(folder / prefix[1:], public_origin=f"{origin}{prefix}"))
            for prefix in ("/a", "/b")
        }
        ports = {prefix: live.http.base_url.port for prefix, live in lives.items()}
        free.close()
        if request.param == "lines":
            yield Host(origin, lives, lambda: Proxy(ports), stack)
            return
        at = stack.enter_context(nginx(port, ports))
        context = ssl.create_default_context(cafile=str(at / f"{NAME}.pem"))
        yield Host(origin, lives, lambda: Here(port, verify=context, trust_env=False), stack)


def test_a_student_of_one_server_is_a_stranger_at_the_other(host: Host) -> None:
    browser = host.browser()
    bench = host.join(browser, "/a")
    assert browser.get(f"/a/api/v1/benches/{bench}").status_code == 200
    assert [cookie.path for cookie in browser.cookies.jar] == ["/a/"]
    other = host.join(host.browser(), "/b")
    for path in ("me", "benches", "runs", "scenarios", f"benches/{bench}", f"benches/{other}"):
        assert browser.get(f"/b/api/v1/{path}").status_code == 401, path
    assert browser.post(f"/b/api/v1/benches/{other}/commands", json={"step": 1}).status_code == 401
    (secret,) = (cookie.value for cookie in browser.cookies.jar)
    given = httpx.Headers({"Authorization": f"Bearer {secret}"})
    assert browser.get("/a/api/v1/me", headers=given).json()["role"] == "student"
    assert browser.get("/b/api/v1/me", headers=given).status_code == 401
    (name,) = (cookie.name for cookie in browser.cookies.jar)
    assert browser.get("/b/api/v1/me", headers={"Cookie": f"{name}={secret}"}).status_code == 401


def test_a_browser_may_have_a_session_of_each(host: Host) -> None:
    browser = host.browser()
    benches = {prefix: host.join(browser, prefix) for prefix in ("/a", "/b")}
    for prefix, bench in benches.items():
        assert browser.get(f"{prefix}/api/v1/me").json()["bench"] == bench
        assert browser.get(f"{prefix}/api/v1/benches/{bench}").json()["scenario_id"] == RUNS[prefix]
    assert browser.get(f"/b/api/v1/benches/{benches['/a']}").status_code == 403
    neighbour = host.join(host.browser(), "/b")
    assert browser.get(f"/b/api/v1/benches/{neighbour}").status_code == 403


def test_the_teacher_comes_in_once_at_each_server(host: Host) -> None:
    browser = host.browser()
    assert browser.get(f"/a/?token={TOKEN}").headers["location"] == "/a/"
    assert browser.get("/a/api/v1/classes").status_code == 200
    assert browser.get("/b/api/v1/classes").status_code == 401
    browser.get(f"/b/?token={TOKEN}")
    assert [len(browser.get(f"{prefix}/api/v1/classes").json()["classes"]) for prefix in ("/a", "/b")] == [1, 1]
    assert {cookie.path for cookie in browser.cookies.jar} == {"/a/", "/b/"}


@pytest.mark.parametrize("prefix", ["/a", "/b"])
def test_links_lead_to_their_own_server(host: Host, prefix: str) -> None:
    live = host.lives[prefix]
    bench = live.bench("first-look")["id"]
    path = live.http.post(f"/api/v1/benches/{bench}/watchers", json={}).json()["path"]
    guest = host.browser()
    assert guest.get(f"{prefix}{path}").headers["location"] == f"{prefix}/"
    assert guest.get(f"{prefix}/api/v1/me").json()["bench"] == bench
    other = {"/a": "/b", "/b": "/a"}[prefix]
    assert guest.get(f"{other}/api/v1/me").status_code == 401
