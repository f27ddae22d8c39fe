"""The journal of a bench: numbers its events, counts them and passes them to its recordings."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from core.board.log import Log
from server.bench.events import Event, EventLog
from server.metrics import Metrics


class Journal:
    """Writes the events of one bench; on the engine thread.

    Parameters
    ----------
    metrics : Metrics
        Where events are counted.
    on_event : callable
        Called with every event that is added.
    """

    def __init__(self, metrics: Metrics, on_event: Callable[[Event], None]) -> None:
        self.events = EventLog()
        self._metrics, self._on_event = metrics, on_event
        self._logged = 0

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
        """Add an event."""
        self._metrics.events.labels(kind).inc()
        event = self.events.add(tick, actor, kind, text, command, old, new)
        self._on_event(event)
        return event

    def follow(self, log: Log) -> list[Event]:
        """Add what a board has logged since the last time; return the new events."""
        new = log.after(self._logged)
        self._logged = log.last
        return [
            self.add(entry.tick, entry.actor, entry.kind, entry.text, entry.command, entry.old, entry.new)
            for entry in new
        ]

    def skip_to(self, number: int) -> None:
        """Take the entries of the log up to a number as added already; 0 before the first."""
        self._logged = number
