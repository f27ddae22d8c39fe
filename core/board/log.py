"""Log: what was done to a board and what was found on it, numbered and append-only."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import Any

from core.board.commands import Command, LogEntry

KEPT = 4000
"""Findings kept at least: an intermittent fault makes thousands a second, and to repeat a run only deeds matter."""


class Log(Sequence[LogEntry]):
    """Entries in order; what was done, and so has a command, is never forgotten, the oldest of what was found is."""

    def __init__(self) -> None:
        self._entries: list[LogEntry] = []
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
        time_ms: float,
        actor: str,
        kind: str,
        text: str,
        *,
        command: Command | None = None,
        old: Any = None,
        new: Any = None,
    ) -> LogEntry:
        """Append an entry and return it with its number."""
        document = command.model_dump(exclude_none=True, mode="json") if command is not None else None
        self.last += 1
        entry = LogEntry(
            seq=self.last,
            tick=tick,
            time_ms=time_ms,
            actor=actor,
            kind=kind,
            text=text,
            command=document,
            old=old,
            new=new,
        )
        self._entries.append(entry)
        self._findings += command is None
        if self._findings > 2 * KEPT:
            self._forget()
        return entry

    def after(self, seq: int) -> list[LogEntry]:
        """Return the entries behind a number, oldest first."""
        return list(takewhile(lambda entry: entry.seq > seq, reversed(self._entries)))[::-1]

    def copy(self) -> Log:
        """Return a log that goes on by itself."""
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
