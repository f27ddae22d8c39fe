"""The bits of a number as an integer and back, and sums and products with what rounding took off."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, cast

from numba import types
from numba.extending import intrinsic, overload

from core.kernel import kernel

_DOUBLE, _INTEGER = struct.Struct("<d"), struct.Struct("<q")

SPLITTER = 134217729.0
"""2^27 + 1: parts a number into halves whose products are exact (Veltkamp 1968)."""


def bits_of(value: float) -> int:
    """Return the 64 bits of a number as a signed integer."""
    bits: int = _INTEGER.unpack(_DOUBLE.pack(value))[0]
    return bits


def number_of(bits: int) -> float:
    """Return the number that has these 64 bits."""
    value: float = _DOUBLE.unpack(_INTEGER.pack(bits))[0]
    return value


def _cast(source: Any, result: Any) -> Callable[[Any], Any]:
    """Return the instruction that reads a value as one of another type."""

    def generate(typing: Any, value: Any) -> Any:
        def read(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return builder.bitcast(arguments[0], context.get_value_type(result))

        return result(source), read

    return cast(Callable[[Any], Any], intrinsic(generate))


_to_bits, _to_number = _cast(types.float64, types.int64), _cast(types.int64, types.float64)


# numba wants the two lambdas of each to name their arguments alike, and to annotate neither
overload(bits_of, inline="always")(lambda value: lambda value: _to_bits(value))
overload(number_of, inline="always")(lambda bits: lambda bits: _to_number(bits))


@kernel
def sum_error(a: float, b: float, total: float) -> float:
    r"""Return what rounding took off a sum: :math:`a+b-\mathrm{fl}(a+b)`, exactly (Knuth, TAOCP 2, 4.2.2)."""
    part = total - a
    return (a - (total - part)) + (b - part)


@kernel
def product_error(a: float, b: float, product: float) -> float:
    r"""Return what rounding took off a product: :math:`ab-\mathrm{fl}(ab)`, exactly (Dekker 1971)."""
    spread = SPLITTER * a
    a_high = spread - (spread - a)
    a_low = a - a_high
    spread = SPLITTER * b
    b_high = spread - (spread - b)
    b_low = b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
