"""Errors of a shuttle against its model, each in one pass over the samples."""

from __future__ import annotations

import math

import numpy as np

from core.block import FloatArray
from core.kernel import kernel
from scenarios.measure.blocks import BLOCK, blocks, loaded


def rms(values: FloatArray) -> float:
    """Return the root mean square."""
    total = 0.0
    for (block,) in blocks(values):
        total = _squares(block, total)
    return math.sqrt(total / len(values))


@kernel
def _squares(values: FloatArray, total: float) -> float:
    for i in range(len(values)):
        total += values[i] * values[i]
    return total


def swing(values: FloatArray) -> float:
    """Return the largest size; a value that is not a number counts, so that it never looks settled."""
    found = 0.0
    for (block,) in blocks(values):
        found = _swing(block, found)
    return found


@kernel
def _swing(values: FloatArray, largest: float) -> float:
    for i in range(len(values)):
        size = abs(values[i])
        if not size <= largest:
            largest = size
    return largest


def errors(x: FloatArray, model: FloatArray, band: float) -> tuple[float, float, int]:
    """Return the root mean square of the error, its peak, and the samples to the last one outside a band (um)."""
    total, peak, settled = 0.0, 0.0, 0
    for number, (moved, wanted) in enumerate(blocks(x, model)):
        total, peak, outside = _errors(moved, wanted, band, total, peak)
        settled = number * BLOCK + outside if outside else settled
    return math.sqrt(total / len(x)), peak, settled


@kernel
def _errors(x: FloatArray, model: FloatArray, band: float, total: float, peak: float) -> tuple[float, float, int]:
    settled = 0
    for i in range(len(x)):
        error = x[i] - model[i]
        size = abs(error)
        total += error * error
        if not size <= peak:
            peak = size
        if size > band:
            settled = i + 1
    return total, peak, settled


def tracked(
    x: FloatArray, model: FloatArray, u: FloatArray, start: int, tail: int, share: float
) -> tuple[float, float, int, float, float]:
    """Return the `errors` from a sample on, their root mean square in the tail, and the root mean square of u there.

    The band is a share of the swing of the model in the tail, which begins at sample ``tail``.
    """
    if len(x) > BLOCK:
        band = share * swing(model[tail:])
        whole = errors(x[start:], model[start:], band)
        return *whole, errors(x[tail:], model[tail:], band)[0], rms(u[tail:])
    total, peak, settled, last, effort = _tracked(loaded(x), loaded(model), loaded(u), start, tail, share)
    count = len(x) - tail
    return math.sqrt(total / (len(x) - start)), peak, settled, math.sqrt(last / count), math.sqrt(effort / count)


@kernel
def _tracked(
    x: FloatArray, model: FloatArray, u: FloatArray, start: int, tail: int, share: float
) -> tuple[float, float, int, float, float]:
    largest, last, effort = 0.0, 0.0, 0.0
    for i in range(tail, len(x)):
        size = abs(model[i])
        if not size <= largest:
            largest = size
        error = x[i] - model[i]
        last += error * error
        effort += u[i] * u[i]
    band = share * largest
    total, peak, settled = 0.0, 0.0, 0
    for i in range(start, len(x)):
        error = x[i] - model[i]
        size = abs(error)
        total += error * error
        if not size <= peak:
            peak = size
        if size > band:
            settled = i - start + 1
    return total, peak, settled, last, effort


def last_step(values: FloatArray) -> int:
    """Return the sample at which a signal takes its last value, 0 if it always had it."""
    for end in range(len(values), 1, -BLOCK):
        first = max(end - BLOCK - 1, 0)
        if step := _last_step(loaded(values[first:end])):
            return first + step
    return 0


@kernel
def _last_step(values: FloatArray) -> int:
    for i in range(len(values) - 1, 0, -1):
        if values[i] != values[i - 1]:
            return i
    return 0


def first_peaks(x: FloatArray, model: FloatArray) -> tuple[float, float]:
    """Return the first peak of the model and the largest of x until the model turns again; 0 if it does not.

    Both count in the direction in which the model begins to move.
    """
    found = np.array([0.0, 0.0, 0.0, -math.inf, -math.inf])
    for moved, wanted in blocks(x, model, more=1):
        if _first_peaks(moved, wanted, found):
            way, _, top, *largest = found.tolist()
            return (top, largest[0 if way > 0.0 else 1]) if top > 0.0 else (0.0, 0.0)
    return 0.0, 0.0


@kernel
def _first_peaks(x: FloatArray, model: FloatArray, found: FloatArray) -> bool:
    """Go on looking; return whether the model has turned twice.

    The result has the direction, whether the model turned, its peak, and the largest of x in either direction.
    """
    for i in range(len(model) - 1):
        slope = model[i + 1] - model[i]
        if found[0] == 0.0 and slope != 0.0:
            found[0] = 1.0 if slope > 0.0 else -1.0
        found[3] = max(found[3], x[i])
        found[4] = max(found[4], -x[i])
        if found[1] == 0.0 and slope * found[0] < 0.0:
            found[1], found[2] = 1.0, model[i] * found[0]
        elif found[1] == 1.0 and slope * found[0] > 0.0:
            return True
    return False
