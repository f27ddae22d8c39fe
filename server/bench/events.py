"""The event log of a bench: events numbered without gaps."""

from __future__ import annotations

import threading
from collections import deque
from datetime import UTC, datetime
from itertools import islice
from typing import Any

from pydantic import BaseModel, Field

KEPT = 4000


class Event(BaseModel):
    """One thing that happened, at a tick."""

    seq: int = Field(description="Number of the event on this bench: 1, 2, 3, ...")
    tick: int
    actor: str = Field(description="Who did it: a person's page, the API, the scenario or the board itself")
    kind: str
    text: str = Field(description="One line for a person, past tense")
    command: dict[str, Any] | None = None
    old: Any = None
    new: Any = None
    at: datetime = Field(description="Wall clock, UTC")


class EventLog:
    """The engine appends events, the event loop reads them; the log keeps the last `KEPT` events."""

    def __init__(self) -> None:
        self._events: deque[Event] = deque(maxlen=KEPT)
        self._lock = threading.Lock()
        self.last = 0

    def add(
        self,
        tick: int,
        actor: str,
        kind: str,
        text: str,
        command: dict[str, Any] | None = None,
        old: Any = None,
        new: Any = None,
    ) -> Event:
        """Append an event and return it with its number."""
        with self._lock:
            event = Event(
                seq=self.last + 1,
                tick=tick,
                actor=actor,
                kind=kind,
                text=text,
                command=command,
                old=old,
                new=new,
                at=datetime.now(UTC),
            )
            self._events.append(event)
            self.last = event.seq
        return event

    def after(self, seq: int, limit: int | None = None) -> tuple[int, list[Event]]:
        """Return how many events behind ``seq`` are forgotten, and the oldest of those that are kept.

        Parameters
        ----------
        seq : int
            Number of the last event the caller has.
        limit : int, optional
            Most events returned.
        """
        with self._lock:
            first = self._events[0].seq if self._events else self.last + 1
            lost = max(0, first - 1 - seq)
            start = max(0, seq + 1 - first)
            stop = len(self._events) if limit is None else start + limit
            return lost, list(islice(self._events, start, stop))
