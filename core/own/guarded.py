"""Errors through numbers from data: an index beyond a vector, the whole part of a number too large to have one."""

from __future__ import annotations

import math

from core.kernel import kernel
from core.record import Vector


@kernel
def item(vector: Vector, count: float, index: float) -> float:
    """Return a number of a vector, or NaN where it has none; the guard trips when that reaches the drive."""
    if index > -1.0 and index < count:
        return vector[int(index)]  # type: ignore[no-any-return]
    return math.nan


@kernel
def put(vector: Vector, count: float, index: float, value: float) -> None:
    """Write a number of a vector; nothing where it has none."""
    if index > -1.0 and index < count:
        vector[int(index)] = value


@kernel
def signed(size: float, sign: float) -> float:
    """Return a size with a sign; NaN for a NaN sign, which differs between machines."""
    return math.copysign(size, sign) if sign == sign else math.nan


WHOLE_FROM = 4503599627370496.0
"""2^52: every number from here on is whole."""


@kernel
def floored(value: float) -> float:
    """Return the whole number below a number; a number too large for a fraction, and NaN, as they are."""
    return float(math.floor(value)) if abs(value) < WHOLE_FROM else value
