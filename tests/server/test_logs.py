"""Log lines: all of one form, without secrets, and a line at most for a client that breaks the rules."""

from __future__ import annotations

import base64
import json
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.server.forks import ROOT, TOKEN, Forks, Served

WORDS = """
import gc, logging, sys, threading, warnings
from server.cli import logs
from server.settings import Settings

logs.configure(Settings(log_format="json"))
logging.getLogger("a").warning("at %s", "postgresql://user:canary@host/name")
logging.getLogger("a").warning("GET /?token=canary&a=1")
logging.getLogger("a").warning("GET /join?code=canary&a=1 /join/canary?b=2")
logging.getLogger("a").error("no word of %s", "it", extra={"link": "http://127.0.0.1:1/?token=canary"})
warnings.warn("take care", stacklevel=1)
thread = threading.Thread(target=lambda: 1 / 0)
thread.start()
thread.join()

class Odd:
    def __del__(self):
        raise KeyError("odd")

Odd()
gc.collect()
raise ValueError("the end of http://user:canary@host/")
"""


def lines(text: str) -> list[dict[str, Any]]:
    """Every line, each of which has to be a JSON object."""
    return [json.loads(line) for line in text.splitlines()]


def test_whatever_python_has_to_say_is_json_and_keeps_secrets() -> None:
    done = subprocess.run([sys.executable, "-c", WORDS], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "canary" not in done.stderr and not done.stdout
    said = lines(done.stderr)
    assert [entry["message"].splitlines()[0][:22] for entry in said[:4]] == [
        "at postgresql://user:.", "GET /?token=...&a=1", "GET /join?code=...&a=1", "no word of it",
    ]  # fmt: skip
    assert "take care" in said[4]["message"] and said[4]["logger"] == "py.warnings"
    assert [entry["exception"].splitlines()[-1] for entry in said[5:]] == [
        "ZeroDivisionError: division by zero", "KeyError: 'odd'", "ValueError: the end of http://user:...@host/",
    ]  # fmt: skip


def frame(code: int, data: bytes, mask: bool = True, reserved: int = 0) -> bytes:
    """A WebSocket frame, whole; RFC 6455, section 5.2."""
    size = bytes([len(data)]) if len(data) < 126 else b"\x7e" + struct.pack("!H", len(data))
    head = bytes([0x80 | reserved << 4 | code, size[0] | 0x80 * mask]) + size[1:]
    return head + (b"\0\0\0\0" if mask else b"") + data


RUDE = {
    "garbage": b"\x00\xff\x80",
    "unknown kind": frame(5, b"x"),
    "not masked": frame(1, b"{}", mask=False),
    "reserved bit": frame(1, b"{}", reserved=4),
    "not UTF-8": frame(1, b"\xff\xfe"),
    "text": frame(1, b"hello"),
    "binary": frame(2, b"\x81\xa4type\xa3abc"),
    "not closing": frame(8, b"\0\1"),
    "long ping": frame(9, b"x" * 200),
    "end of nothing": frame(0, b"x"),
}

MACHINE = ("server.bench.engine", "server.bench.watchdog")
"""Who says that this machine is slow, which no client brought about."""


@contextmanager
def opened(address: str, path: str, protocol: str) -> Iterator[socket.socket]:
    """A WebSocket by hand, cut at the end."""
    port = int(address.rpartition(":")[2])
    key = base64.b64encode(b"0" * 16).decode()
    with socket.create_connection(("127.0.0.1", port), 60) as line:
        line.sendall(
            f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {TOKEN}\r\nConnection: Upgrade\r\n"
            f"Upgrade: websocket\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Protocol: {protocol}\r\n\r\n".encode()
        )
        yield line
        line.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))


def broken(served: Served, part: str) -> None:
    """Break the rules of WebSockets in every way, on the stream of a bench or on its 3D view."""
    bench = served.http.post("/api/v1/benches", json={"scenario": "first-look"}).json()["id"]
    path = f"/api/v1/benches/{bench}/stream" if part == "stream" else f"/benches/{bench}/3d"
    protocol = "combbench.v1" if part == "stream" else "viser-v1.1.1"
    for said in RUDE.values():
        for waits in (True, False):  # and a client that does not even wait for the answer
            with opened(served.address, path, protocol) as line:
                if waits:
                    assert line.recv(12) == b"HTTP/1.1 101"
                line.sendall(said)
                served.http.get("/health/live")
    for protocol in ("other", "viser-v0"):
        with opened(served.address, path, protocol) as line:
            assert line.recv(12) == b"HTTP/1.1 101"


def test_a_client_that_breaks_the_rules_costs_a_line_and_no_traceback(loaded: Forks, tmp_path: Path) -> None:
    told = {"log": str(tmp_path / "log"), "log_format": "json", "log_level": "INFO"}
    with loaded.serve(tmp_path / "data", figures=False, run_workers=0, **told) as served:
        for part in ("stream", "3d"):
            broken(served, part)
        with socket.create_connection(("127.0.0.1", int(served.address.rpartition(":")[2])), 60) as line:
            line.sendall(b"\x16\x03\x01\x02\x00\x01")  # as one who speaks TLS begins
            assert line.recv(12) == b"HTTP/1.1 400"
        assert served.http.get("/health/ready").status_code == 200
        served.kill(signal.SIGTERM)
    said = [entry for entry in lines((tmp_path / "log").read_text()) if entry["logger"] not in MACHINE]
    assert {"INFO", "WARNING"} >= {entry["level"] for entry in said}, said
    assert not [entry for entry in said if "exception" in entry or "Traceback" in entry["message"]]
    assert any("Invalid HTTP request" in entry["message"] for entry in said)
    assert len(said) <= 4 * len(RUDE) + 3
