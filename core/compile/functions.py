"""Functions that steps may call and that are instructions: roots, absolute values, conversions, bits."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir

from core.compile.arrays import Arrays, ArrayView
from core.compile.instructions import address_of, bits_of, call, number_of, whole
from core.compile.numbers import FLOAT, I64, INT, UINT, Arithmetic, CompiledNumber, Unsupported


def _absolute(a: Arithmetic, value: Any) -> Any:
    if not isinstance(value, CompiledNumber):
        return abs(value)
    if value.kind == FLOAT:
        return a.intrinsic("fabs", value)
    return a.select(a.compare("<", value, 0), a.negative(value), value)


def _extreme(sign: str) -> Callable[..., Any]:
    def extreme(a: Arithmetic, first: Any, *others: Any) -> Any:
        for other in others:
            # the first of two that are alike, as in Python
            is_beyond = a.compare(sign, other, first)
            first = (
                a.select(is_beyond, other, first)
                if isinstance(is_beyond, CompiledNumber)
                else (other if is_beyond else first)
            )
        return first

    return extreme


def _as(kind: int, plain: Any) -> Callable[..., Any]:
    def convert(a: Arithmetic, value: Any) -> Any:
        if isinstance(value, CompiledNumber):
            return a.truth(value) if plain is bool else a.as_kind(value, kind)
        return plain(value)

    return convert


def _finite(a: Arithmetic, value: Any) -> Any:
    return a.compare("<", _absolute(a, value), math.inf)


def _floor(a: Arithmetic, value: Any) -> Any:
    return a.as_kind(a.intrinsic("floor", value), INT) if isinstance(value, CompiledNumber) else math.floor(value)


def _bits(a: Arithmetic, value: Any) -> Any:
    number = a.as_kind(value, FLOAT)
    return CompiledNumber(a.builder.bitcast(number.value, a.type_of(INT, is_lanes=number.is_lanes)), INT)


def _from_bits(a: Arithmetic, value: Any) -> Any:
    number = a.as_kind(value, INT)
    return CompiledNumber(a.builder.bitcast(number.value, a.type_of(FLOAT, is_lanes=number.is_lanes)), FLOAT)


def _whole(a: Arithmetic, n: Any) -> Any:
    """Boards side by side fill registers with boards; one alone does so with numbers."""
    return n if a.width > 1 else a.binary(ast.LShift, a.binary(ast.RShift, a.plus(n, 7), 3), 3)


def _single(a: Arithmetic, value: Any) -> Any:
    number, kind = a.as_kind(value, FLOAT), ir.FloatType()
    return CompiledNumber(a.builder.fpext(a.builder.fptrunc(number.value, kind), number.value.type), FLOAT)


def _length(a: Arithmetic, value: Any) -> Any:
    return value.lengths[0] if isinstance(value, ArrayView) else len(value)


def _address(a: Arithmetic, view: Any) -> Any:
    if not isinstance(view, ArrayView):
        raise Unsupported("the address of anything but an array")
    return CompiledNumber(a.builder.ptrtoint(view.base, I64), INT)


def _called(a: Arithmetic, address: Any, *pointers: Any) -> None:
    """Call a step at an address, with pointers that are whole numbers too."""
    pointer = ir.IntType(8).as_pointer()
    kind = ir.FunctionType(ir.VoidType(), [pointer] * len(pointers))
    values = [a.as_kind(one, INT).value for one in (address, *pointers)]
    function = a.builder.inttoptr(values[0], kind.as_pointer())
    a.builder.call(function, [a.builder.inttoptr(one, pointer) for one in values[1:]])


def _scratch(*, zero: bool) -> Callable[..., Any]:
    def scratch(a: Arithmetic, lengths: Any, dtype: Any = np.float64) -> Any:
        return Arrays(a).scratch(lengths, np.dtype(dtype).name, zero)

    return scratch


FUNCTIONS: dict[Any, Callable[..., Any]] = {
    abs: _absolute,
    min: _extreme("<"),
    max: _extreme(">"),
    int: _as(INT, int),
    float: _as(FLOAT, float),
    bool: _as(INT, bool),
    np.int64: _as(INT, np.int64),
    np.uint64: _as(UINT, np.uint64),
    np.float64: _as(FLOAT, np.float64),
    math.sqrt: lambda a, value: a.intrinsic("sqrt", value),
    math.copysign: lambda a, size, sign: a.intrinsic("copysign", size, sign),
    math.isfinite: _finite,
    math.floor: _floor,
    whole: _whole,
    bits_of: _bits,
    number_of: _from_bits,
    np.float32: _single,
    np.empty: _scratch(zero=False),
    np.zeros: _scratch(zero=True),
    len: _length,
    address_of: _address,
    call: _called,
}
