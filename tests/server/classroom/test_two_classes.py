"""Two servers below two paths of one host, as docs/scaling.md sets them up: each knows its own students alone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from itertools import count
from typing import Any

import httpx
import pytest

from tests.server.conftest import TOKEN, serving

HOST = "https://lab.example"
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

    def __init__(self, lives: dict[str, Any], stack: ExitStack) -> None:
        self.lives, self._stack, self._numbers = lives, stack, count(1)
        self.ports = {prefix: live.http.base_url.port for prefix, live in lives.items()}
        self.groups = {
            prefix: live.http.post("/api/v1/classes", json={"name": prefix, "bench": {"scenario": RUNS[prefix]}})
            for prefix, live in lives.items()
        }

    def browser(self) -> httpx.Client:
        headers = {"Origin": HOST}
        return self._stack.enter_context(httpx.Client(transport=Proxy(self.ports), base_url=HOST, headers=headers))

    def join(self, browser: httpx.Client, prefix: str) -> str:
        """Join the class of a server; return the student's bench."""
        typed = {"code": self.groups[prefix].json()["code"], "name": f"Student {next(self._numbers)}"}
        assert browser.get(f"{prefix}/join").status_code == 200
        answer = browser.post(f"{prefix}/join", data=typed)
        assert (answer.status_code, answer.headers["location"]) == (303, f"{prefix}/")
        return str(browser.get(f"{prefix}/api/v1/me").json()["bench"])


@pytest.fixture(scope="module")
def host(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Host]:
    with ExitStack() as stack:
        folder = tmp_path_factory.mktemp("host")
        lives = {
            prefix: stack.enter_context(serving(folder / prefix[1:], public_origin=f"{HOST}{prefix}"))
            for prefix in ("/a", "/b")
        }
        yield Host(lives, stack)


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
