"""The journal of a bench: its scenario, the commands to it, and keyframes. A bench can be taken to its end."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from core.board.board import Board, Checkpoint
from core.board.history import History
from core.board.track import Track
from scenarios.schema import Scenario
from server.bench.narration import Told

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
