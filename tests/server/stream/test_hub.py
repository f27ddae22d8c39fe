"""What pages are shown of a bench that stops: its last tick, whenever in a frame it stops."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from scenarios.library import get
from scenarios.run import build
from server.bench.commands import parse
from server.bench.session import Session
from server.metrics import Metrics
from server.settings import Settings
from server.stream.client import Client
from server.stream.hub import Hub
from server.stream.panel import Panel
from server.stream.wire import Subscribe


class Socket:
    """A socket that keeps what is sent, and may hang."""

    def __init__(self) -> None:
        self.frames: list[bytes] = []
        self.goes_on = asyncio.Event()
        self.goes_on.set()

    async def send_text(self, _: str) -> None:
        await self.goes_on.wait()

    async def send_bytes(self, data: bytes) -> None:
        self.frames.append(data)


@pytest.fixture
def watched() -> tuple[Hub, Session, Client]:
    session = Session(get("first-look"), build(get("first-look")), None, 20_000, Metrics(), lambda: 0.0)
    session.begin(True)
    hub = Hub(Settings(), Metrics(), dict)
    cuts: Any = hub.cuts(session)
    client = Client(Socket(), session, Metrics(), hub.describe, cuts, 0)  # type: ignore[arg-type]
    wanted = Subscribe(type="subscribe", panel=1, signals=["plant.displacement"], window_ms=1.0, width=100)
    client.panels[1] = Panel(wanted, session.indices(["plant.displacement"]), None, 1, session.dt_ms, 0)
    hub.add(client)
    return hub, session, client


def test_the_end_is_offered_although_no_frame_is_due(watched: tuple[Hub, Session, Client]) -> None:
    hub, session, client = watched
    session.slice(100)
    hub.publish()
    assert client._wants_frame
    client._wants_frame = False
    session.slice(137)
    hub.publish()
    assert not client._wants_frame  # its time has not come, and another round will
    session.execute(parse({"kind": "pause"}), "test")
    hub.publish()
    assert client._wants_frame and client._cuts.end_tick == session.board.tick == 137
    client._wants_frame = False
    hub.publish()
    assert not client._wants_frame  # once is enough


def test_the_end_is_sent_although_the_line_was_busy_when_it_was_offered(
    watched: tuple[Hub, Session, Client],
) -> None:
    hub, session, client = watched

    async def play() -> None:
        socket: Any = client.socket
        sender = asyncio.create_task(client.run())
        socket.goes_on.clear()
        client.offer_status()  # hangs
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        session.slice(137)
        session.execute(parse({"kind": "pause"}), "test")
        hub.publish()
        assert not socket.frames
        socket.goes_on.set()
        for _ in range(20):
            await asyncio.sleep(0)
        assert len(socket.frames) == 1
        client.close(1000, "")
        await sender

    asyncio.run(play())
