"""The seven steps as a whole run in C: the ticks between commands, and the numbers that each command changes."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from core.board.board import CHUNK, Board
from core.board.idle import leave_out_idle
from scenarios.run import build
from scenarios.speed.anchor.difference import differences, digest
from scenarios.speed.anchor.pair import OURS, C, Costs
from scenarios.speed.anchor.text import BoardMoment
from scenarios.speed.anchor.twin import Array, Twin
from scenarios.speed.side_by_side import SAMPLES, side_by_side, wired_seven_steps
from scenarios.speed.timing import cpu_ns, must_run

PARTS = "p", "s", "w", "io"


@dataclass(frozen=True)
class ReplayPart:
    """Ticks without a command between them: the rows that run, and the numbers that the command before them wrote."""

    ticks: int
    on: Array
    written: dict[str, tuple[Array, Array]]


class ReplayInC:
    """The run on a board, with a note of the effect of every command, so that the C does the same without commands."""

    part = "whole run"
    goal = 1.15

    def __init__(self) -> None:
        self.board = build(side_by_side())
        leave_out_idle(self.board)
        self._start = Board.restore(self.board.checkpoint())
        self.moments: list[BoardMoment] = []
        self._parts: list[ReplayPart] = []
        while self.board.tick < SAMPLES:
            self._parts.append(self._part())
        self._differing: dict[str, None] = {}
        self.library: ctypes.CDLL | None = None
        """The C of all moments, once it is compiled."""

    def _part(self) -> ReplayPart:
        board = self.board
        before = {name: getattr(board.wiring, name).copy() for name in PARTS}
        board.apply_due()
        moment, written = BoardMoment.of(board), {}
        for name, old in before.items():
            new = getattr(moment.wiring, name)
            places = np.flatnonzero(old.view(np.uint64) != new.view(np.uint64))
            written[name] = places, new[places]
        self.moments.append(moment)
        upcoming = board.pending.next_tick
        end = SAMPLES if upcoming is None else min(upcoming, SAMPLES)
        while board.tick < end:
            board.advance(end - board.tick)
            must_run(board)
        return ReplayPart(end - moment.tick, moment.on, written)

    def costs(self) -> Costs:
        """Return the measurements of a run, ns: of the board with its commands, and of the C."""
        ours, library = {OURS: wired_seven_steps()}, self.library
        return {**ours, C: lambda: self._in_c(library)} if library else ours

    def differences(self) -> Iterator[str]:
        """Name the parts in which a run in C has differed at its end."""
        yield from self._differing

    def _in_c(self, library: ctypes.CDLL) -> float:
        twin = Twin(library, self._start)

        def work() -> None:
            for part in self._parts:
                twin.arrays["on"][:] = part.on
                for name, (places, numbers) in part.written.items():
                    twin.arrays[name][places] = numbers
                end = twin.tick + part.ticks
                while twin.tick < end:
                    twin.advance(min(CHUNK, end - twin.tick))
            digest(self.board, twin.arrays["folds"])

        cost = cpu_ns(work, 1)
        self._differing |= dict.fromkeys(differences(self.board, twin))
        return cost
