"""A WebSocket that also takes framed messages, so that a message for many pages is framed once."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Callable
from typing import Any, cast

from starlette.websockets import WebSocket
from uvicorn._types import ASGISendEvent
from uvicorn.config import Config
from uvicorn.protocols.utils import ClientDisconnected
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from uvicorn.server import ServerState
from websockets.exceptions import InvalidState
from websockets.frames import CloseCode, Frame, Opcode, apply_mask  # type: ignore[attr-defined]
from websockets.http11 import Request

EXTENSION = "combbench.line"


def text_message(text: str) -> bytes:
    """Frame a text message."""
    return Frame(Opcode.TEXT, text.encode()).serialize(mask=False)


def binary_head(length: int) -> bytes:
    """Return the bytes before a binary message of a length (RFC 6455, 5.2)."""
    first = 0x80 | Opcode.BINARY
    if length < 126:
        return struct.pack("!BB", first, length)
    if length < 1 << 16:
        return struct.pack("!BBH", first, 126, length)
    return struct.pack("!BBQ", first, 127, length)


def short_text(data: bytes) -> bytes | None:
    """Return the text if the bytes are one whole short message of a client and nothing else (RFC 6455, 5.2)."""
    if len(data) < 6 or data[0] != 0x80 | Opcode.TEXT or not 0x80 <= data[1] < 0x80 + 126:
        return None
    return apply_mask(data[6:], data[2:6]) if len(data) == 6 + data[1] - 0x80 else None


def ends_whole(data: bytes) -> bool:
    """Return whether the bytes, which begin with a message of a client, end with the end of one."""
    at = 0
    while len(data) - at >= 6:
        length, head = data[at + 1] & 0x7F, 6
        if length >= 126:
            size = 2 if length == 126 else 8
            length, head = int.from_bytes(data[at + 2 : at + 2 + size]), 6 + size
        at += head + length
    return at == len(data)


class WebSocketLine(WebSocketsSansIOProtocol):
    """uvicorn's WebSocket, with a short way past the application in both directions.

    The usual way costs two turns of the event loop and a copy for each message: too much for a picture sixty times a
    second to each of 200 pages. uvicorn still handles handshake, limits, pings and closing. A short message that
    arrives alone bypasses the parser too, as long as all bytes before it were whole messages.
    """

    def __init__(
        self,
        config: Config,
        server_state: ServerState,
        app_state: dict[str, Any],
        _loop: asyncio.AbstractEventLoop | None = None,
    ) -> None:
        super().__init__(config, server_state, app_state, _loop)
        self.hear: Callable[[bytes], bool] = lambda _text: False
        """Called first with each text message; returns true if it has handled the message."""
        self.drained: Callable[[], None] = lambda: None
        """Called when a full line takes more again."""
        self._written = 0
        self._is_new = self._is_whole = True

    @classmethod
    def of(cls, socket: WebSocket) -> WebSocketLine:
        """Return the line under a socket."""
        return cast(WebSocketLine, socket.scope["extensions"][EXTENSION])

    @property
    def is_free(self) -> bool:
        """Whether a message written now leaves soon: few earlier bytes still wait."""
        return self.writable.is_set()

    @property
    def waiting(self) -> int:
        """Bytes written that wait for room at the other side."""
        return int(self.transport.get_write_buffer_size())

    @property
    def passed_on(self) -> int:
        """Bytes written that have left this process."""
        return self._written - self.waiting

    def write(self, data: bytes) -> None:
        """Write messages that are framed already; nothing after the close."""
        if not (self.close_sent or self.transport.is_closing()):
            self._written += len(data)
            self.transport.write(data)

    def cut(self) -> None:
        """Cut the connection of a client that does not take the close."""
        self.transport.abort()

    # uvicorn calls the methods below.

    def handle_connect(self, event: Request) -> None:
        """Let the application find this line."""
        super().handle_connect(event)
        if not self.close_sent:
            cast(dict[str, Any], self.scope["extensions"])[EXTENSION] = self

    def data_received(self, data: bytes) -> None:
        """Take bytes that have arrived."""
        if self._is_new:  # the request that opens it
            self._is_new = False
        elif self._is_whole:
            if self.handshake_complete and not self.close_sent:
                text = short_text(data)
                if text is not None and self.hear(text):
                    return
            self._is_whole = ends_whole(data)
        super().data_received(data)

    def handle_events(self) -> None:
        """Handle the received data; no message can be refused before the client was answered."""
        try:
            super().handle_events()
        except InvalidState:
            self.handle_parser_exception()

    def handle_parser_exception(self) -> None:
        """Cut a client that breaks the rules before it was answered: no close can be sent yet."""
        if self.conn.close_sent is None:
            self.queue.put_nowait({"type": "websocket.disconnect", "code": CloseCode.PROTOCOL_ERROR, "reason": ""})
            self.transport.abort()
        else:
            super().handle_parser_exception()

    async def send(self, message: ASGISendEvent) -> None:
        """Send a message of the application; no answer is owed to a client that left before it."""
        if not self.handshake_complete and self.transport.is_closing():
            raise ClientDisconnected
        await super().send(message)

    def handle_text(self, event: Frame) -> None:
        """Pass a whole message to `hear`."""
        if not (event.fin and not self.close_sent and self.hear(bytes(event.data))):
            super().handle_text(event)

    def resume_writing(self) -> None:
        """Go on writing."""
        super().resume_writing()
        self.drained()
