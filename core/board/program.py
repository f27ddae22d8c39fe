"""The compiled tick loop: a table of block addresses, offsets and ports.

Wiring is data, so a block is swapped, added or re-wired without compiling the loop again, and the dispatch costs
about as much as inlining. The same steps run uncompiled are the oracle of the compiled ones, bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from core.block import Block, FloatArray, IntArray
from core.board.fold import Words, fold
from core.compile import code
from core.compile.instructions import address_of, call
from core.kernel import kernel
from core.own.apart import compiled_apart
from core.plain import rebound
from core.ports import RESERVED, TICK, TIME_MS
from core.wall import wall

ADDRESS, P_OFFSET, S_OFFSET, IO_OFFSET, EVERY = 0, 1, 2, 3, 4
COLUMNS = 5
"""Columns of the table, one row per block."""

DONE, TRIPPED, WATCHED = 0, 1, 2
"""Why the loop returned."""


def address(block: type[Block], width: int = 1) -> int:
    """Return where the C function of a step is, for so many boards; it is compiled when it is asked for first."""
    if block.text and wall.is_demanded():
        raise RuntimeError(f"{block.name} runs behind the wall alone")
    return code.address(compiled_apart(block), width)


@kernel
def walk(table: IntArray, tick: int, width: int, p: Any, s: Any, w: Any, io: Any) -> None:
    """Call the steps whose turn is at a tick, of boards whose numbers are side by side; arrays are addresses."""
    for b in range(table.shape[0]):
        every = table[b, EVERY]
        # a division costs more than most blocks, and most run at every tick
        if every == 1 or tick % every == 0:
            call(
                int(table[b, ADDRESS]),
                p + 8 * width * table[b, P_OFFSET],
                s + 8 * width * table[b, S_OFFSET],
                w,
                io + 8 * table[b, IO_OFFSET],
            )


@kernel
def begin(table: IntArray, tick: int, dt_ms: float, p: FloatArray, s: FloatArray, w: FloatArray, io: IntArray) -> None:
    """Run the first steps of a tick; ``run`` continues with the rest of the table."""
    w[TICK] = tick
    w[TIME_MS] = tick * dt_ms
    walk(table, tick, 1, address_of(p), address_of(s), address_of(w), address_of(io))


@kernel
def run(
    n: int,
    first_tick: int,
    dt_ms: float,
    table: IntArray,
    p: FloatArray,
    s: FloatArray,
    w: FloatArray,
    io: IntArray,
    outputs: FloatArray,
    taps: FloatArray,
    folds: Words,
    trip: int,
    watches: FloatArray,
) -> tuple[int, int]:
    """Run up to ``n`` ticks; return how many were run and why it stopped.

    Of the signals those reserved come first, then the outputs, then the taps. Every tick is folded into ``folds``.
    A watch is a row (signal, +1 above or -1 below, threshold).
    """
    first_tap = RESERVED + outputs.shape[1]
    bits = w.view(np.uint64)[RESERVED:]
    arrays = address_of(p), address_of(s), address_of(w), address_of(io)
    for i in range(n):
        tick = first_tick + i
        w[TICK] = tick
        w[TIME_MS] = tick * dt_ms
        walk(table, tick, 1, arrays[0], arrays[1], arrays[2], arrays[3])
        for c in range(outputs.shape[1]):
            outputs[i, c] = w[RESERVED + c]
        for c in range(taps.shape[1]):
            taps[i, c] = w[first_tap + c]
        fold(folds, bits)
        if w[trip] != 0.0:
            return i + 1, TRIPPED
        for c in range(watches.shape[0]):
            if watches[c, 1] * (w[int(watches[c, 0])] - watches[c, 2]) > 0.0:
                return i + 1, WATCHED
    return n, DONE


@np.errstate(all="ignore")  # numbers overflow as quietly as in compiled code
def run_uncompiled(steps: list[Callable[[], None]], *arguments: Any) -> tuple[int, int]:
    """Run the same loop in plain Python: the oracle, and a way out where nothing can be compiled.

    ``steps`` are the steps of the rows of the table, bound to their arrays.
    """

    def walked(table: IntArray, tick: int, *_: int) -> None:
        for step, row in zip(steps, table, strict=True):
            if tick % row[EVERY] == 0:
                step()

    loop = rebound(run, lambda value: walked if value is getattr(walk, "py_func", walk) else value)
    ran: tuple[int, int] = loop(*arguments)
    return ran
