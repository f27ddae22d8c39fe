"""One open stream: it sends messages in a fixed order and no more than the client takes.

The server queues hardly anything per client. It reads events from the bench's log behind a cursor, and takes a picture
at the moment it can be sent. A slow client therefore costs one frame slot and sees the newest picture.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections import deque
from collections.abc import Callable

from pydantic import BaseModel

from server.bench.bench import Seen
from server.bench.narration import NarrationPlace
from server.metrics import Sent
from server.security.person import TEACHER, Person
from server.stream.codec import encode
from server.stream.cuts import SharedCuts
from server.stream.line import WebSocketLine, binary_head, text_message
from server.stream.news import News
from server.stream.panel import Panel
from server.stream.wire import Notice, Reply

log = logging.getLogger(__name__)

CLOSE_SLOW, CLOSE_FAILED = 4408, 1011

WINDOW = 2
"""Most frames sent and not acknowledged yet."""

STATUSES = 4
"""Most statuses sent and not taken yet, to a client that tells how many it has taken: a page that was stopped for a
minute has not to work through a minute of them."""

STALL_S = 5.0
"""The stream of a client that takes nothing for this long is closed."""

MOST_WAITING = 500
"""Most answers that wait for a client that asks and does not read."""


class Client:
    """The sending half of a stream; all of it on the event loop.

    Parameters
    ----------
    line : Line
        The accepted connection.
    session : LiveBench or View
        The bench it watches, as it may be seen.
    sent : Sent
        Where frames are counted.
    news : News
        The messages about the bench.
    cuts : SharedCuts
        The pictures of the bench.
    last_event : int
        Number of the last event the client has.
    person : Person
        Whose page it is.
    clock : callable
        Seconds.
    """

    def __init__(
        self,
        line: WebSocketLine,
        session: Seen,
        sent: Sent,
        news: News,
        cuts: SharedCuts,
        last_event: int,
        person: Person = TEACHER,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self.person, self._clock = person, clock
        self.line, self.session, self.cuts = line, session, cuts
        self._sent, self._news = sent, news
        self.name = "page"
        self.panels: dict[int, Panel] = {}
        self.dropped = 0
        self.closing: tuple[int, str] | None = None
        self.closed = asyncio.Event()
        self._cursor = last_event
        self._edition, self._said = 0, NarrationPlace()
        self._outbox: deque[bytes] = deque()
        self._wants_events = self._wants_status = self._wants_frame = False
        self._frame = self._acked = 0
        self._statuses, self._taken = 0, -1
        self._taken_at = self._moved_at = clock()
        self._passed_on = 0
        self._told_slow_at = -1e9

    def offer(self, *, events: bool = False, status: bool = False, frame: bool = False) -> None:
        """Mark the kinds of news: events, status, pictures."""
        self._wants_events |= events
        self._wants_status |= status
        if frame:
            self._wants_frame = True
            if self.panels and not self._has_room:
                self._drop()
        self.flush()

    def post(self, message: BaseModel) -> None:
        """Send a reply, an error or a notice at once, or as soon as the line takes it."""
        if self.closing is not None:
            return
        self._outbox.append(text_message(message.model_dump_json(exclude_none=isinstance(message, Reply))))
        self.flush()
        if len(self._outbox) > MOST_WAITING:
            self.close(CLOSE_SLOW, "answers were asked for and not read")

    def answer(self, reply: Reply) -> None:
        """Answer a command that was carried out, after the status that it caused: a page then has both."""
        if self.closing is not None:
            return
        self._outbox += self._status()
        self.post(reply)

    def acknowledge(self, frame: int) -> None:
        """Note that the client has taken every frame up to this one."""
        self._acked = max(self._acked, min(frame, self._frame))
        self._taken_at = self._clock()
        if self._wants_frame:
            self.flush()

    def took(self, statuses: int) -> None:
        """Note how many statuses the client has taken, and send the news that waited for it."""
        self._taken = max(self._taken, min(statuses, self._statuses))
        self.flush()

    def resume(self, after: int) -> None:
        """Send the events after this one (again)."""
        self._cursor = min(after, self.session.events.last)
        self.offer(events=True)

    def stalled(self, now: float) -> bool:
        """Return whether the client has taken nothing for too long although something waited for it.

        A client may acknowledge frames it has not read, so bytes must also leave for it.
        """
        if self.line.waiting == 0 or self.line.passed_on > self._passed_on:
            self._passed_on, self._moved_at = self.line.passed_on, now
        unread = now - self._moved_at > STALL_S
        return unread or (self._frame > self._acked and now - self._taken_at > STALL_S)

    def close(self, code: int, reason: str) -> None:
        """Close the stream behind the messages sent so far."""
        self.closing = self.closing or (code, reason)
        self.closed.set()

    def flush(self) -> None:
        """Send the messages that are due, as far as the line takes them; the rest follows when it has drained."""
        if self.closing is not None:
            return
        try:
            while self.closing is None and self.line.is_free and (due := self._due()):
                self.line.write(b"".join(due))
        except Exception:
            log.exception("a stream of bench %s broke off", self.session.id)
            self.close(CLOSE_FAILED, "the server failed on this stream; its log says why")

    @property
    def _has_room(self) -> bool:
        """Whether another frame may be sent."""
        return self._frame - self._acked < WINDOW and self.line.is_free

    @property
    def _lags(self) -> bool:
        """Whether it has not taken the last statuses; news wait until it has."""
        return self._taken >= 0 and self._statuses - self._taken >= STATUSES

    def _due(self) -> list[bytes]:
        """Take the messages to send now; written together they cost one system call."""
        due = [*self._outbox]
        self._outbox.clear()
        if self._lags:
            return due
        if self._wants_events:
            due += self._events()
        said, self._said = self._news.narration(self._said)
        due += said
        if self._wants_status:
            due += self._status()
        if self._wants_frame and self._has_room:
            due += self._picture()
        return due

    def _events(self) -> list[bytes]:
        """Return some of the events after the cursor; if the log has forgotten some, give their number."""
        messages, self._cursor = self._news.events(self._cursor)
        self._wants_events = bool(messages)
        return messages

    def _status(self) -> list[bytes]:
        """Return the status, with the scenario only if that has changed since; then the captures that are new."""
        self._wants_status = False
        self._statuses += 1
        status = self._news.status(self._edition, self.dropped)
        self._edition = self._news.edition
        captured = [panel.captures(number) for number, panel in self.panels.items()]
        return [status, *(text_message(one.model_dump_json()) for one in captured if one is not None)]

    def _picture(self) -> list[bytes]:
        """Return the pictures that have changed as one frame."""
        self._wants_frame = False
        shown = [
            (number, panel.revision, picture)
            for number, panel in self.panels.items()
            if (picture := panel.picture(self.cuts))
        ]
        if not shown:
            return []
        if self._frame == self._acked:
            self._taken_at = self._clock()
        self._frame += 1
        parts = encode(self._frame, self.session.is_running, self.cuts.moment, shown)
        length = sum(map(len, parts))
        self._sent.frames += 1
        self._sent.frame_bytes += length
        return [binary_head(length), *parts]

    def _drop(self) -> None:
        """Count a frame the client was too slow for, and send it a notice now and then."""
        if not self.session.is_running:
            return
        self.dropped += 1
        self._sent.frames_dropped += 1
        now = self._clock()
        if now - self._taken_at > 1.0 and now - self._told_slow_at > STALL_S:
            self._told_slow_at = now
            text = f"this page takes frames too slowly; {self.dropped} were left out"
            self.post(Notice(code="slow_client", message=text))
