"""Errors of a shuttle against its model, each in one pass over the samples."""

from __future__ import annotations

import math

from core.block import FloatArray
from core.kernel import kernel


@kernel
def rms(values: FloatArray) -> float:
    """Return the root mean square."""
    total = 0.0
    for i in range(len(values)):
        total += values[i] * values[i]
    return math.sqrt(total / len(values))


@kernel
def swing(values: FloatArray) -> float:
    """Return the largest size; what is not a number counts, so that nothing is taken for settled."""
    largest = 0.0
    for i in range(len(values)):
        size = abs(values[i])
        if not size <= largest:
            largest = size
    return largest


@kernel
def errors(x: FloatArray, model: FloatArray, band: float) -> tuple[float, float, int]:
    """Return the root mean square of the error, its peak, and the samples to the last one outside a band (um)."""
    total, peak, settled = 0.0, 0.0, 0
    for i in range(len(x)):
        error = x[i] - model[i]
        size = abs(error)
        total += error * error
        if not size <= peak:
            peak = size
        if size > band:
            settled = i + 1
    return math.sqrt(total / len(x)), peak, settled


@kernel
def last_step(values: FloatArray) -> int:
    """Return the sample at which a signal takes its last value, 0 if it always had it."""
    for i in range(len(values) - 1, 0, -1):
        if values[i] != values[i - 1]:
            return i
    return 0


@kernel
def first_peaks(x: FloatArray, model: FloatArray) -> tuple[float, float]:
    """Return the first peak of the model and the largest of x until the model turns again; 0 if it does not.

    Both count in the direction in which the model begins to move.
    """
    way, turned, top = 0.0, 0, 0.0
    largest = -math.inf
    for i in range(len(model) - 1):
        slope = model[i + 1] - model[i]
        if way == 0.0 and slope != 0.0:
            way = 1.0 if slope > 0.0 else -1.0
            for k in range(i):
                largest = max(largest, x[k] * way)
        if way != 0.0:
            largest = max(largest, x[i] * way)
        if turned == 0 and slope * way < 0.0:
            turned, top = 1, model[i] * way
        elif turned == 1 and slope * way > 0.0:
            return (top, largest) if top > 0.0 else (0.0, 0.0)
    return 0.0, 0.0
