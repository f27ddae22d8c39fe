"""Axes of charts: round ticks and the unit their numbers are in, chosen as the page chooses them.

``web/src/testing/cases/axis.json`` holds both to the same ticks, units and labels.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from core.format import UnitScale, format_short, labels_on, round_to, unit_scale, unit_text

LEAST_TICKS, MOST_TICKS = 2, 12


def linear_ticks(low: float, high: float, count: float) -> list[float]:
    """Return round values across a range, about ``count`` of them: steps of 1, 2 or 5 times a power of ten."""
    raw = (high - low) / max(1.0, count)
    if not raw > 0.0:
        return []
    power = 10.0 ** math.floor(math.log10(raw))
    step = next((m for m in (1.0, 2.0, 5.0, 10.0) if m * power >= raw * 0.999), 10.0) * power
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [round_to(number * step, 12) for number in range(first, last + 1)]


def decade_ticks(low: float, high: float) -> list[float]:
    """Return 1, 2 and 5 of every decade within a range."""
    powers = range(math.floor(math.log10(low)), math.floor(math.log10(high)) + 1)
    ticks = [round_to(m * 10.0**power, 3) for power in powers for m in (1, 2, 5)]
    return [tick for tick in ticks if low * 0.9999 <= tick <= high * 1.0001]


def time_scale(span_ms: float) -> UnitScale:
    """Return the unit in which a span of device time reads well: us, ms or s."""
    factor, unit = (1e3, "µs") if span_ms < 0.5 else (1.0, "ms") if span_ms < 2000.0 else (1e-3, "s")
    return UnitScale(factor, unit, 0)


@dataclass(frozen=True)
class Axis:
    """Quantity of an axis and unit of its values; its range follows from the values unless it is given."""

    title: str
    unit: str = ""
    span: tuple[float, float] | None = None
    is_log: bool = False


class Scale:
    """An axis over its range: the place of a value, its ticks, its title with their unit.

    Parameters
    ----------
    axis : Axis
        Its quantity.
    values : sequence of float
        The values it must show where the axis has no range of its own.
    """

    def __init__(self, axis: Axis, values: Sequence[float]) -> None:
        self._axis = axis
        self.low, self.high = axis.span or (_decades(values) if axis.is_log else _room(values))
        size = max(abs(self.low), abs(self.high))
        is_time = axis.unit == "ms" and not axis.is_log
        self._unit = time_scale(self.high - self.low) if is_time else unit_scale(axis.unit, size)
        unit = self._unit.unit or unit_text(axis.unit)
        self.title = f"{axis.title}, {unit}" if unit and axis.title else unit or axis.title

    def place(self, value: float) -> float:
        """Return the place of a value, from 0 to 1 of the axis."""
        if self._axis.is_log:
            return math.log(max(value, 1e-300) / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def ticks(self, count: float) -> list[tuple[float, str]]:
        """Return about this number of ticks, two at least, each with its label."""
        factor = self._unit.factor
        found = decade_ticks(self.low * factor, self.high * factor) if self._axis.is_log else []
        if len(found) > 1:
            if len(found) > max(3.0, count):  # too many for 2 and 5: the powers of ten, then every other of them
                found = [tick for tick in found if abs(math.log10(tick) - round(math.log10(tick))) < 1e-6]
                found = found[:: 1 + int(len(found) // max(2.0, count + 1.0))]
            return [(tick / factor, format_short(tick, "") + self._unit.exponent) for tick in found]
        shown = list[float]()
        while len(shown) < LEAST_TICKS and count < MOST_TICKS:  # a short range may have none at so coarse a step
            shown = [tick / factor for tick in linear_ticks(self.low * factor, self.high * factor, count)]
            count += 1.0
        return list(zip(shown, labels_on(self._unit, shown), strict=True))


def _room(values: Sequence[float]) -> tuple[float, float]:
    """Return a range with some air around the values."""
    finite = [value for value in values if math.isfinite(value)] or [0.0, 1.0]
    low, high = min(finite), max(finite)
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        air = 0.5 * abs(high) or 0.5
        return low - air, high + air
    return low - 0.04 * (high - low), high + 0.04 * (high - low)


def _decades(values: Sequence[float]) -> tuple[float, float]:
    """Return a logarithmic range with some air around the positive values."""
    positive = [value for value in values if math.isfinite(value) and value > 0.0] or [1.0, 10.0]
    low, high = min(positive), max(positive)
    return (low / 1.1, high * 1.1) if high < 100.0 * low else (low / 1.3, high * 1.3)
