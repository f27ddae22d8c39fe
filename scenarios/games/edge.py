"""The edge of a bank: between the severities of a fault that it misses and those it finds."""

from __future__ import annotations

import math

from core.board.board import Board
from core.board.commands import Inject
from core.board.document import Document
from core.board.idle import leave_out_idle
from scenarios.edit import with_values
from scenarios.games.draw import BENCH, Draws
from scenarios.games.game import DIAGNOSER
from scenarios.run import build
from scenarios.schema import Scenario

GAME = "fool-the-bank"
NOISE_UM = (0.05, 0.5)
ONSET, AFTER, LAST = 1500, 2500, 500
"""Sample of the fault, samples from it to the end, and samples at the end that the verdict is taken from."""
RUNS, MISSED = 10, 9
"""Noise seeds of a verdict, and how many of them a missed fault is missed in."""
RUNGS, HALVINGS = 19, 8
"""Severities from a 512th of the end up, each by a root of two larger, and halvings between two of them."""


def document(seed: int) -> Document:
    """Return the bench of a seed: its device, its noise, the bank of section 5.2.4 that knows both."""
    draws = Draws(GAME, seed)
    bench = with_values(Scenario.load(BENCH), draws.device())
    return {
        **bench.document,
        "id": GAME,
        "title": "Fool the bank",
        "sensor": {**BENCH["sensor"], "noise_um": draws.ratio_between("noise", *NOISE_UM)},
        "diagnosers": {DIAGNOSER: {"kind": "mmae"}},
    }


class Edge:
    """The bank of one seed, tried with faults.

    Parameters
    ----------
    seed : int
        Of the game.
    fault : str
        Name of the fault.
    end : float
        Severity at the end of its range, signed.
    """

    def __init__(self, seed: int, fault: str, end: float) -> None:
        self._fault, self._end = fault, end
        self._healthy = []
        scenario = Scenario.load(document(seed))
        for noise in Draws(GAME, seed).noise_seeds(RUNS):
            board = build(scenario, noise)
            leave_out_idle(board)
            while board.tick < ONSET:
                board.advance(ONSET - board.tick)
            self._healthy.append(board.checkpoint())

    def missed_in(self, severity: float) -> int:
        """Return in how many noise seeds the bank misses the fault at a severity."""
        return sum(self._is_missed(Board.restore(one), severity) for one in self._healthy)

    def is_found(self, severity: float) -> bool:
        """Whether the bank finds the fault."""
        return self.missed_in(severity) < MISSED

    def _is_missed(self, board: Board, severity: float) -> bool:
        """Whether the verdict of the bank is healthy in most of the last samples; a board that stops has noticed."""
        board.apply(Inject(fault=self._fault, severity=severity))
        column, healthy = board.signals.index(f"{DIAGNOSER}.winner"), 0
        while board.tick < ONSET + AFTER:
            rows = board.advance(ONSET + AFTER - board.tick)
            if board.trip is not None:
                return False
            late = rows.outputs[max(0, ONSET + AFTER - LAST - rows.first_tick) :, column]
            healthy += int((late == 0.0).sum())
        return 2 * healthy > LAST

    def find(self) -> float | None:
        r"""Return the smallest severity that is found, with the sign of the end; None if none is found up to the end.

        It is the first crossing from below: a ladder :math:`s_k=s_\text{end}2^{(k-18)/2}` is climbed to the first rung
        that is found, and the step to it is halved eight times on a scale of logarithms, to 0.14 %.
        """
        below = 0.0
        for rung in range(RUNGS):
            above = self._end * math.sqrt(0.5) ** (RUNGS - 1 - rung)
            if self.is_found(above):
                return self._halved(below, above) if below else above
            below = above
        return None

    def _halved(self, below: float, above: float) -> float:
        for _ in range(HALVINGS):
            middle = math.copysign(math.sqrt(below * above), above)
            below, above = (below, middle) if self.is_found(middle) else (middle, above)
        return above
