"""CPU time of a piece of work, of a tick of a board, of some of its blocks."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from core.board import fold, program, steps
from core.board.board import CHUNK, Board

REPEATS = 7


def cpu_ns(work: Callable[[], Any], units: int) -> float:
    """Return the CPU time of one unit of work, ns."""
    begin = time.thread_time_ns()
    work()
    return (time.thread_time_ns() - begin) / units


def interleaved(candidates: Mapping[str, Callable[[], float]], repeats: int = REPEATS) -> dict[str, list[float]]:
    """Measure candidates in turn, so that drift affects all in the same way; return the results of each repeat."""
    costs: dict[str, list[float]] = {name: [] for name in candidates}
    for measure in candidates.values():
        measure()
    for _ in range(repeats):
        for name, measure in candidates.items():
            costs[name].append(measure())
    return costs


def advance_cost(board: Board, ticks: int = 100 * CHUNK) -> float:
    """Return the full cost of a tick on a bench, ns: blocks, trace rows, log, digest."""

    def work() -> None:
        for _ in range(ticks // CHUNK):
            board.advance(CHUNK)

    cost = cpu_ns(work, ticks)
    must_run(board)
    return cost


def must_run(board: Board) -> None:
    """Raise an error when a board that was measured has stopped: standing still costs nothing."""
    if board.trip is not None:
        raise RuntimeError(f"the board to be measured has stopped: {board.trip.reason}")


def loop_cost(board: Board, keys: list[str], ticks: int = 100_000) -> float:
    """Return the cost of a tick of some blocks alone, without trace or digest, ns."""
    wiring = board.wiring
    rows = [wiring.row(key) for key in keys]
    table = np.ascontiguousarray(wiring.table[rows])
    table[:, program.ADDRESS] = [steps.address(wiring, row) for row in rows]
    nothing = np.zeros((ticks, 0))
    arrays = (table, wiring.p, wiring.s, wiring.w, wiring.io)
    trip, watches = wiring.trip, np.zeros((0, 3))

    def work() -> None:
        program.run(ticks, 1, board.dt_ms, *arrays, nothing, nothing, fold.begin(0), trip, watches)

    return cpu_ns(work, ticks)


ALIVE = ("plant", "effects", "sensor", "reference", "model", "open_loop", "drive")
"""Blocks that keep every signal moving: with frozen inputs a block does not do its usual work."""


def block_costs(board: Board, *only: str, alive: Sequence[str] = ALIVE) -> dict[str, float]:
    """Return the cost of some blocks or all, ns per tick, dispatch included.

    It is the time by which a tick is longer when it runs the block once more. The least of all repeats counts, because
    other work on the machine only adds to it.
    """
    candidates = {"": partial(loop_cost, board, [*alive], 50_000)}
    for instance in board.wiring.instances:
        if not only or instance.key in only:
            candidates[instance.key] = partial(loop_cost, board, [*alive, instance.key], 50_000)
    ns = {key: min(values) for key, values in interleaved(candidates).items()}
    return {key: round(value - ns[""], 1) for key, value in ns.items() if key}
