"""Measured cost of a tick of a board with each plant."""

from __future__ import annotations

import time
from dataclasses import dataclass

from core.board.board import Board, Checkpoint
from core.board.commands import Set
from core.errors import InputError
from core.registry import blocks

WARM_TICKS = 200
LEAST_S = 0.01


@dataclass(frozen=True)
class PlantCost:
    """CPU time of one tick of the whole board with this plant, ns; none when the board cannot have it, and why."""

    name: str
    title: str
    ns_per_tick: float | None
    refused: str = ""


def plant_costs(checkpoint: Checkpoint) -> list[PlantCost]:
    """Measure every plant on copies of a board; the board itself does not change."""
    return [_measure(name, block.title, checkpoint) for name, block in blocks("plant").items()]


def _measure(name: str, title: str, checkpoint: Checkpoint) -> PlantCost:
    board = Board.restore(checkpoint)
    board.pending.clear()
    try:
        if board.spec.plant.block.name != name:
            board.apply(Set(set={"plant.model": name}), "cost")
    except InputError as error:
        return PlantCost(name, title, None, str(error))
    board.advance(WARM_TICKS)
    ticks, begin = 0, time.thread_time()
    while (spent := time.thread_time() - begin) < LEAST_S:
        rows = board.advance(board.chunk)
        if rows.count == 0:
            reason = board.trip.reason if board.trip is not None else "the board is paused"
            return PlantCost(name, title, None, reason)
        ticks += rows.count
    return PlantCost(name, title, 1e9 * spent / ticks)
