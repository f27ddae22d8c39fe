"""The journal of a bench: its scenario, the commands to it, and keyframes. A bench can go to its end, now or later."""

from __future__ import annotations

import math
import secrets
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from core.board.board import Board, Checkpoint
from core.board.history import History
from core.board.track import Track
from scenarios.schema import Scenario
from server.bench.events import Event
from server.bench.narration import Told
from server.bench.status import Snapshot
from server.errors import ApiError, not_found

if TYPE_CHECKING:
    from server.bench.bench import LiveBench

NO_BRANCH = -1


@dataclass(frozen=True)
class Journal:
    """The past of a bench up to a tick, which nothing changes any more.

    Parameters
    ----------
    scenario : Scenario
        Its scenario, which a reset may have given other values.
    keyframe : Checkpoint
        Its board at the end of the journal.
    track : Track
        The commands to the board, and earlier keyframes.
    told : Told or None
        The sentences of the narrator up to the end; None before the first tick.
    past : History or None
        Samples before the end. A bench takes them over if they have the size of its history; otherwise it copies them.
    branch : int
        Branch of time of the bench that it is the past of.
    last_event : int or None
        Number of the last event of that bench before the end.
    """

    scenario: Scenario
    keyframe: Checkpoint = field(repr=False)
    track: Track = field(repr=False)
    told: Told | None = field(default=None, repr=False)
    past: History | None = field(default=None, repr=False)
    branch: int = NO_BRANCH
    last_event: int | None = None

    @classmethod
    def beginning(cls, scenario: Scenario, board: Board, track_bytes: int) -> Journal:
        """Return the journal of a bench to which nothing has been done."""
        return cls(scenario, board.checkpoint(), Track(board, track_bytes))

    @property
    def tick(self) -> int:
        """Tick of its end."""
        return self.keyframe.tick

    def board(self) -> Board:
        """Return a board that continues from the end."""
        return Board.restore(self.keyframe)

    def for_another(self) -> Journal:
        """Return the journal for another bench, which has none of its branches and events."""
        return replace(self, branch=NO_BRANCH, last_event=None)


class Branches:
    """The branches of time of a bench: each return to an earlier tick begins one, and so does a reset."""

    def __init__(self) -> None:
        self._began: list[tuple[int, int]] = [(NO_BRANCH, 0)]

    @property
    def current(self) -> int:
        """The branch of now."""
        return len(self._began) - 1

    def begin(self, parent: int, tick: int) -> None:
        """Begin a branch at a tick of another, or of no branch of this bench."""
        self._began.append((parent, tick))

    def share(self, branch: int, tick: int) -> bool:
        """Whether the ticks before a tick of a branch are the ticks in the present history."""
        at, shared = self.current, math.inf
        while at >= 0:
            if at == branch:
                return tick <= shared
            at, began = self._began[at]
            shared = min(shared, began)
        return False


@dataclass(frozen=True)
class KeptJournal:
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
        self._kept: dict[str, KeptJournal] = {}

    def all(self) -> list[Snapshot]:
        """List them, oldest first."""
        return [kept.snapshot for kept in list(self._kept.values())]

    def take(self, name: str, actor: str, most: int) -> Snapshot:
        """Keep the journal up to now."""
        if len(self._kept) >= most:
            raise ApiError(409, "too_many_snapshots", f"{most} snapshots are kept, the limit (max_snapshots)")
        journal = self._bench.journal(is_lean=True)
        snapshot = Snapshot(id=secrets.token_hex(6), tick=journal.tick, name=name, created=datetime.now(UTC))
        self._kept[snapshot.id] = KeptJournal(snapshot, journal)
        self._bench.note(actor, "snapshot_taken", f"kept this moment as {name or snapshot.id}")
        return snapshot

    def get(self, snapshot_id: str) -> KeptJournal:
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
