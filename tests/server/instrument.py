"""An instrument as a plain socket: it speaks the protocol as docs/your-device.md has it."""

from __future__ import annotations

import json
import socket
import struct
from typing import Any

import numpy as np

from tests.server.conftest import HANGS_S


class FakeInstrument:
    """A connection to the port for instruments; ``header`` fields replace those of a usual one."""

    def __init__(self, listens: str, **header: Any) -> None:
        host, _, port = listens.rpartition(":")
        self.socket = socket.create_connection((host, int(port)), timeout=HANGS_S)
        self.rate_khz = header.get("rate_khz", 50.0)
        self._answers = self.socket.makefile("rb")
        self._fields = {"version": 1, "source": "scope", "rate_khz": self.rate_khz, **header}

    def begin(self) -> dict[str, Any]:
        """Send the header; return the answer."""
        self.send(json.dumps(self._fields).encode() + b"\n")
        return self.answer()

    def send(self, content: bytes) -> None:
        self.socket.sendall(content)

    def block(self, number: int, first: int, drive: Any, displacement: Any, count: int | None = None) -> None:
        """Send a block whose first sample is the sample ``first`` by the clock of the instrument."""
        pairs = np.column_stack((drive, displacement)).astype("<f8")
        time_ns = round(first * 1e6 / self.rate_khz)
        head = struct.pack("<QqI", number, time_ns, len(pairs) if count is None else count)
        self.send(head + pairs.tobytes())

    def answer(self) -> dict[str, Any]:
        """Return the next line of the server."""
        line = self._answers.readline()
        found: dict[str, Any] = json.loads(line) if line else {}
        return found

    def close(self) -> None:
        self._answers.close()
        self.socket.close()

    def __enter__(self) -> FakeInstrument:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
