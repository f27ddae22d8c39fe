"""Snapshots: moments a bench can go back to; taken and forgotten on the engine thread."""

from __future__ import annotations

import secrets
from dataclasses import dataclass
from datetime import UTC, datetime

from server.bench.changes import ChangingBench
from server.bench.moment import Moment
from server.bench.status import Snapshot
from server.errors import ApiError, not_found


@dataclass(frozen=True)
class Kept:
    """A snapshot and the moment it holds."""

    snapshot: Snapshot
    moment: Moment


class Snapshots:
    """The moments kept of a bench.

    Parameters
    ----------
    bench : ChangingBench
        The bench.
    """

    def __init__(self, bench: ChangingBench) -> None:
        self._bench = bench
        self._kept: dict[str, Kept] = {}

    def all(self) -> list[Snapshot]:
        """List them, oldest first."""
        return [kept.snapshot for kept in list(self._kept.values())]

    def take(self, name: str, actor: str, most: int) -> Snapshot:
        """Keep this moment."""
        if len(self._kept) >= most:
            raise ApiError(409, "too_many_snapshots", f"{most} snapshots are kept, the limit (max_snapshots)")
        tick = self._bench.board.tick
        snapshot = Snapshot(id=secrets.token_hex(6), tick=tick, name=name, created=datetime.now(UTC))
        self._kept[snapshot.id] = Kept(snapshot, self._bench.moment())
        self._bench.note(actor, "snapshot_taken", f"kept this moment as {name or snapshot.id}")
        return snapshot

    def get(self, snapshot_id: str) -> Kept:
        """Return a kept moment."""
        if snapshot_id not in self._kept:
            raise not_found("snapshot", snapshot_id)
        return self._kept[snapshot_id]

    def forget(self, snapshot_id: str) -> None:
        """Forget a kept moment."""
        del self._kept[self.get(snapshot_id).snapshot.id]
