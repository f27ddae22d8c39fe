"""Vector code that keeps signals of boards abreast or sums of them, and sorts them by board."""

from __future__ import annotations

from functools import cache
from typing import Any

from llvmlite import ir

from core.compile.arrays import counted
from core.compile.code import PLACES, POINTER, begun, helper
from core.compile.machine import WIDTH
from core.compile.numbers import DOUBLE, I64

SLICE = 64
"""Ticks that are sorted together: a board's numbers of a signal then fill several lines of the cache in a row."""
EDGE = 8
"""Rows and columns of a square that is turned in registers."""
HALF = EDGE // 2
LOW, HIGH = ([first + i + side for i in range(HALF) for side in (0, EDGE)] for first in (0, HALF))
"""Numbers of two vectors in turn: of their lower halves, and of their upper halves."""
LINE = ir.VectorType(DOUBLE, EDGE)
LINE_BYTES = 8 * EDGE
"""A line of the cache; traces begin at one, and the columns of each board too."""


@cache
def keeping() -> int:
    """Return where the C function is that keeps signals of a tick."""
    return helper(keeps, WIDTH)


@cache
def sorting() -> int:
    """Return where the C function is that sorts by board the signals kept in a slice."""
    return helper(sorts, WIDTH)


def keeps(width: int) -> ir.Module:
    """Write the function that keeps signals of a tick of so many boards, or sums of signals.

    It takes four pointers, as steps do: to all signals, to the room for the kept ones, to the places of the signals,
    and to the number of kept ones, followed by where the places of each begin and end.
    """
    module, builder, (signals, room, places, sizes) = begun([POINTER, POINTER, PLACES, PLACES])
    boards = ir.VectorType(DOUBLE, width)

    def signal(at: Any) -> Any:
        source = _at(builder, signals, boards, (builder.load(builder.gep(places, [at])), width))
        return builder.load(source, align=8)

    total = builder.alloca(boards)
    with counted(builder, builder.load(sizes)) as number:
        start, end = (builder.load(_at(builder, sizes, I64, (number, 1), (more, 1))) for more in (1, 2))
        builder.store(signal(start), total)
        others = builder.sub(builder.sub(end, start), ir.Constant(I64, 1))
        with counted(builder, others) as other:
            added = signal(builder.add(builder.add(start, other), ir.Constant(I64, 1)))
            builder.store(builder.fadd(builder.load(total), added), total)
        builder.store(builder.load(total), _at(builder, room, boards, (number, width)), align=8)
    builder.ret_void()
    return module


def sorts(width: int) -> ir.Module:
    """Write the function that sorts by board, of so many boards, the signals kept in a slice.

    It takes four pointers: to the kept signals, shape (``SLICE``, kept, ``width``); to the first tick of the slice in a
    trace of shape (kept, ``width``, ticks); to nothing; and to the numbers of signals and ticks of the trace. The ticks
    are a multiple of ``EDGE``. The trace of a long run would fill the cache, so its lines go past it.
    """
    module, builder, (rows, trace, _, sizes) = begun([POINTER, POINTER, PLACES, PLACES])
    kept, ticks = (builder.load(builder.gep(sizes, [ir.Constant(I64, number)])) for number in range(2))
    across = builder.mul(kept, ir.Constant(I64, width))
    past_cache = module.add_metadata([ir.Constant(ir.IntType(32), 1)])
    orders = [ir.Constant(ir.VectorType(ir.IntType(32), EDGE), order) for order in (LOW, HIGH)]
    with counted(builder, kept) as column, counted(builder, ir.Constant(I64, SLICE), EDGE) as tick:
        for board in range(0, width, EDGE):
            corner = _at(builder, rows, DOUBLE, (tick, across), (column, width), (board, 1))
            lines = [builder.load(_at(builder, corner, LINE, (i, across)), align=8) for i in range(EDGE)]
            for _ in range(EDGE.bit_length() - 1):
                pairs = zip(lines[:HALF], lines[HALF:], strict=True)
                lines = [builder.shuffle_vector(*pair, order) for pair in pairs for order in orders]
            corner = _at(builder, trace, DOUBLE, (column, builder.mul(ticks, ir.Constant(I64, width))), (tick, 1))
            for i, line in enumerate(lines):
                stored = builder.store(line, _at(builder, corner, LINE, (board + i, ticks)), align=LINE_BYTES)
                stored.set_metadata("nontemporal", past_cache)
    builder.ret_void()
    return module


def _at(builder: ir.IRBuilder, base: Any, kind: Any, *steps: tuple[Any, Any]) -> Any:
    """Return a pointer that is some steps of some sizes behind another."""
    for step in steps:
        number, size = (ir.Constant(I64, one) if isinstance(one, int) else one for one in step)
        base = builder.gep(base, [builder.mul(number, size)])
    return builder.bitcast(base, kind.as_pointer())
