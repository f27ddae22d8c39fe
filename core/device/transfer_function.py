r"""A plant that is not a resonator: the examples of chapter 4 and appendix B."""

from __future__ import annotations

import math
from typing import Self

from pydantic import Field, model_validator

from core.block import BlockParams, Oscillator, parameter
from core.device.ranges import Sized


class TransferFunction(BlockParams):
    r"""A plant :math:`\frac{b_0}{a_2s^2+a_1s+a_0}` in its own unit of time; a volt in, a micrometre out."""

    gain: Sized = parameter(1.0, "numerator b0", live=False)
    denominator: list[Sized] = Field(
        min_length=2,
        max_length=3,
        description="coefficients of the denominator, highest power first",
        json_schema_extra={"unit": "", "live": False, "equation": "4.3.1.1"},
    )
    time_unit_ms: float = parameter(1000.0, "unit of time", "ms", ge=1e-6, le=1e6, live=False)

    @model_validator(mode="after")
    def _leads(self) -> Self:
        if self.denominator[0] <= 0.0:
            raise ValueError("the first coefficient of the denominator must be > 0")
        return self

    def oscillator(self) -> Oscillator:
        """Return the plant in the units of the loop, with its coefficients as mass, damping and stiffness."""
        return of_coefficients(self.gain, self.denominator, self.time_unit_ms)

    def metrics(self) -> dict[str, float]:
        """Return the figures that make sense without units; the motion of a pole to the right of 0 grows."""
        plant = self.oscillator()
        quoted = {"slowest_pole_per_s": 1e3 * slowest_pole(plant)}
        if plant.stiffness != 0.0:
            quoted["static_gain_um_per_v"] = plant.static_gain
        if plant.mass > 0.0 and plant.stiffness > 0.0:
            quoted["f0_hz"] = 1e3 * math.sqrt(plant.stiffness / plant.mass) / (2.0 * math.pi)
        return quoted


def of_coefficients(gain: float, denominator: list[float], unit_ms: float) -> Oscillator:
    """Return a transfer function in the units of the loop, given in its own unit of time."""
    second, first, last = [0.0] * (3 - len(denominator)) + denominator
    return Oscillator(second * unit_ms * unit_ms, first * unit_ms, last, gain, unit_ms)


def slowest_pole(plant: Oscillator) -> float:
    """Return the largest real part of the poles, rad/ms."""
    if plant.mass == 0.0:
        return -plant.stiffness / plant.damping
    half, square = 0.5 * plant.damping / plant.mass, plant.stiffness / plant.mass
    root = math.sqrt(max(0.0, half * half - square))
    # with two real poles far apart, the difference would lose the slow one
    return -square / (half + root) if half > 0.0 and root > 0.0 else root - half
