"""Vector code that folds the outputs of a tick of boards abreast: quicker than the same loop as a kernel."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from llvmlite import ir

from core.compile.arrays import counted
from core.compile.code import PLACES, POINTER, begun, helper
from core.compile.machine import WIDTH
from core.compile.numbers import I64


def _whole(value: int) -> Any:
    return ir.Constant(I64, value)


@cache
def folding(factors: tuple[int, int], shifts: tuple[int, int], none: tuple[int, int, int], reserved: int) -> int:
    """Return where the C function is that folds a tick."""
    return helper(folds_of_tick, WIDTH, factors, shifts, none, reserved)


def folds_of_tick(
    width: int, factors: tuple[int, int], shifts: tuple[int, int], none: tuple[int, int, int], reserved: int
) -> ir.Module:
    """Write the function that folds a tick of so many boards.

    It takes four pointers, as steps do: to all signals, the folds, the places of the outputs that count, and how many
    these are and all outputs. The first output comes after the reserved signals; ``core.board.fold`` has the factors,
    shifts and bits.
    """
    module, builder, (signals, folds, places, sizes) = begun([POINTER, POINTER, PLACES, PLACES])
    bits_of_boards = ir.VectorType(I64, width)

    def at(base: Any, number: Any) -> Any:
        place = builder.gep(base, [builder.mul(number, _whole(width))])
        return builder.bitcast(place, bits_of_boards.as_pointer())

    def alike(bits: int) -> Any:
        return ir.Constant(bits_of_boards, [bits] * width)

    count, outputs = (builder.load(builder.gep(sizes, [_whole(number)])) for number in range(2))
    with counted(builder, count) as number:
        place = builder.load(builder.gep(places, [number]))
        sample = builder.load(at(signals, place), align=8)
        infinite, unsigned, no_number = map(alike, none)
        is_none = builder.icmp_unsigned(">", builder.and_(sample, unsigned), infinite)
        sample = builder.select(is_none, no_number, sample)
        first = builder.sub(place, _whole(reserved))
        joins: tuple[Callable[[Any, Any], Any], ...] = (builder.xor, builder.add)
        for word, (join, factor, shift) in enumerate(zip(joins, factors, shifts, strict=True)):
            own = at(folds, builder.add(first, builder.mul(outputs, _whole(word))))
            value = builder.mul(join(builder.load(own, align=8), sample), alike(factor))
            builder.store(builder.xor(value, builder.lshr(value, alike(shift))), own, align=8)
    builder.ret_void()
    return module
