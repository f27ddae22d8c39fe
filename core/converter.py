"""A converter: clips a number to its limit and rounds it to its step."""

from __future__ import annotations

import math
from typing import Any

from core.block import BlockParams, parameter
from core.elementary import floor
from core.kernel import kernel
from core.record import Record

BITS: Any = parameter(0, "bits of the converter in place of its step: range over 2 to the bits", ge=0, le=48)
"""The other spelling of the step of a converter, 0 for none."""


class Converter(Record):
    """The largest number it puts out to either side, its step, 0 for none; volts, or uN for the force along an axis."""

    limit: float
    quantum: float


@kernel
def convert(p: Converter, u: float) -> float:
    """Clip to the limit and round to the converter's step; a value that is not a number gives 0."""
    if not math.isfinite(u):
        return 0.0
    u = min(max(u, -p.limit), p.limit)
    if p.quantum > 0.0:
        u = p.quantum * floor(u / p.quantum + 0.5)
    return u


def reach(limit: float, quantum: float) -> float:
    """Return the largest number within a limit that a converter has: a whole multiple of its step."""
    if quantum == 0.0:
        return limit
    steps = limit / quantum
    is_whole = abs(steps - round(steps)) <= 1e-9 * steps  # a tenth is no binary number
    return limit if is_whole else quantum * math.floor(steps)


def step_of(quantum: float, bits: int, limit: float) -> float:
    """Return the step of a converter, 0 for none: as it is given, or its range to both sides over 2 to so many bits."""
    return math.ldexp(2.0 * limit, -bits) if bits > 0 else quantum


def twice_given(params: BlockParams) -> str:
    """Name the step of a converter that ``bits`` give as well; nothing where one of them or none is given."""
    given = [name for name, value in params if name.startswith("quantum_") and value]
    return given[0] if given and vars(params).get("bits") else ""
