"""An HTTP connection that is closed when its client neither sends nor reads."""

from __future__ import annotations

import asyncio
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

HEAD_S = 10.0
"""Time for the head of a request, from the opening of the connection or from its first byte."""
BODY_S = 60.0
"""Time for its body: the largest at 20 kB/s."""
STALL_S = 30.0
"""Time in which a client with full buffers must take something of an answer."""
MOST_WAITING = 16
"""Most requests sent before the answer to the first; a chunk of requests takes a hundred times its size in memory."""


class Connection(HttpToolsProtocol):
    """Closes connections that wait too long; without free room, the connection that has waited longest."""

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._deadline: asyncio.TimerHandle | None = None
        self._stalled: asyncio.TimerHandle | None = None
        self._since = self.loop.time()

    @property
    def is_idle(self) -> bool:
        """Whether no request waits for an answer."""
        return self.cycle is None or self.cycle.response_complete

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for a request; close the longest idle connection if the server is full."""
        if self.limit_concurrency is not None and len(self.connections) >= self.limit_concurrency - 1:
            idle = [link for link in self.connections if isinstance(link, Connection) and link.is_idle]
            if idle:
                longest = min(idle, key=lambda link: link._since)
                self.connections.discard(longest)
                longest.transport.abort()
        super().connection_made(transport)
        self._wait(HEAD_S)

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop the timer."""
        self._wait(None)
        self.resume_writing()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Read on; an incomplete request must become complete in time."""
        super().data_received(data)
        is_ours = not self.transport.is_closing() and self.transport.get_protocol() is self
        if is_ours and self.is_idle and self._deadline is None:
            self._wait(HEAD_S)

    def on_message_begin(self) -> None:
        """Wait for the head, from the first byte on."""
        super().on_message_begin()
        if self._deadline is None:
            self._wait(HEAD_S)

    def on_headers_complete(self) -> None:
        """Wait for the body; refuse a client that sends many requests without waiting for answers.

        Raises
        ------
        ValueError
            The parser takes it for a malformed request.
        """
        if len(self.pipeline) >= MOST_WAITING:
            raise ValueError("too many requests at once")
        self._wait(BODY_S)
        super().on_headers_complete()

    def on_message_complete(self) -> None:
        """Stop the timer: the server answers now."""
        self._wait(None)
        super().on_message_complete()

    def on_response_complete(self) -> None:
        """Note the time from which the connection is idle."""
        self._since = self.loop.time()
        super().on_response_complete()

    def handle_websocket_upgrade(self) -> None:
        """Leave the connection to the WebSocket."""
        self._wait(None)
        super().handle_websocket_upgrade()

    def pause_writing(self) -> None:
        """Give a client that does not read some time."""
        self._stalled = self.loop.call_later(STALL_S, self.transport.abort)
        super().pause_writing()

    def resume_writing(self) -> None:
        """Go on with a client that reads."""
        if self._stalled is not None:
            self._stalled.cancel()
            self._stalled = None
        super().resume_writing()

    def _wait(self, seconds: float | None) -> None:
        """Close the connection after some time, unless something comes."""
        if self._deadline is not None:
            self._deadline.cancel()
        self._deadline = None if seconds is None else self.loop.call_later(seconds, self.transport.abort)
