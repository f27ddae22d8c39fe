"""Unrequested connections: bounded, closed in time, and harmless."""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import httpx
import pytest

from server import connection

HEALTH = "/health/live"


@contextmanager
def opened(address: str, count: int = 1) -> Iterator[list[socket.socket]]:
    """Connections on which nothing has been sent."""
    url = httpx.URL(address)
    with contextlib.ExitStack() as stack:
        yield [stack.enter_context(socket.create_connection((url.host, url.port or 80), 10)) for _ in range(count)]


def is_closed(line: socket.socket) -> bool:
    """Wait until the server has closed it; whatever it says before is read."""
    line.settimeout(20)
    try:
        while line.recv(1 << 16):
            pass
    except ConnectionError:
        return True
    except TimeoutError:
        return False
    return True


def test_idle_connections_leave_room_for_requests(serve: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Room is for 257 here; connections that have waited longest are closed, connections with an active request are
    not."""
    monkeypatch.setattr(connection, "HEAD_S", 600.0)  # none ends by its time
    with serve(max_clients=1) as live, opened(live.address, 300) as lines:
        for _ in range(3):
            assert httpx.get(live.address + HEALTH, trust_env=False).status_code == 200
        assert live.http.get("/api/v1/benches").status_code == 200
        assert is_closed(lines[0])
        lines[-1].sendall(b"GET /health/live HTTP/1.1\r\nHost: localhost\r\n\r\n")
        assert lines[-1].recv(100).startswith(b"HTTP/1.1 200")


@pytest.mark.parametrize(
    ("begin", "drip"),
    [
        (b"", b""),
        (b"", b"\r\n"),
        (b"GET / HTTP/1.1\r\n", b"A"),
        (b"POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\n", b"1"),
    ],
)
def test_a_request_that_does_not_end_is_cut(
    live: Any, monkeypatch: pytest.MonkeyPatch, begin: bytes, drip: bytes
) -> None:
    """Sending a byte now and then keeps no connection."""
    monkeypatch.setattr(connection, "HEAD_S", 0.5)
    monkeypatch.setattr(connection, "BODY_S", 0.5)
    with opened(live.address) as [line]:
        line.sendall(begin)
        line.settimeout(0.1)
        began = time.monotonic()
        with contextlib.suppress(ConnectionError):
            while time.monotonic() - began < 20:
                with contextlib.suppress(TimeoutError):
                    if not line.recv(1 << 16):
                        break
                line.sendall(drip)
        assert time.monotonic() - began < 20


def test_a_client_that_takes_no_answer_is_cut(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connection, "STALL_S", 0.3)
    head = f"Host: localhost\r\nAuthorization: {live.http.headers['authorization']}\r\n\r\n"
    with opened(live.address) as [line]:
        line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        line.sendall(f"GET /api/v1/openapi.json HTTP/1.1\r\n{head}".encode() * 10)
        end, ours = time.monotonic() + 20, line.getsockname()
        while any(getattr(one, "client", None) == ours for one in live.server.server_state.connections.copy()):
            assert time.monotonic() < end, "its connection is kept"
            live.http.get(HEALTH)


def test_requests_that_wait_for_no_answer_are_not_kept_by_the_thousand(live: Any) -> None:
    ask = b"GET /api/v1/benches HTTP/1.1\r\nHost: localhost\r\n\r\n"
    with opened(live.address) as [line]:
        line.settimeout(20)
        with contextlib.suppress(ConnectionError):
            line.sendall(ask * 20_000)
        assert is_closed(line)
    with opened(live.address) as [line]:
        line.sendall(ask * 5)
        line.settimeout(20)
        told = b""
        while told.count(b"HTTP/1.1 401") < 5:
            told += line.recv(1 << 16)


def test_a_long_answer_and_a_kept_connection_are_not_cut(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A request under way has as long as it takes, and between two requests a connection is kept as it was."""
    monkeypatch.setattr(connection, "HEAD_S", 0.3)
    monkeypatch.setattr(connection, "BODY_S", 0.3)
    with httpx.Client(base_url=live.address, trust_env=False, headers=live.http.headers, timeout=60) as http:
        for _ in range(2):
            stream = http.get("/api/v1/catalog").extensions["network_stream"].get_extra_info("client_addr")
            time.sleep(0.6)
            again = http.get(HEALTH).extensions["network_stream"].get_extra_info("client_addr")
            assert stream == again
    bench = live.bench("first-look", paused=True)
    assert live.command(bench["id"], "step", ticks=10_000).status_code == 200
    with live.stream(bench["id"]) as stream:
        time.sleep(0.6)
        assert stream.command("pause")["type"] == "reply"
