"""Models side by side: each number of a bank's models has a lane, so that a processor computes several models at once.

A lane is as long as the longest list of hypotheses. The compiler can put neighbours into one vector register because it
knows the length of a lane and because the arrays of a step do not overlap. The arithmetic of each element is unchanged,
and so are the bits.
"""

from __future__ import annotations

from core.record import Choice, Record, Vector, vector

LANE = 16
"""Length of a lane: the largest number of hypotheses of a bank."""


class PackedFilters(Record):
    """Number of models and the numbers they share; the lanes of the models, over the bank's interval and over one tick.

    The models share the variance of a measurement, the form of the filter, the ticks of an interval, the voltage
    assumed over a tick, the share that the mean square of the drive keeps from sample to sample, and its lower limit. A
    device over one tick is as in `core.voltage`.
    """

    count: Choice
    sensor: float
    steady: Choice
    printed: Choice
    every: Choice
    taken: float
    memory: float
    least_drive: float
    phi11: Vector = vector(LANE)
    phi12: Vector = vector(LANE)
    phi21: Vector = vector(LANE)
    phi22: Vector = vector(LANE)
    noise11: Vector = vector(LANE)
    noise12: Vector = vector(LANE)
    noise22: Vector = vector(LANE)
    gain1: Vector = vector(LANE)
    gain2: Vector = vector(LANE)
    psi: Vector = vector(LANE)
    inverse_psi: Vector = vector(LANE)
    steady11: Vector = vector(LANE)
    steady12: Vector = vector(LANE)
    steady22: Vector = vector(LANE)
    tick11: Vector = vector(LANE)
    tick12: Vector = vector(LANE)
    tick21: Vector = vector(LANE)
    tick22: Vector = vector(LANE)
    push1: Vector = vector(LANE)
    push2: Vector = vector(LANE)
    middle1: Vector = vector(LANE)
    middle2: Vector = vector(LANE)
    end1: Vector = vector(LANE)
    end2: Vector = vector(LANE)


class Filters(Record):
    """Whether the filters have started, sum of voltages since the last sample, mean square of the drive; their lanes.

    Half the logarithm of the residual covariance is stored and only renewed when the covariance changes.
    """

    started: float
    drive_sum: float
    drive_level: float
    x1: Vector = vector(LANE)
    x2: Vector = vector(LANE)
    p11: Vector = vector(LANE)
    p12: Vector = vector(LANE)
    p22: Vector = vector(LANE)
    residual: Vector = vector(LANE)
    nis: Vector = vector(LANE)
    covariance: Vector = vector(LANE)
    inverse: Vector = vector(LANE)
    gain1: Vector = vector(LANE)
    gain2: Vector = vector(LANE)
    half_log: Vector = vector(LANE)
    pushed1: Vector = vector(LANE)
    pushed2: Vector = vector(LANE)
