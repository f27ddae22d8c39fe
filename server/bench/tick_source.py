"""The protocol of the object a bench advances: a board computes its ticks, a tape reads them from a recording."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from core.block import BlockParams
from core.board.board import Checkpoint
from core.board.commands import Command, Trip
from core.board.document import Document
from core.board.log import Log, LogEntry
from core.board.pending import Queue
from core.board.rows import Rows
from core.board.spec import Section, Spec
from core.loop.score import Scores
from core.signals import SignalTable


class TickSource(Protocol):
    """A live bench needs this of its board or of its tape."""

    log: Log
    """Log of its events."""

    @property
    def tick(self) -> int:
        """The next tick."""

    @property
    def chunk(self) -> int:
        """Most ticks of one call of ``advance``."""

    @property
    def dt_ms(self) -> float:
        """Sample interval, ms."""

    @property
    def spec(self) -> Spec:
        """The blocks and their parameters now."""

    @property
    def base(self) -> Document:
        """The document it was made from."""

    @property
    def signals(self) -> SignalTable:
        """Table of traced signals."""

    @property
    def diagnosers(self) -> dict[str, Section]:
        """Every diagnoser by its id."""

    @property
    def faults(self) -> Mapping[str, BlockParams]:
        """The faults that act, by name."""

    @property
    def pending(self) -> Queue:
        """Commands that wait for their moment."""

    @property
    def trip(self) -> Trip | None:
        """The trip that stopped it, if it has tripped."""

    def advance(self, n: int) -> Rows:
        """Run up to ``n`` ticks and return their rows."""

    def apply(self, command: Command, actor: str = ...) -> LogEntry:
        """Let a command take effect at this tick edge, or wait for its moment."""

    def scores(self) -> Mapping[str, Scores]:
        """Return the score of every diagnoser that chooses between hypotheses."""

    def digest(self) -> str:
        """Return the digest of the trace so far."""

    def checkpoint(self) -> Checkpoint:
        """Return everything it is at this tick edge."""

    def save(self) -> Document:
        """Return as a scenario document its start and its commands."""
