"""Measured cost of a tick of a board with each plant."""

from __future__ import annotations

import time

from pydantic import BaseModel

from core.board.board import Board, Checkpoint
from core.board.commands import SetValues
from core.errors import InputError
from core.registry import blocks

WARM_TICKS = 200
LEAST_S = 0.01


class MeasuredPlant(BaseModel):
    """CPU time of one tick of the whole bench with this plant; null when it cannot have it."""

    name: str
    title: str
    ns_per_tick: float | None
    refused: str


def plant_costs(board: Board) -> list[MeasuredPlant]:
    """Measure every plant on copies of a board; the board itself does not change."""
    checkpoint, costs = board.checkpoint(), []
    for name, block in blocks("plant").items():
        ns_per_tick, refused = _measure(name, checkpoint)
        costs.append(MeasuredPlant(name=name, title=block.title, ns_per_tick=ns_per_tick, refused=refused))
    return costs


def _measure(name: str, checkpoint: Checkpoint) -> tuple[float | None, str]:
    """Return the cost with a plant, or the reason why the board cannot have it."""
    board = Board.restore(checkpoint)
    board.pending.clear()
    try:
        if board.spec.plant.block.name != name:
            board.apply(SetValues(set={"plant.model": name}), "cost")
    except InputError as error:
        return None, str(error)
    board.advance(WARM_TICKS)
    ticks, begin = 0, time.thread_time()
    while (spent := time.thread_time() - begin) < LEAST_S:
        rows = board.advance(board.chunk)
        if rows.count == 0:
            return None, board.trip.reason if board.trip is not None else "the board is paused"
        ticks += rows.count
    return 1e9 * spent / ticks, ""
