"""Snapshots: journals of a bench that are kept, so that it can go back to their ends; on the engine thread."""

from __future__ import annotations

import secrets
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from server.bench.events import Event
from server.bench.journal import Journal
from server.bench.status import Snapshot
from server.errors import ApiError, not_found

if TYPE_CHECKING:
    from server.bench.bench import LiveBench


@dataclass(frozen=True)
class Kept:
    """A snapshot and its journal."""

    snapshot: Snapshot
    journal: Journal


class Snapshots:
    """The snapshots of a bench.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    """

    def __init__(self, bench: LiveBench) -> None:
        self._bench = bench
        self._kept: dict[str, Kept] = {}

    def all(self) -> list[Snapshot]:
        """List them, oldest first."""
        return [kept.snapshot for kept in list(self._kept.values())]

    def take(self, name: str, actor: str, most: int) -> Snapshot:
        """Keep the journal up to now."""
        if len(self._kept) >= most:
            raise ApiError(409, "too_many_snapshots", f"{most} snapshots are kept, the limit (max_snapshots)")
        journal = self._bench.journal(is_lean=True)
        snapshot = Snapshot(id=secrets.token_hex(6), tick=journal.tick, name=name, created=datetime.now(UTC))
        self._kept[snapshot.id] = Kept(snapshot, journal)
        self._bench.note(actor, "snapshot_taken", f"kept this moment as {name or snapshot.id}")
        return snapshot

    def get(self, snapshot_id: str) -> Kept:
        """Return a snapshot and its journal."""
        if snapshot_id not in self._kept:
            raise not_found("snapshot", snapshot_id)
        return self._kept[snapshot_id]

    def restore(self, snapshot_id: str, actor: str) -> Event:
        """Go back to a snapshot."""
        kept = self.get(snapshot_id)
        text = f"went back to {kept.snapshot.name or kept.snapshot.id}"
        return self._bench.changes.stand(kept.journal, actor, "restored", text)

    def forget(self, snapshot_id: str) -> None:
        """Forget a snapshot."""
        del self._kept[self.get(snapshot_id).snapshot.id]
