"""Track: checkpoints of a board and the deeds on it. From these any tick of its past is computed again."""

from __future__ import annotations

import copy
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from core.board.board import Board, Checkpoint
from core.board.commands import Command
from core.board.rows import Rows
from core.errors import InputError

EVERY = 10_000
"""Ticks between two checkpoints, as long as all of them are kept."""
FEWEST = 16
"""Checkpoints kept, however large they are."""


class Deed(NamedTuple):
    """A deed on a board from outside at a tick: a command, or the removal of a command that waited."""

    tick: int
    command: Command | None
    actor: str = ""
    waited: int = 0
    """Number of the command that waits no more, where there is no other."""

    def do(self, board: Board) -> None:
        """Do it to another board at the same tick."""
        if self.command is not None:
            board.apply(self.command, self.actor)
            return
        for entry in [one for one in board.pending if one.number == self.waited]:
            board.pending.remove(entry)


class Keyframe(NamedTuple):
    """A checkpoint on the track.

    ``deeds`` counts those done before it. A fixed mark stays, because no deed says how the board came to be so.
    """

    tick: int
    deeds: int
    checkpoint: Checkpoint
    is_fixed: bool = False


@dataclass(frozen=True)
class Passage:
    """The way from a checkpoint to a later tick."""

    checkpoint: Checkpoint
    deeds: tuple[Deed, ...]
    tick: int

    @property
    def ticks(self) -> int:
        """How many ticks are computed on it."""
        return self.tick - self.checkpoint.tick

    def board(self) -> Board:
        """Return the board at its end."""
        board = Board.restore(self.checkpoint)
        for _ in self.walk(board):
            pass
        return board

    def walk(self, board: Board) -> Iterator[Rows]:
        """Advance a board from the checkpoint to the end; each of its rows holds until the next rows are asked for."""
        for deed in self.deeds:
            yield from _advance(board, deed.tick)
            deed.do(board)
        yield from _advance(board, self.tick)


class Track:
    """The past of a board, as checkpoints and deeds; where they are many, older checkpoints are further apart.

    Parameters
    ----------
    board : Board
        The board at the first tick that can be computed again.
    most_bytes : int
        Memory of the checkpoints kept.
    """

    def __init__(self, board: Board, most_bytes: int) -> None:
        self._most = max(FEWEST, most_bytes // board.nbytes)
        self._marks: list[Keyframe] = []
        self._deeds: list[Deed] = []
        self._due = 0
        self.mark(board, is_fixed=True)

    @property
    def first_tick(self) -> int:
        """The first tick that can be computed again."""
        return self._marks[0].tick

    @property
    def ticks(self) -> set[int]:
        """Where it has checkpoints."""
        return {mark.tick for mark in self._marks}

    @property
    def last_tick(self) -> int:
        """The tick of the newest checkpoint."""
        return self._marks[-1].tick

    def follow(self, board: Board) -> None:
        """Take a checkpoint if one is due; called after the board has advanced."""
        if board.tick >= self._due:
            self.mark(board)

    def mark(self, board: Board, *, is_fixed: bool = False) -> None:
        """Take a checkpoint, fixed if something was done to the board that is no deed."""
        if not is_fixed and self._marks[-1].tick == board.tick:
            return
        self._marks.append(Keyframe(board.tick, len(self._deeds), board.checkpoint(), is_fixed))
        self._due = board.tick - board.tick % EVERY + EVERY
        if len(self._marks) > self._most:
            del self._marks[self._least()]

    def has_deeds_since(self, tick: int) -> bool:
        """Whether anything was done to the board at a tick or after it."""
        return bool(self._deeds) and self._deeds[-1].tick >= tick

    def note(self, deed: Deed) -> None:
        """Note a deed on the board."""
        self._deeds.append(deed)

    def go_back(self, board: Board) -> None:
        """Continue from a board that is at an earlier tick of this past."""
        self._cut(board.tick)
        self.mark(board, is_fixed=True)

    def copy(self) -> Track:
        """Return the same track, which does not follow the board."""
        other = copy.copy(self)
        other._marks, other._deeds = [*self._marks], [*self._deeds]
        return other

    def lean(self) -> Track:
        """Return the same track with the fewest checkpoints: the first, and those to which no deed leads."""
        other = self.copy()
        other._marks = [mark for mark in self._marks if mark.is_fixed]
        return other

    def until(self, board: Board) -> Track:
        """Return the track of a copy of the board that continues independently from a tick of this past."""
        other = self.copy()
        other.go_back(board)
        return other

    def to(self, tick: int, before: int = 0, *, is_before: bool = False) -> Passage:
        """Return the way to a tick.

        Parameters
        ----------
        tick : int
            The end of the way, with all deeds at that tick.
        before : int
            It begins so many ticks earlier, if the track goes back so far, or before that.
        is_before : bool
            Leave out the deeds at the tick where it ends.

        Raises
        ------
        InputError
            If the tick is before the first that can be computed again.
        """
        if tick < self.first_tick:
            raise InputError(f"tick {tick} is not kept, the first is {self.first_tick}", "tick")
        start = max(tick - before, self.first_tick)
        last = bisect_left if is_before else bisect_right
        mark = self._marks[max(last(self._marks, start, key=_tick), 1) - 1]
        deeds = self._deeds[mark.deeds : last(self._deeds, tick, key=_tick)]
        return Passage(mark.checkpoint, tuple(deeds), tick)

    def onward(self, board: Board, tick: int) -> Passage:
        """Return the way of a board on to a later tick; at its own tick of this past nothing has been done to it yet.

        It leaves out the deeds at the tick where it ends, so that the board can continue from there.
        """
        first, last = (bisect_left(self._deeds, end, key=_tick) for end in (board.tick, tick))
        return Passage(board.checkpoint(), tuple(self._deeds[first:last]), tick)

    def _cut(self, tick: int) -> None:
        """Forget the checkpoints and deeds at a tick and after it."""
        self._marks = [mark for mark in self._marks if mark.tick < tick]
        self._deeds = [deed for deed in self._deeds if deed.tick < tick]

    def _least(self) -> int:
        """Return the mark that is missed least: without it the gap is smallest as a share of its age."""
        ticks = np.array([mark.tick for mark in self._marks], dtype=np.float64)
        share = (ticks[2:] - ticks[:-2]) / (ticks[-1] - ticks[:-2])
        share[[mark.is_fixed for mark in self._marks[1:-1]]] = np.inf
        return int(np.argmin(share)) + 1 if np.isfinite(share).any() else 0


def _tick(one: Keyframe | Deed) -> int:
    """Return where something is on the track."""
    return one.tick


def _advance(board: Board, tick: int) -> Iterator[Rows]:
    """Advance a board to a tick."""
    while board.tick < tick:
        rows = board.advance(tick - board.tick)
        if not rows.count:
            raise RuntimeError(f"the board stopped at tick {board.tick}, which it had passed")
        yield rows
