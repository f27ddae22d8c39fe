"""A refused request has no effect: each database call of each door fails once, and all is as before.

All means the memory of the server, and its disk.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from server.classroom.access import DOORS, SOCKET
from server.runs.queue import Queue
from tests.server.conftest import Live
from tests.server.world import Injector, World
from tests.server.writing_doors import AFTER_ALL, CASES, WITHOUT


@pytest.fixture
def world(live: Live, monkeypatch: pytest.MonkeyPatch) -> Iterator[World]:
    """The shared server; runs that are queued wait until they are cancelled."""

    async def waits(self: Queue, row: Any) -> None:
        try:
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            self._tasks.pop(row.id, None)
            await self._end(row.id, "cancelled")

    monkeypatch.setattr(Queue, "_carry_out", waits)
    with ThreadPoolExecutor(1) as thread:
        monkeypatch.setattr(live.service.queue.processes, "submit", thread.submit)
        made = World(live)
        yield made
        made.end()
    live.service.joining._tries._buckets.clear()


def test_every_door_that_writes_is_tried() -> None:
    writing = {door for door in DOORS if door[0] not in ("GET", SOCKET)}
    assert writing == {*CASES} | (WITHOUT & writing)


@pytest.mark.parametrize("door", CASES, ids=" ".join)
def test_what_is_refused_for_want_of_the_database_has_not_happened(
    world: World, door: tuple[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    who, ids, body = CASES[door](world)
    method, path = door[0], door[1].format(**ids) + ids.get("?", "")
    sent = {} if body is None else {"content" if isinstance(body, bytes) else "json": body}
    injector = Injector(world.live, monkeypatch)
    for calls in range(40):
        before = world.state()
        injector.arm(calls)
        answer = who.ask(method, path, **sent)
        injector.is_armed = False
        if not injector.has_failed:
            assert answer.is_success, answer.text
            return
        after = world.state()
        if door in AFTER_ALL and after != before:
            assert AFTER_ALL[door](world.live, ids)
            return
        if answer.is_success:
            assert answer.json()["failed"]  # it is said of whom it has not been done
            continue
        assert answer.status_code == 503, answer.text
        assert {key: (before[key], after[key]) for key in after if before[key] != after[key]} == {}, (calls, door)
    raise AssertionError(f"{door} asks the database too often")
