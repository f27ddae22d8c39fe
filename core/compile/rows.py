"""Vector code for the loop of boards abreast: it folds outputs, keeps signals, and sorts them by board.

Each is a C function of four pointers, as steps are; the last is to whole numbers that say how many.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from llvmlite import ir

from core.compile.arrays import counted
from core.compile.code import PLACES, POINTER, begun
from core.compile.machine import WIDTH, compiled, loaded
from core.compile.numbers import DOUBLE, I64

LANES, BITS = ir.VectorType(DOUBLE, WIDTH), ir.VectorType(I64, WIDTH)


def _whole(value: int) -> Any:
    return ir.Constant(I64, value)


class _Writer:
    """Writes one function."""

    def __init__(self) -> None:
        self.module, self.builder, arguments = begun([POINTER, POINTER, PLACES, PLACES])
        self.first, self.second, self.places, self.sizes = arguments

    def size(self, number: int) -> Any:
        return self.whole(self.sizes, _whole(number))

    def whole(self, base: Any, at: Any) -> Any:
        return self.builder.load(self.builder.gep(base, [at]))

    def read(self, base: Any, at: Any, kind: Any = LANES) -> Any:
        return self.builder.load(self._vector(base, at, kind), align=8)

    def write(self, value: Any, base: Any, at: Any) -> None:
        self.builder.store(value, self._vector(base, at, value.type), align=8)

    def _vector(self, base: Any, at: Any, kind: Any) -> Any:
        return self.builder.bitcast(self.builder.gep(base, [at]), kind.as_pointer())

    def times(self, value: Any, factor: Any) -> Any:
        return self.builder.mul(value, factor if not isinstance(factor, int) else _whole(factor))

    def address(self) -> int:
        self.builder.ret_void()
        return loaded(compiled(str(self.module)))


@cache
def folding(factors: tuple[int, int], shifts: tuple[int, int], none: tuple[int, int, int], reserved: int) -> int:
    """Return where the function is that folds a tick.

    It takes all signals, the folds, the places of the outputs that count, and how many these are and all outputs. The
    first output stands behind those reserved; ``core.board.fold`` has the factors, shifts and bits.
    """
    w = _Writer()
    count, outputs = w.size(0), w.size(1)
    with counted(w.builder, count) as number:
        place = w.whole(w.places, number)
        sample = w.read(w.first, w.times(place, WIDTH), BITS)
        infinite, unsigned, no_number = (ir.Constant(BITS, [bits] * WIDTH) for bits in none)
        is_none = w.builder.icmp_unsigned(">", w.builder.and_(sample, unsigned), infinite)
        sample = w.builder.select(is_none, no_number, sample)
        at = w.times(w.builder.sub(place, _whole(reserved)), WIDTH)
        joins: tuple[Callable[[Any, Any], Any], ...] = (w.builder.xor, w.builder.add)
        for word, (join, factor, shift) in enumerate(zip(joins, factors, shifts, strict=True)):
            own = w.builder.add(at, w.times(w.times(outputs, WIDTH), word))
            value = w.builder.mul(join(w.read(w.second, own, BITS), sample), ir.Constant(BITS, [factor] * WIDTH))
            w.write(w.builder.xor(value, w.builder.lshr(value, ir.Constant(BITS, [shift] * WIDTH))), w.second, own)
    return w.address()


@cache
def keeping() -> int:
    """Return where the function is that copies signals: all, where to, the places of those to keep, and how many."""
    w = _Writer()
    with counted(w.builder, w.size(0)) as number:
        signal = w.read(w.first, w.times(w.whole(w.places, number), WIDTH))
        w.write(signal, w.second, w.times(number, WIDTH))
    return w.address()


@cache
def sorting() -> int:
    """Return where the function is that sorts rows by signal and board.

    It takes rows of ticks (each of signals, each of boards), the trace (of signals, boards, ticks), nothing, and four
    numbers: signals, ticks of the rows, a multiple of ``WIDTH``, ticks of the trace, and the first of them to write.
    """
    w = _Writer()
    signals, ticks, length, first = (w.size(number) for number in range(4))
    with counted(w.builder, signals) as signal, counted(w.builder, ticks, WIDTH) as tick:
        rows = []
        for i in range(WIDTH):
            row = w.builder.add(w.times(w.builder.add(tick, _whole(i)), signals), signal)
            rows.append(w.read(w.first, w.times(row, WIDTH)))
        for lane, ordered in enumerate(_transposed(w.builder, rows)):
            board = w.builder.add(w.times(signal, WIDTH), _whole(lane))
            w.write(ordered, w.second, w.builder.add(w.builder.add(w.times(board, length), first), tick))
    return w.address()


def _transposed(builder: ir.IRBuilder, rows: list[Any]) -> list[Any]:
    """Return the columns of a square of numbers: blocks of 1, 2, 4 and so on change places."""
    rows = list(rows)
    for size in (1 << power for power in range(WIDTH.bit_length() - 1)):
        kept = [k if not k & size else WIDTH + k - size for k in range(WIDTH)]
        moved = [k + size if not k & size else WIDTH + k for k in range(WIDTH)]
        for i in (i for i in range(WIDTH) if not i & size):
            pair = rows[i], rows[i | size]
            rows[i], rows[i | size] = (
                builder.shuffle_vector(*pair, ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), places))
                for places in (kept, moved)
            )
    return rows
