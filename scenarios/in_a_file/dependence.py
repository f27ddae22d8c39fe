"""How the packed numbers of a bench follow a value: found by other values, because packing is any function.

A number that is the same for every value stays. A number that is the value times a constant, to the last bit, moves
freely. Where any other number follows the value, the value has a grid, and the file has the numbers at its points.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from core.block import FloatArray
from core.errors import InputError

PROBES = 8
"""Values at which it is found out which numbers follow, and whether they may be multiples."""
CONFIRMED = 120
"""More values at which multiples are multiples: a product rounded twice differs from it at a seventh of all values."""
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
    probes = {value: pack(value) for value in _probes(low, high, range(1, PROBES + 1))}
    found = np.array([_bits(numbers) != _bits(before) for numbers in probes.values()])
    places = np.flatnonzero(found.any(axis=0))
    scale = _power_of_two(low, high)
    factors = pack(scale)[places] / scale

    def is_multiple(value: float, numbers: FloatArray) -> bool:
        return np.array_equal(_bits(value * factors), _bits(numbers[places]))

    more = _probes(low, high, range(PROBES + 1, PROBES + CONFIRMED + 1))
    known = {exact[0]: before, **probes}
    if all(is_multiple(*one) for one in known.items()) and all(is_multiple(value, pack(value)) for value in more):
        return {"places": places, "factors": factors}
    evenly = (min(max(round(float(one), 12), low), high) for one in np.linspace(low, high, POINTS))
    grid = sorted({*exact, *evenly} - {0.0})
    points = {value: pack(value) for value in grid}
    differ = np.array([_bits(numbers) != _bits(before) for numbers in points.values()])
    places = np.flatnonzero(differ.any(axis=0) | found.any(axis=0))
    return {"places": places, "grid": grid, "numbers": np.array([points[value][places] for value in grid])}


def _probes(low: float, high: float, numbers: Iterable[int]) -> list[float]:
    if not low < high:
        raise InputError(f"no values between {low} and {high}")
    return [low + (high - low) * ((k * GOLDEN) % 1.0) for k in numbers]


def _power_of_two(low: float, high: float) -> float:
    """Return a power of two in the range, by which a number divides without rounding."""
    largest = max(abs(low), abs(high))
    size = 2.0 ** np.floor(np.log2(largest))
    return float(size if high >= size else -size)


def _bits(numbers: FloatArray) -> Any:
    return np.ascontiguousarray(numbers, dtype=np.float64).view(np.int64)
