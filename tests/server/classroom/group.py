"""A class under test: students who joined by its code, each with an own bearer and stream."""

from __future__ import annotations

import asyncio
from collections.abc import Coroutine
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, TypeVar

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

from server.computing.computing import Computing
from server.errors import ApiError
from tests.server.conftest import TOKEN, Live, Stream

T = TypeVar("T")


@dataclass
class Somebody:
    """A student, a watcher or the teacher, as a program that sends a bearer."""

    live: Live
    secret: str
    bench: str = ""
    id: str = ""

    @property
    def headers(self) -> dict[str, str]:
        return {"Authorization": f"Bearer {self.secret}", "Origin": self.live.address}

    def ask(self, method: str, path: str, **options: Any) -> httpx.Response:
        options |= {"headers": self.headers, "timeout": 120, "trust_env": False, "verify": False}
        return httpx.request(method, self.live.address + path, **options)

    def me(self) -> dict[str, Any]:
        found: dict[str, Any] = self.ask("GET", "/api/v1/me").json()
        return found

    def stream(self, bench: str = "") -> AbstractContextManager[Stream]:
        return self.live.stream(bench or self.bench, additional_headers=self.headers)


def compute_nothing(patch: pytest.MonkeyPatch) -> None:
    """Refuse all that is computed for requests, in tests of the right to ask alone."""

    async def refuse(*_arguments: Any, **_named: Any) -> Any:
        raise ApiError(503, "unavailable", "nothing is computed here")

    patch.setattr(Computing, "call", refuse)


def the_teacher(live: Live, bench: str = "") -> Somebody:
    return Somebody(live, TOKEN, bench, "teacher")


def open_class(live: Live, name: str = "Tuesday", **fields: Any) -> dict[str, Any]:
    answer = live.http.post("/api/v1/classes", json={"name": name, **fields})
    assert answer.status_code == 201, answer.text
    made: dict[str, Any] = answer.json()
    return made


def join(live: Live, group: dict[str, Any], name: str, **changed: str) -> Somebody:
    answer = tried(live, group, name, **changed)
    assert answer.status_code == 201, answer.text
    joined = answer.json()
    return Somebody(live, joined["session"], joined["bench"], joined["id"])


def tried(live: Live, group: dict[str, Any], name: str, **changed: str) -> httpx.Response:
    """Try to join by the code of a class, or by another one."""
    body = {"code": group["code"], "name": name, **changed}
    path = f"{live.address}/api/v1/classes/{group['id']}/join"
    return httpx.post(path, json=body, headers={"Origin": live.address}, timeout=120, trust_env=False, verify=False)


def watcher(live: Live, bench: str, hours: float = 1.0) -> Somebody:
    answer = live.http.post(f"/api/v1/benches/{bench}/watchers", json={"hours": hours})
    assert answer.status_code == 201, answer.text
    made = answer.json()
    return Somebody(live, made["path"].removeprefix("/watch/"), bench, made["id"])


def advance(live: Live, **how: Any) -> dict[str, int]:
    """Let time pass by so many seconds, or until a bench has made so many ticks; return the ticks of all benches."""
    answer = live.http.post("/api/v1/testing/advance", json=how)
    assert answer.status_code == 200, answer.text
    ticks: dict[str, int] = answer.json()["ticks"]
    return ticks


def closed_with(stream: Stream) -> int:
    """Take messages until the server closes the stream; return the code that it gives."""
    with pytest.raises(ConnectionClosed) as closed:
        while True:
            stream.step()
    assert closed.value.rcvd is not None
    return int(closed.value.rcvd.code)


def on_loop(live: Live, work: Coroutine[Any, Any, T]) -> T:
    """Do something on the event loop of the server."""
    return asyncio.run_coroutine_threadsafe(work, live.service._loop).result(60)
