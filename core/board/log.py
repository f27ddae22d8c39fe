"""Log: the commands to a board and the findings on it, numbered and append-only."""

from __future__ import annotations

from collections.abc import Iterator, MutableSequence, Sequence
from typing import Any

from pydantic import BaseModel

from core.board.document import Document
from core.table import Words

KEPT = 4000
"""Findings kept at least: an intermittent fault makes thousands a second."""


class LogEntry(BaseModel):
    """One thing that happened, at a tick."""

    seq: int
    tick: int
    actor: str
    kind: str
    text: Words
    command: Document | None = None
    old: Any = None
    new: Any = None


class Log(Sequence[LogEntry]):
    """Entries in order; an entry with a command is never forgotten, the oldest findings are."""

    def __init__(self) -> None:
        self._entries: MutableSequence[LogEntry] = []
        self._findings = 0
        self.last = 0

    def __len__(self) -> int:
        return len(self._entries)

    def __getitem__(self, index: Any) -> Any:
        return self._entries[index]

    def __iter__(self) -> Iterator[LogEntry]:
        return iter(self._entries)

    def add(
        self,
        tick: int,
        actor: str,
        kind: str,
        text: str,
        command: Document | None = None,
        old: Any = None,
        new: Any = None,
    ) -> LogEntry:
        """Append an entry and return it with its number."""
        self.last += 1
        entry = LogEntry(seq=self.last, tick=tick, actor=actor, kind=kind, text=text, command=command, old=old, new=new)
        self._entries.append(entry)
        self._findings += command is None
        if self._findings > 2 * KEPT:
            self._forget()
        return entry

    def copy(self) -> Log:
        """Return an independent copy of the log."""
        twin = Log()
        twin._entries, twin._findings, twin.last = list(self._entries), self._findings, self.last
        return twin

    def _forget(self) -> None:
        """Drop the older half of the findings."""
        excess = self._findings - KEPT
        kept: list[LogEntry] = []
        for entry in self._entries:
            if excess > 0 and entry.command is None:
                excess -= 1
            else:
                kept.append(entry)
        self._entries, self._findings = kept, KEPT
