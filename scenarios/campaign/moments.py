"""Totals of the runs of a point, some at a time: moments of a figure, results of a diagnoser."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray, IntArray
from scenarios.campaign.outcome import EVIDENCE

Sums = dict[str, Any]
"""The sums of `Tallies` for a point, as JSON can carry them."""


@dataclass(slots=True)
class Spread:
    """A figure over runs; ``std`` is the standard deviation of a sample."""

    count: int
    mean: float
    std: float
    min: float
    max: float


class Moments:
    """Count, mean, sum of squared deviations, least and greatest of a figure at each point (Chan et al. 1979)."""

    def __init__(self, points: int) -> None:
        self.count, self.mean, self._square = np.zeros(points), np.zeros(points), np.zeros(points)
        self._low, self._high = np.full(points, np.inf), np.full(points, -np.inf)

    def add(self, values: FloatArray, starts: IntArray, at: IntArray) -> None:
        """Add values in the order of points; the values of a point begin at its start, nan is a missing value.

        Parameters
        ----------
        values : (runs,) ndarray
        starts : (points,) ndarray
        at : (points,) ndarray
            Row of each point.
        """
        there = np.isfinite(values)
        count = np.add.reduceat(there.astype(float), starts)
        runs = np.diff(starts, append=len(values))
        low = np.minimum.reduceat(np.where(there, values, np.inf), starts)
        high = np.maximum.reduceat(np.where(there, values, -np.inf), starts)
        base = np.where(count > 0.0, low, 0.0)  # from it, values that are all alike are exactly that far: not at all
        above = np.where(there, values - np.repeat(base, runs), 0.0)
        rise = np.add.reduceat(above, starts) / np.maximum(count, 1.0)
        square = np.add.reduceat(np.where(there, above - np.repeat(rise, runs), 0.0) ** 2, starts)
        mean = base + rise
        self.merge(at, count, mean, square, low, high)

    def merge(
        self, at: IntArray, count: FloatArray, mean: FloatArray, square: FloatArray, low: FloatArray, high: FloatArray
    ) -> None:
        """Add the moments of other runs at some points."""
        total = np.maximum(self.count[at] + count, 1.0)
        step = mean - self.mean[at]
        self._square[at] += np.where(count > 0.0, square + step**2 * self.count[at] * count / total, 0.0)
        self.mean[at] += step * (count / total)
        self.count[at] += count
        self._low[at] = np.minimum(self._low[at], low)
        self._high[at] = np.maximum(self._high[at], high)

    def at(self, at: int) -> list[float]:
        """Return the moments at a point, in the order in which they are merged."""
        return [float(part[at]) for part in (self.count, self.mean, self._square, self._low, self._high)]

    def spreads(self) -> list[Spread | None]:
        """Return the spread at each point, none where no run had the figure."""
        std = np.sqrt(self._square / np.maximum(self.count - 1.0, 1.0))
        columns = self.count.astype(int), self.mean, np.where(self.count > 1.0, std, 0.0), self._low, self._high
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return [Spread(*row) if row[0] else None for row in rows]


class DiagnosisSums:
    """The results of a diagnoser in some runs of a point."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.confusion = np.zeros(0, np.int64)
        self.delays: Counter[int] = Counter()
        self.missed = 0
        self.evidence = np.zeros((2, len(EVIDENCE) + 1), np.int64)

    def add(self, said: dict[str, NDArray[Any]]) -> None:
        """Add the results of a diagnoser in some runs of the point."""
        if not self.names:
            self.names = list(dict.fromkeys(said["names"].tolist()))
            self.confusion = np.zeros(len(self.names) ** 2, np.int64)
        self.confusion += _summed(said["confusion"], len(self.confusion))
        delays = said["delays"]
        missed = np.isnan(delays)
        self.missed += int(np.count_nonzero(missed))
        self.delays.update(delays[~missed].astype(int).tolist())
        for row, part in enumerate(("healthy", "faulty")):
            self.evidence[row] += _summed(said[part], self.evidence.shape[1])

    def merge(self, other: DiagnosisSums) -> None:
        """Add the sums of other runs."""
        if not self.names:
            self.names, self.confusion = other.names, np.zeros_like(other.confusion)
        self.confusion += other.confusion
        self.delays.update(other.delays)
        self.missed += other.missed
        self.evidence += other.evidence

    def as_json(self) -> dict[str, Any]:
        """Return the sums as JSON can carry them."""
        arrays = {"confusion": self.confusion.tolist(), "evidence": self.evidence.tolist()}
        return {"names": self.names, "delays": self.delays, "missed": self.missed, **arrays}

    @classmethod
    def of(cls, said: dict[str, Any]) -> Self:
        """Return sums that JSON carried."""
        sums = cls()
        sums.names, sums.missed = said["names"], said["missed"]
        sums.delays = Counter({int(delay): count for delay, count in said["delays"].items()})
        sums.confusion, sums.evidence = np.array(said["confusion"], np.int64), np.array(said["evidence"], np.int64)
        return sums


def _summed(numbers: NDArray[Any], length: int) -> IntArray:
    """Add up rows of one length."""
    return numbers.reshape(-1, length).sum(axis=0, dtype=np.int64) if len(numbers) else np.zeros(length, np.int64)
