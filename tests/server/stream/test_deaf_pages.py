"""Pages that read nothing: they are closed, and the others see nothing of it."""

from __future__ import annotations

import contextlib
import socket
import threading
from typing import Any
from unittest.mock import Mock

import pytest
from websockets.exceptions import ConnectionClosed

from server.api import stream as stream_module
from server.stream import client as client_module

MOTION: dict[str, Any] = {"signals": ["plant.displacement"], "window_ms": 1.0}


def deaf(live: Any) -> dict[str, Any]:
    """Options of a connection that never reads, on a socket with little room."""
    sock = socket.socket()
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    sock.connect(("127.0.0.1", int(live.address.rpartition(":")[2])))
    return {"sock": sock, "max_queue": 1, "close_timeout": 0.5}


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let pages send as much as they like, and cut a line soon that takes no close."""
    monkeypatch.setattr(stream_module, "FLOOD_BURST", 10**9)
    monkeypatch.setattr(stream_module, "CLOSE_S", 0.05)


def only_client(live: Any) -> tuple[Any, threading.Event]:
    """Return the only client, and the event of the end of its line."""
    hub = live.service.hub
    while not any(room.clients for room in hub._rooms.values()):  # the connection is there before the client has joined
        live.http.get("/health/live")
    (room,) = hub._rooms.values()
    (client,) = room.clients
    gone, lost = threading.Event(), client.line.connection_lost

    def lose(error: Any) -> None:
        lost(error)
        gone.set()

    client.line.connection_lost = lose
    return client, gone


@pytest.mark.usefixtures("patient")
def test_a_page_that_acknowledges_and_never_reads_is_cut_off(live: Any) -> None:
    """Its word for it keeps no stream open: not even the close gets through, its line is cut, and nothing stays."""
    bench = live.bench(time_scale=0.05)
    names = [signal["name"] for signal in bench["signals"]][:8]
    before, most = len(live.server.server_state.connections), 0
    with live.stream(bench["id"], **deaf(live)) as stream:
        client, gone = only_client(live)
        for panel in range(6):
            stream.send(type="subscribe", panel=panel, signals=names, window_ms=50.0, width=1300)
        while live.service.hub.watchers(bench["id"]):
            most = max(most, client.line.waiting)
            with contextlib.suppress(ConnectionClosed):
                stream.send(type="ack", frame=10**6)
            live.advance(seconds=0.25)
        assert 0 < most < 2_000_000
        assert gone.wait(60)
        assert len(live.server.server_state.connections) <= before


@pytest.mark.usefixtures("patient")
def test_a_page_that_asks_and_never_reads_is_let_go(live: Any) -> None:
    """Answers wait for it, but not without end."""
    bench = live.bench(paused=True)
    with live.stream(bench["id"], **deaf(live)) as stream:
        client, _ = only_client(live)
        with contextlib.suppress(ConnectionClosed):
            while client.closing is None:
                stream.send(type="x" * 1000)
                assert len(client._outbox) <= client_module.MOST_WAITING + 1
        assert client.closing == (4408, "answers were asked for and not read")


@pytest.mark.usefixtures("patient")
def test_a_close_that_nobody_reads_cuts_the_line(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A line that takes the close into its buffer does not stay when the buffer is never emptied."""
    bench, before = live.bench(paused=True), len(live.server.server_state.connections)
    with live.stream(bench["id"], **deaf(live)) as stream:
        client, gone = only_client(live)
        client.line.transport.set_write_buffer_limits(high=10**9)
        cut = Mock(wraps=client.line.cut)
        monkeypatch.setattr(client.line, "cut", cut)
        while client.line.waiting < 100_000:
            stream.send(type="x" * 1000)
        live.advance(seconds=client_module.STALL_S + 1.0)
        assert gone.wait(60) and cut.called
        assert len(live.server.server_state.connections) == before
        assert client.closing == (4408, "nothing was taken for 5 s")
