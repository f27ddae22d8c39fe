"""Moments: the state of a bench at a tick edge, and the part of its past that still belongs to it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from core.board.board import Checkpoint
from core.board.rows import Rows
from scenarios.schema import Scenario
from server.bench.narration import Told


@dataclass(frozen=True)
class Moment:
    """A bench at a tick edge.

    Parameters
    ----------
    scenario : Scenario
        Its scenario, which a reset may have given other values.
    checkpoint : Checkpoint
        Its board.
    branch : int
        Its branch of time.
    past : Rows, optional
        The ticks before it, for when the history has them no more.
    last_event : int
        Number of the last event before it.
    told : Told, optional
        State of the narrator by then.
    """

    scenario: Scenario
    checkpoint: Checkpoint
    branch: int
    past: Rows | None = None
    last_event: int = 0
    told: Told | None = None


class Branches:
    """The branches of time of a bench: going back begins one, and so does a reset."""

    def __init__(self) -> None:
        self._began: list[tuple[int, int]] = [(-1, 0)]

    @property
    def current(self) -> int:
        """The branch of now."""
        return len(self._began) - 1

    def begin(self, parent: int = -1, tick: int = 0) -> None:
        """Begin a branch at a tick of another; without one, from nothing."""
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
