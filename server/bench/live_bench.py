"""The protocol of a live bench as its parts see it: its steps, its snapshots and its recordings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from core.board.document import Document
from core.board.history import History
from core.signals import Signal
from server.bench.events import Event, EventLog
from server.bench.pacing import Pacer
from server.bench.tick_source import TickSource


class LiveBench(Protocol):
    """The parts of a bench need this of the bench; all of it runs on the engine thread."""

    board: TickSource
    history: History
    events: EventLog

    @property
    def pacer(self) -> Pacer:
        """The pace of the bench."""

    @property
    def now(self) -> float:
        """The time on the engine's clock."""

    @property
    def dt_ms(self) -> float:
        """Device time of one tick."""

    @property
    def signals(self) -> Sequence[Signal]:
        """All signals, in the order of the history."""

    @property
    def column_of(self) -> dict[str, int]:
        """Column of each signal by name."""

    @property
    def drive_period_ticks(self) -> float | None:
        """Period of the reference in ticks, if it has one; of the driven axis where the plant has axes."""

    def must_be_open(self) -> None:
        """Raise an error if the bench is gone."""

    def advance(self, ticks: int) -> int:
        """Run ticks, as many as a slice has; return how many there were."""

    def note(self, actor: str, kind: str, text: str, command: Document | None = None, tick: int | None = None) -> Event:
        """Add an event of the bench itself, of now unless a tick is given."""

    def refresh_status(self) -> None:
        """Replace the status by the present status."""
