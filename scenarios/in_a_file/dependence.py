"""How the packed numbers of a bench follow a value: found by other values, because packing is any function.

A number that is the same for every value stays. A number that is the value times a constant, to the last bit, moves
freely. Where any other number follows the value, the value has a grid, and the file has the numbers at its points.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from core.block import FloatArray
from core.errors import InputError

PROBES, MORE_PROBES = 8, 64
"""Values at which it is found out whether all numbers are constants or multiples: a few, then many, because a number
that is rounded twice is equal to a multiple at half of all values."""
POINTS = 21
"""Of a grid."""
GOLDEN = 0.6180339887498949
"""Its multiples spread evenly, without any two alike."""


def dependence(pack: Callable[[float], FloatArray], low: float, high: float, exact: Sequence[float]) -> dict[str, Any]:
    """Return how numbers follow a value.

    Parameters
    ----------
    pack : callable
        Returns the numbers for a value.
    low, high : float
        The range in which people choose values.
    exact : sequence of float
        Values that must be among the points of a grid; the numbers of before are for the first.

    Returns
    -------
    dict
        ``places`` that follow the value; ``factors`` of them where all are multiples; else the ``grid``, ascending, and
        the ``numbers`` at its points.

    Raises
    ------
    InputError
        When the range has not two values at which the numbers can be packed.
    """
    before = pack(exact[0])
    probes = {value: pack(value) for value in _probes(low, high, 0, PROBES)}
    found = np.array([_bits(numbers) != _bits(before) for numbers in probes.values()])
    places = np.flatnonzero(found.any(axis=0))
    scale = _power_of_two(low, high)
    factors = pack(scale)[places] / scale

    def is_multiple(value: float, numbers: FloatArray) -> bool:
        return np.array_equal(_bits(value * factors), _bits(numbers[places]))

    if all(is_multiple(value, numbers) for value, numbers in ({exact[0]: before} | probes).items()) and all(
        is_multiple(value, pack(value)) for value in _probes(low, high, PROBES, MORE_PROBES)
    ):
        return {"places": places, "factors": factors}
    rounded = (min(max(round(float(one), 12), low), high) for one in np.linspace(low, high, POINTS))
    grid = sorted({*exact, *rounded} - {0.0})
    points = {value: pack(value) for value in grid}
    differ = np.array([_bits(numbers) != _bits(before) for numbers in points.values()])
    places = np.flatnonzero(differ.any(axis=0) | found.any(axis=0))
    return {"places": places, "grid": grid, "numbers": np.array([points[value][places] for value in grid])}


def _probes(low: float, high: float, first: int, end: int) -> list[float]:
    if not low < high:
        raise InputError(f"no values between {low} and {high}")
    return [low + (high - low) * ((k * GOLDEN) % 1.0) for k in range(first + 1, end + 1)]


def _power_of_two(low: float, high: float) -> float:
    """Return a power of two in the range, by which a number divides without rounding."""
    largest = max(abs(low), abs(high))
    size = 2.0 ** np.floor(np.log2(largest))
    return float(size if high >= size else -size)


def _bits(numbers: FloatArray) -> Any:
    return np.ascontiguousarray(numbers, dtype=np.float64).view(np.int64)
