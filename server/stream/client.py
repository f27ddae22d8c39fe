"""One open stream: what is sent, in which order, and never more than the client takes.

Nothing is queued per client. Events are read from the bench's log behind a cursor, a frame is cut from the
history at the moment it can be sent, so a slow client costs one frame slot and sees the newest picture.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable

from pydantic import BaseModel
from starlette.websockets import WebSocket

from server.bench.session import Session
from server.metrics import Metrics
from server.stream.codec import encode
from server.stream.cuts import SharedCuts
from server.stream.panel import Panel
from server.stream.wire import EventMessage, Notice, Reply

WINDOW = 2
"""Frames sent and not acknowledged yet, at most."""

STALL_S = 5.0
"""A client that takes nothing for this long is let go."""

EVENTS_AT_ONCE = 100


class Client:
    """The sending half of a stream.

    Parameters
    ----------
    socket : WebSocket
        Accepted.
    session : Session
        The bench it watches.
    metrics : Metrics
        Where frames are counted.
    describe : callable
        Returns the status message of a bench: session, whether with its parameters, frames dropped.
    cuts : SharedCuts
        The history, as all pages of the bench see it.
    last_event : int
        Number of the last event it is taken to know.
    """

    def __init__(
        self,
        socket: WebSocket,
        session: Session,
        metrics: Metrics,
        describe: Callable[[Session, bool, int], str],
        cuts: SharedCuts,
        last_event: int,
    ) -> None:
        self.socket, self.session, self._metrics, self._describe = socket, session, metrics, describe
        self._cuts = cuts
        self.name = "page"
        self.panels: dict[int, Panel] = {}
        self.dropped = 0
        self.closing: tuple[int, str] | None = None
        self.closed = asyncio.Event()
        self._wake = asyncio.Event()
        self._cursor = last_event
        self._outbox: deque[BaseModel] = deque()
        self._frame = 0
        self._acked = 0
        self._wants_frame = self._wants_status = False
        self._taken_at = time.monotonic()
        self._sending = self._owes_frame = False
        self._told_slow_at = -1e9
        self._told_at = -1

    # What others tell it; all on the event loop.

    def offer_frame(self) -> None:
        """Say that there may be a new picture."""
        if self._frame - self._acked >= WINDOW or self._sending:
            self._owes_frame = True
            if self.panels:
                self._drop()
            return
        self._wants_frame, self._owes_frame = True, False
        self._wake.set()

    def offer_status(self) -> None:
        """Say that the status is due."""
        self._wants_status = True
        self._wake.set()

    def offer_events(self) -> None:
        """Say that there may be new events."""
        self._wake.set()

    def post(self, message: BaseModel) -> None:
        """Send a reply, an error or a notice; the limits on what a client may ask bound their number."""
        self._outbox.append(message)
        self._wake.set()

    def acknowledge(self, frame: int) -> None:
        """Note that the client has taken every frame up to this one."""
        self._acked = max(self._acked, min(frame, self._frame))
        self._taken_at = time.monotonic()
        self._catch_up()

    def resume(self, after: int) -> None:
        """Send the events after this one (again)."""
        self._cursor = min(after, self.session.events.last)
        self._wake.set()

    def stalled(self, now: float) -> bool:
        """Whether it has taken nothing for too long although there was something to take."""
        waiting = self._sending or (self._frame > self._acked)
        return waiting and now - self._taken_at > STALL_S

    def close(self, code: int, reason: str) -> None:
        """Close the stream, behind what can still be sent at once."""
        self.closing = self.closing or (code, reason)
        self.closed.set()
        self._wake.set()

    def _catch_up(self) -> None:
        """Offer the frame that is owed: nothing else would, as a bench that stands still has no next round."""
        if self._owes_frame and not self.session.is_running:
            self._cuts.refresh()
            self.offer_frame()

    # What it does.

    async def run(self) -> None:
        """Send what is due whenever something is, until the stream is closed."""
        while self.closing is None:
            await self._wake.wait()
            self._wake.clear()
            while self._outbox:
                await self._send_message(self._outbox.popleft())
            await self._send_events()
            if self._wants_status:
                self._wants_status = False
                await self._send_status()
            if self._wants_frame:
                self._wants_frame = False
                await self._send_frame()
            self._catch_up()

    async def _send_status(self) -> None:
        """Send the status; the scenario as it is now only if something happened since."""
        changed = self.session.events.last != self._told_at
        self._told_at = self.session.events.last
        await self._send(self._describe(self.session, changed, self.dropped))

    async def _send_message(self, message: BaseModel) -> None:
        exclude_none = isinstance(message, Reply)
        await self._send(message.model_dump_json(exclude_none=exclude_none))

    async def _send_events(self) -> None:
        """Send every event behind the cursor; if the log has forgotten some, say how many."""
        while self._cursor < self.session.events.last:
            lost, events = self.session.events.after(self._cursor, EVENTS_AT_ONCE)
            if lost:
                text = f"{lost} events are older than this bench keeps"
                await self._send(Notice(code="events_lost", message=text).model_dump_json())
            for event in events:
                await self._send(EventMessage(event=event).model_dump_json())
                self._cursor = event.seq

    async def _send_frame(self) -> None:
        """Cut the pictures that changed and send them as one frame."""
        cuts = self._cuts
        pictures = [picture for panel in self.panels.values() if (picture := panel.picture(cuts))]
        if not pictures:
            return
        if self._frame == self._acked:
            self._taken_at = time.monotonic()
        self._frame += 1
        data = encode(self._frame, self.session.is_running, cuts.end_tick, self.session.dt_ms, pictures)
        await self._send(data)
        self._metrics.frames.inc()
        self._metrics.frame_bytes.inc(len(data))

    async def _send(self, data: str | bytes) -> None:
        """Send one message; the time it hangs counts as stalling."""
        self._sending = True
        if self._frame == self._acked:
            self._taken_at = time.monotonic()
        try:
            if isinstance(data, str):
                await self.socket.send_text(data)
            else:
                await self.socket.send_bytes(data)
        finally:
            self._sending = False

    def _drop(self) -> None:
        """Count a frame the client was too slow for, and tell it so now and then."""
        if not self.session.is_running:
            return
        self.dropped += 1
        self._metrics.frames_dropped.inc()
        now = time.monotonic()
        if now - self._taken_at > 1.0 and now - self._told_slow_at > STALL_S:
            self._told_slow_at = now
            text = f"this page takes frames too slowly; {self.dropped} were left out"
            self.post(Notice(code="slow_client", message=text))
