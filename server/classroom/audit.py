"""The log of actions of users, with bench and time; it outlives the bench, and is deleted with the class."""

from __future__ import annotations

import logging
from collections import deque
from datetime import datetime
from typing import Any

from pydantic import BaseModel, ConfigDict
from sqlalchemy import delete, func, select

from server.bench.bench import LiveBench
from server.bench.events import Event
from server.clock import Clock
from server.paging import WHOLE, ListPage
from server.store.base import now
from server.store.change import Change
from server.store.database import Database
from server.store.people import AuditRow

log = logging.getLogger(__name__)

EVERY_S = 1.0
"""Between two writes; a crash loses no more."""
MOST = 100_000
"""Entries kept; beyond, the oldest are forgotten."""
OF_THE_BENCH = frozenset({"board", "scenario"})
"""Actors that are no people."""


class AuditEntry(BaseModel):
    """One action of a user."""

    model_config = ConfigDict(from_attributes=True)

    at: datetime
    actor: str
    class_id: str | None
    bench_id: str | None
    tick: int | None
    kind: str
    text: str


class Audit:
    """The log of actions of users.

    Parameters
    ----------
    database : Database
        Where it is kept.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self._waiting: deque[dict[str, Any]] = deque(maxlen=MOST)

    def witness(self, bench: LiveBench, event: Event) -> None:
        """Keep an event of a bench that a person caused; called on the engine's thread too."""
        if event.actor not in OF_THE_BENCH:
            self.add(event.actor, event.kind, event.text, bench.class_id, bench.id, event.tick)

    def add(
        self, actor: str, kind: str, text: str, class_id: str = "", bench_id: str = "", tick: int | None = None
    ) -> None:
        """Keep an action of a user; it is written within a second."""
        self._waiting.append(
            {
                "at": now(),
                "actor": actor[:120],
                "kind": kind[:32],
                "text": text[:400],
                "class_id": class_id or None,
                "bench_id": bench_id or None,
                "tick": tick,
            }
        )

    async def run(self, clock: Clock) -> None:
        """Write the new entries, again and again."""
        async for _ in clock.every(EVERY_S):
            try:
                await self.write()
            except Exception:
                log.exception("the log of actions could not be written; it is tried again")

    async def write(self) -> None:
        """Write the entries since the last time."""
        rows = [self._waiting.popleft() for _ in range(len(self._waiting))]
        if not rows:
            return
        try:
            await self._database.run(lambda session: session.add_all([AuditRow(**row) for row in rows]))
        except Exception:
            self._waiting.extendleft(reversed(rows))
            raise
        newest = select(func.max(AuditRow.id)).scalar_subquery()
        await self._database.run(lambda session: session.execute(delete(AuditRow).where(AuditRow.id <= newest - MOST)))

    async def entries(self, *, class_id: str = "", bench_id: str = "", page: ListPage = WHOLE) -> list[AuditEntry]:
        """Return the actions in a class or on a bench, newest first."""
        await self.write()
        query = page.chosen(select(AuditRow), AuditRow.id, newest_first=True)
        query = query.where(AuditRow.class_id == class_id if class_id else AuditRow.bench_id == bench_id)
        found = await self._database.run(lambda session: list(session.scalars(query)))
        rows = page.rows(found, lambda row: (row.id,))
        return [AuditEntry.model_validate(row) for row in rows]

    def forgetting(self, class_id: str) -> Change:
        """Forget the actions in a class."""
        gone = delete(AuditRow).where(AuditRow.class_id == class_id)
        return Change(lambda session: session.execute(gone), lambda: self.drop(class_id))

    def drop(self, class_id: str) -> None:
        """Drop the entries of a class that are not written yet."""
        waiting = [row for row in self._waiting if row["class_id"] != class_id]
        self._waiting.clear()
        self._waiting.extend(waiting)
