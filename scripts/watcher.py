"""One page's stream as a load sees it: a WebSocket client that costs little, so that the server is measured."""

from __future__ import annotations

import asyncio
import json
import time
from asyncio.transports import BaseTransport, Transport
from typing import cast

from websockets.client import ClientProtocol
from websockets.frames import Frame, Opcode
from websockets.http11 import Response
from websockets.typing import Subprotocol
from websockets.uri import parse_uri

from server.stream.codec import HEADER
from server.stream.wire import SUBPROTOCOL

SIGNALS = ["reference.voltage", "drive.voltage", "plant.displacement", "sensor.displacement"]
SUBSCRIBE = {
    "type": "subscribe",
    "panel": 1,
    "signals": SIGNALS,
    "mode": "roll",
    "window_ms": 4,
    "width": 800,
}
REPLY = b'{"type":"reply"'


class Watcher(asyncio.Protocol):
    """Takes and acknowledges every frame, and sends commands that change nothing.

    Parameters
    ----------
    address : str
        Of the stream.
    token : str
        That opens it.
    command : dict
        The command it sends, over and over.
    """

    def __init__(self, address: str, token: str, command: dict[str, object]) -> None:
        self._command = command
        self._lines = ClientProtocol(parse_uri(address), subprotocols=[Subprotocol(SUBPROTOCOL)])
        self._token = token
        self._transport: Transport | None = None
        self.opened, self.seen = asyncio.Event(), asyncio.Event()
        self.frames = 0
        self.late_ms: list[float] = []
        self.replies_ms: list[float] = []
        self.closed = ""

    def connection_made(self, transport: BaseTransport) -> None:
        """Shake hands."""
        self._transport = cast(Transport, transport)
        request = self._lines.connect()
        request.headers["Authorization"] = f"Bearer {self._token}"
        self._lines.send_request(request)
        self._flush()

    def data_received(self, data: bytes) -> None:
        """Take the received data."""
        now = time.monotonic()
        self._lines.receive_data(data)
        for event in self._lines.events_received():
            if isinstance(event, Response):
                self.say(SUBSCRIBE)
                self.opened.set()
            elif isinstance(event, Frame):
                self._take(event, now)
        self._flush()

    def connection_lost(self, exc: Exception | None) -> None:
        """Note why, if the server closed."""
        if self._lines.close_rcvd is not None:
            self.closed = f"{self._lines.close_rcvd.code} {self._lines.close_rcvd.reason}"
        elif not self.opened.is_set():
            self.closed = f"never opened: {exc or 'refused'}"
        self.opened.set()

    def say(self, message: dict[str, object]) -> None:
        """Send one message."""
        if not self.closed:
            self._lines.send_text(json.dumps(message).encode())
            self._flush()

    def ask(self) -> None:
        """Send a command; its answer tells how long it took."""
        self.say({"type": "command", "id": str(time.monotonic()), "command": self._command})

    def forget(self) -> None:
        """Begin to measure anew."""
        self.frames, self.late_ms, self.replies_ms = 0, [], []

    def stop_reading(self) -> None:
        """Read nothing from now on."""
        assert self._transport is not None
        self._transport.pause_reading()

    def leave(self) -> None:
        """Cut the line."""
        if self._transport is not None:
            self._transport.abort()

    def _take(self, frame: Frame, now: float) -> None:
        """Acknowledge a picture, time an answer."""
        if frame.opcode is Opcode.BINARY:
            _, _, _, number, _, _, cut_s = HEADER.unpack_from(frame.data)
            self._lines.send_text(b'{"type":"ack","frame":%d}' % number)
            self.frames += 1
            self.seen.set()
            self.late_ms.append(1e3 * (now - cut_s))
        elif frame.opcode is Opcode.TEXT and bytes(frame.data[: len(REPLY)]) == REPLY:
            self.replies_ms.append(1e3 * (now - float(json.loads(bytes(frame.data))["id"])))

    def _flush(self) -> None:
        """Send the data of the protocol."""
        if self._transport is not None and not self._transport.is_closing():
            self._transport.writelines([part for part in self._lines.data_to_send() if part])
