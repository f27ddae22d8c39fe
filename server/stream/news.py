"""Status and events of a bench as messages, framed once for all its pages."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from server.bench.bench import Seen
from server.bench.narration import NarrationPlace
from server.stream.line import text_message
from server.stream.wire import EventsMessage, Narrated, Notice, Status

EVENTS_AT_ONCE = 100
MARKS_KEPT = 16
UNKNOWN_DROPPED = '"dropped_frames":-1'


class News:
    """The messages about one bench: its status and its events.

    Parameters
    ----------
    session : LiveBench or View
        The bench as those pages see it.
    around : callable
        Returns the fields of a status that the bench itself does not know.
    """

    def __init__(self, session: Seen, around: Callable[[], dict[str, Any]]) -> None:
        self._session, self._around = session, around
        self._document = session.document
        self.edition = 1
        """Number of the present parameters; it rises when they change."""
        self._status: object = None
        self._texts: dict[bool, str] = {}
        self._statuses: dict[tuple[bool, int], bytes] = {}
        self._events: dict[int, tuple[list[bytes], int]] = {}
        self._narration: dict[NarrationPlace, tuple[list[bytes], NarrationPlace]] = {}
        self._last = -1

    def status(self, known_edition: int, dropped: int) -> bytes:
        """Return the status for a page that knows some edition of the parameters and had some frames dropped."""
        if self._session.status is not self._status:
            self._status = self._session.status
            self._texts, self._statuses = {}, {}
            document = self._session.document
            if document != self._document:
                self._document = document
                self.edition += 1
        key = (known_edition != self.edition, dropped)
        if key not in self._statuses:
            dropped_field = f'"dropped_frames":{dropped}'
            self._statuses[key] = text_message(self._text(key[0]).replace(UNKNOWN_DROPPED, dropped_field))
        return self._statuses[key]

    def renew(self) -> None:
        """Make the next status a new one, because the surroundings of the bench have changed."""
        self._status = None

    def events(self, after: int) -> tuple[list[bytes], int]:
        """Return the messages with the oldest events after one, and the number of the last event in them."""
        if self._session.events.last != self._last:
            self._last = self._session.events.last
            self._events = {}
        if after not in self._events:
            lost, events = self._session.events.after(after, EVENTS_AT_ONCE)
            notices = (
                [Notice(code="events_lost", message=f"{lost} events are older than this bench keeps")] if lost else []
            )
            messages = [*notices, EventsMessage(events=events)] if events else notices
            last = events[-1].seq if events else after
            self._events[after] = ([text_message(message.model_dump_json()) for message in messages], last)
        return self._events[after]

    def narration(self, known: NarrationPlace) -> tuple[list[bytes], NarrationPlace]:
        """Return the message with the sentences a page does not know yet, if there are any, and how far they go."""
        now = self._session.narration.mark
        if known == now:
            return [], now
        if known not in self._narration or self._narration[known][1] != now:
            if len(self._narration) > MARKS_KEPT:
                self._narration = {}
            mark, after, sentences = self._session.narration.after(known)
            message = Narrated(after=after, sentences=sentences)
            self._narration[known] = [text_message(message.model_dump_json())], mark
        return self._narration[known]

    def _text(self, with_parameters: bool) -> str:
        """Return the status without the one number that differs from page to page."""
        if with_parameters not in self._texts:
            message = Status(
                **{**dict(self._session.status), **self._around()},
                parameters=self._document if with_parameters else None,
                dropped_frames=-1,
            )
            self._texts[with_parameters] = message.model_dump_json()
        return self._texts[with_parameters]
