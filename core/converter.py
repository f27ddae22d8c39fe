"""A converter: clips a number to its limit and rounds it to its step."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Self

from pydantic import ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from core.block import BlockParams, parameter
from core.elementary import floor
from core.kernel import kernel
from core.record import Record

BITS: Any = parameter(
    0, "bits of the converter in place of its step, which is its range over 2 to this power; 0 for none", ge=0, le=48
)
"""The other spelling of the step of a converter."""


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


class ConverterParams(BlockParams):
    """Parameters with a converter, whose step is given in units of its own or in ``bits``; never in both."""

    spelt: ClassVar[tuple[str, str]]
    """Names of its step and of its limit to either side."""

    @model_validator(mode="after")
    def _one_step(self) -> Self:
        quantum, _ = self.spelt
        if vars(self)["bits"] and vars(self)[quantum]:
            twice = PydanticCustomError("twice", f"gives the step of the converter, and {quantum} does too")
            details = InitErrorDetails(type=twice, loc=("bits",), input=vars(self)["bits"])
            raise ValidationError.from_exception_data(type(self).__name__, [details])
        return self

    @property
    def step(self) -> float:
        """Step of the converter, 0 for none: as it is given, or the range over a power of 2."""
        quantum, bits, limit = (vars(self)[name] for name in (self.spelt[0], "bits", self.spelt[1]))
        return math.ldexp(2.0 * limit, -bits) if bits else float(quantum)

    @property
    def reach(self) -> float:
        """The largest number that the converter puts out."""
        return reach(vars(self)[self.spelt[1]], self.step)
