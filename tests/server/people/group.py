"""A class under test: students who joined by its code, each with a client and a stream of one's own."""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

import httpx

from tests.server.conftest import Live, Stream


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
        with self.live.anonymous(headers=self.headers) as client:
            return client.request(method, path, **options)

    def stream(self, bench: str = "") -> AbstractContextManager[Stream]:
        return self.live.stream(bench or self.bench, additional_headers=self.headers)


def open_class(live: Live, name: str = "Tuesday", **fields: Any) -> dict[str, Any]:
    answer = live.http.post("/api/v1/classes", json={"name": name, **fields})
    assert answer.status_code == 201, answer.text
    made: dict[str, Any] = answer.json()
    return made


def join(live: Live, group: dict[str, Any], name: str) -> Somebody:
    with live.anonymous(headers={"Origin": live.address}) as client:
        answer = client.post(f"/api/v1/classes/{group['id']}/join", json={"code": group["code"], "name": name})
    assert answer.status_code == 201, answer.text
    joined = answer.json()
    return Somebody(live, joined["session"], joined["bench"], joined["id"])


def watcher(live: Live, bench: str, hours: float = 1.0) -> Somebody:
    answer = live.http.post(f"/api/v1/benches/{bench}/watchers", json={"hours": hours})
    assert answer.status_code == 201, answer.text
    made = answer.json()
    return Somebody(live, made["path"].removeprefix("/watch/"), bench, made["id"])
