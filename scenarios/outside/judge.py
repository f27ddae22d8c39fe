"""The end of a step of an environment in numbers: observations and rewards, from the signals kept at its ticks."""

from __future__ import annotations

from core.block import FloatArray, IntArray
from core.elementary import exp
from core.kernel import kernel

KEPT = ("reference.voltage", "model.displacement", "sensor.displacement", "drive.voltage", "plant.displacement")
"""Signals that a step is judged by, in the order in which the kernels read them."""
OBSERVED = ("reference", "model", "measured", "error", "applied")
"""Numbers of an observation; the error is the model minus the measurement."""


@kernel
def bounded(value: float, most: float) -> float:
    """Return a value within both ends; not a number is 0."""
    return 0.0 if value != value else min(max(value, -most), most)


@kernel
def observe(
    rows: FloatArray, places: IntArray, counts: IntArray, scales: FloatArray, high: FloatArray, seen: FloatArray
) -> None:
    """Write the observations at the last ticks of boards; a board without a tick keeps its observation.

    Parameters
    ----------
    rows : ndarray, shape (groups, ticks, signals, boards of a group)
        The signals `KEPT` at each tick, then others.
    places, counts : ndarray, shape (boards,)
        The boards, and the ticks of each.
    scales, high : ndarray, shape (observed,)
        Factors from units to shares, and the ends of the space.
    seen : ndarray, shape (boards, observed)
        Receives the observations.
    """
    width = rows.shape[3]
    for k in range(places.shape[0]):
        if counts[k] > 0:
            own, c = rows[places[k] // width], places[k] % width
            i = counts[k] - 1
            model, measured = own[i, 1, c], own[i, 2, c]
            seen[k, 0] = bounded(own[i, 0, c] * scales[0], high[0])
            seen[k, 1] = bounded(model * scales[1], high[1])
            seen[k, 2] = bounded(measured * scales[2], high[2])
            seen[k, 3] = bounded((model - measured) * scales[3], high[3])
            seen[k, 4] = bounded(own[i, 3, c] * scales[4], high[4])


@kernel
def reward(
    rows: FloatArray,
    places: IntArray,
    counts: IntArray,
    before: FloatArray,
    error_um: float,
    effort: float,
    change: float,
    limit_v: float,
    rewards: FloatArray,
) -> None:
    """Write the rewards of a step.

    Parameters
    ----------
    rows, places, counts : ndarray
        As for `observe`.
    before : ndarray, shape (boards,)
        The voltage applied before, replaced by the last voltage.
    error_um, effort, change, limit_v : float
        The weights, see `scenarios.outside.rewards.Reward`, and the limit of the drive.
    rewards : ndarray, shape (boards,)
        Receives the rewards.
    """
    width = rows.shape[3]
    for k in range(places.shape[0]):
        own, c = rows[places[k] // width], places[k] % width
        total, last = 0.0, before[k]
        for i in range(counts[k]):
            error, voltage = (own[i, 1, c] - own[i, 4, c]) / error_um, own[i, 3, c]
            used, moved = voltage / limit_v, (voltage - last) / limit_v
            total += exp(-(error * error + effort * used * used + change * moved * moved))
            last = voltage
        before[k] = last
        rewards[k] = total / rows.shape[1]
