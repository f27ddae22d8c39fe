"""The loops of boards that a program drives: from the cut of a tick to the cut of a later tick."""

from __future__ import annotations

import numpy as np

from core.block import FloatArray, IntArray
from core.board.fold import Words
from core.board.fold import fold as fold_columns
from core.board.program import walk
from core.compile.instructions import address_of, call
from core.kernel import kernel
from core.ports import RESERVED, TICK, TIME_MS


@kernel
def begin_tick(
    tick: int,
    dt_ms: float,
    table: IntArray,
    cut: int,
    p: FloatArray,
    s: FloatArray,
    w: FloatArray,
    io: IntArray,
    rows: FloatArray,
    columns: IntArray,
    at: int,
) -> None:
    """Begin a tick of boards side by side: run the steps before the cut, and keep signals in row ``at``."""
    width = w.shape[1]
    for k in range(width):
        w[TICK, k] = tick
        w[TIME_MS, k] = tick * dt_ms
    walk(table[:cut], tick, width, address_of(p), address_of(s), address_of(w), address_of(io))
    for c in range(columns.shape[0]):
        for k in range(width):
            rows[at, c, k] = w[columns[c], k]


@kernel
def end_ticks(
    n: int,
    halts: bool,
    first_tick: int,
    dt_ms: float,
    table: IntArray,
    cut: int,
    p: FloatArray,
    s: FloatArray,
    w: FloatArray,
    io: IntArray,
    rows: FloatArray,
    columns: IntArray,
    at: int,
    fold: int,
    folds: Words,
    folded: IntArray,
    sizes: IntArray,
    lanes: IntArray,
    trip: int,
) -> int:
    """End up to ``n`` ticks that have begun, and begin the tick after each; return how many have ended.

    Parameters
    ----------
    halts : bool
        Whether to leave the tick after the last to `begin_tick`; so is the tick after one in which a board trips.
    table, cut : ndarray, int
        The rows that run, and how many of them come before the cut.
    p, s, w : ndarray, shape (numbers, boards)
        Parameters, states and signals, a column for each board.
    rows, columns, at : ndarray, ndarray, int
        Where signals are kept, shape (ticks, signals, boards), their places, and the first row to write.
    fold : int
        Address of the code that folds a tick of boards abreast; 0 for one board.
    folds, folded, sizes : ndarray
        The folds, the places of the outputs that count, and how many these are and all outputs.
    lanes : ndarray
        The columns whose trips count.
    trip : int
        The place of the signal that stops a board.
    """
    width = w.shape[1]
    bits = w.view(np.uint64)
    arrays = address_of(p), address_of(s), address_of(w), address_of(io)
    of_folds = address_of(folds), address_of(folded), address_of(sizes)
    for i in range(n):
        tick = first_tick + i
        walk(table[cut:], tick, width, arrays[0], arrays[1], arrays[2], arrays[3])
        if fold != 0:
            call(fold, arrays[2], of_folds[0], of_folds[1], of_folds[2])
        else:
            for c in range(folded.shape[0]):
                place = folded[c]
                fold_columns(folds[:, place - RESERVED : place - RESERVED + 1, 0], bits[place : place + 1, 0])
        tripped = False
        for k in range(lanes.shape[0]):
            tripped = tripped or w[trip, lanes[k]] != 0.0
        if tripped:
            return i + 1
        if i + 1 < n or not halts:
            begin_tick(tick + 1, dt_ms, table, cut, p, s, w, io, rows, columns, at + i)
    return n


@kernel
def go(
    groups: IntArray,
    n: int,
    halts: bool,
    first_tick: int,
    dt_ms: float,
    table: IntArray,
    cut: int,
    p: FloatArray,
    s: FloatArray,
    w: FloatArray,
    io: IntArray,
    rows: FloatArray,
    columns: IntArray,
    at: int,
    fold: int,
    folds: Words,
    folded: IntArray,
    sizes: IntArray,
    lanes: IntArray,
    trip: int,
    ran: IntArray,
) -> None:
    """Let groups of boards at the same tick end up to ``n`` ticks each; ``ran`` receives how many each has ended.

    The arrays of numbers have one more dimension in front, for the groups; the others are as for `end_ticks`.
    """
    for i in range(groups.shape[0]):
        g = groups[i]
        ran[i] = end_ticks(
            n,
            halts,
            first_tick,
            dt_ms,
            table,
            cut,
            p[g],
            s[g],
            w[g],
            io,
            rows[g],
            columns,
            at,
            fold,
            folds[g],
            folded,
            sizes,
            lanes,
            trip,
        )


@kernel
def begin(
    groups: IntArray,
    tick: int,
    dt_ms: float,
    table: IntArray,
    cut: int,
    p: FloatArray,
    s: FloatArray,
    w: FloatArray,
    io: IntArray,
    rows: FloatArray,
    columns: IntArray,
    at: int,
) -> None:
    """Let groups of boards begin a tick."""
    for i in range(groups.shape[0]):
        g = groups[i]
        begin_tick(tick, dt_ms, table, cut, p[g], s[g], w[g], io, rows[g], columns, at)
