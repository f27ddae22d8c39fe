"""The event log of a bench: events numbered without gaps."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from datetime import UTC, datetime
from itertools import islice
from typing import TYPE_CHECKING, Annotated, Any, cast

from pydantic import Field

from core.board.commands import COMMANDS
from core.board.document import Document
from core.board.log import Log, LogEntry
from scenarios.json_schema.components import described_by
from server.bench.commands import RUN_KINDS

if TYPE_CHECKING:
    from server.bench.replay import TickSource

KEPT = 4000


Logged = Annotated[Document, described_by(*(one.__name__ for one in (*COMMANDS.values(), *RUN_KINDS.values())))]
"""A command as the log has it."""


class Event(LogEntry):
    """One thing that happened, at a tick."""

    seq: int = Field(description="Number of the event on this bench: 1, 2, 3, ...")
    actor: str = Field(description="Who did it: a person's page, the API, the scenario or the board itself")
    text: str = Field(description="One line for a person, past tense")
    command: Logged | None = Field(None, description="The command, as an event of a scenario if it is to the board")
    at: datetime = Field(description="Wall clock, UTC")


class EventLog(Log):
    """The log of a live bench, to which its board adds too; the event loop reads it.

    It keeps the last `KEPT` events, and continues when the board goes back.

    Parameters
    ----------
    on_event : callable
        Called with every event that is added.
    """

    def __init__(self, on_event: Callable[[Event], None]) -> None:
        super().__init__()
        self._entries = deque(maxlen=KEPT)
        self._lock = threading.Lock()
        self._on_event = on_event

    def add(
        self,
        tick: int,
        actor: str,
        kind: str,
        text: str,
        command: Document | None = None,
        old: Any = None,
        new: Any = None,
    ) -> Event:
        """Append an event, report it and return it with its number."""
        event = self.keep(tick=tick, actor=actor, kind=kind, text=text, command=command, old=old, new=new)
        self._on_event(event)
        return event

    def keep(self, **fields: Any) -> Event:
        """Append an event of the past and return it."""
        with self._lock:
            event = Event(**{"seq": self.last + 1, "at": datetime.now(UTC), **fields})
            self._entries.append(event)
            self.last = event.seq
        return event

    def take_over(self, board: TickSource) -> None:
        """Add the past notes of a board, and let it note here from now on."""
        if board.log is self:
            return
        for entry in board.log:
            self.add(entry.tick, entry.actor, entry.kind, entry.text, entry.command, entry.old, entry.new)
        board.log = self

    def go_on(self, events: list[Event]) -> None:
        """Go on from the events of another log, which ended with these."""
        with self._lock:
            self._entries.extend(events)
            self.last = events[-1].seq if events else 0

    def copy(self) -> Log:
        """Return the log of a copy of the board, which has nothing in it."""
        return Log()

    def after(self, seq: int, limit: int | None = None) -> tuple[int, list[Event]]:
        """Return how many events after ``seq`` are forgotten, and the oldest kept events.

        Parameters
        ----------
        seq : int
            Number of the last event the caller has.
        limit : int, optional
            Most events returned.
        """
        with self._lock:
            first = self._entries[0].seq if self._entries else self.last + 1
            lost = max(0, first - 1 - seq)
            start = max(0, seq + 1 - first)
            stop = len(self._entries) if limit is None else start + limit
            return lost, cast("list[Event]", list(islice(self._entries, start, stop)))
