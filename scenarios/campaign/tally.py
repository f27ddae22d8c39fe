"""Adds up the runs of a point: spreads of figures, confusion, delays, the receiver operating characteristic."""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Mapping

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from pydantic import BaseModel

from core.block import FloatArray, IntArray
from scenarios.campaign.columns import DIAGNOSIS, Row, columns, diagnosers, named
from scenarios.campaign.outcome import EVIDENCE, Outcome
from scenarios.campaign.points import Labels
from scenarios.campaign.sweep import Sweep


class Spread(BaseModel):
    """A figure over runs; ``std`` is that of a sample."""

    count: int
    mean: float
    std: float
    min: float
    max: float


class Roc(BaseModel):
    """Share of faulty samples called faulty against share of healthy ones, as the threshold falls."""

    false_alarm: list[float]
    detection: list[float]
    log10_odds: list[float]
    area: float


class DiagnosisTally(BaseModel):
    """What one diagnoser said in all runs of a point."""

    names: list[str]
    confusion: list[list[int]]
    delays: dict[int, int]
    missed: int
    roc: Roc | None


class PointTally(BaseModel):
    """All runs of a point."""

    labels: dict[str, str | float]
    runs: int = 0
    ok: int = 0
    tripped: int = 0
    errors: list[str] = []
    warnings: list[str] = []
    metrics: dict[str, Spread] = {}
    diagnosis: dict[str, DiagnosisTally] = {}


class Tallies:
    """Adds up the runs of some points, table after table: further runs take no more memory.

    Parameters
    ----------
    points : ndarray of int
        Numbers of the points, ascending; runs of others are passed over.
    """

    def __init__(self, points: IntArray) -> None:
        self._points = points
        self._counts = np.zeros((3, len(points)), np.int64)  # runs, those as expected, those that tripped
        self._errors: dict[int, Counter[str]] = defaultdict(Counter)
        self._warnings: dict[int, Counter[str]] = defaultdict(Counter)
        self._moments: dict[str, Moments] = {}
        self._diagnosis: dict[str, dict[int, _DiagnosisSums]] = defaultdict(dict)

    def add(self, table: pa.Table) -> None:
        """Add runs, in the order of points, with the columns of `scenarios.campaign.columns`."""
        numbers = table["point"].to_numpy()
        places = np.searchsorted(self._points, numbers)
        wanted = self._points[np.minimum(places, len(self._points) - 1)] == numbers
        if not wanted.any():
            return
        if not wanted.all():
            table, places = table.filter(pa.array(wanted)), places[wanted]
        starts = np.flatnonzero(np.diff(places, prepend=-1))
        at = places[starts]
        marks = (np.ones(len(places), bool), table["ok"].to_numpy(), pc.not_equal(table["trip"], "").to_numpy())
        self._counts[:, at] += np.add.reduceat(np.array(marks, np.int64), starts, axis=1)
        failed = pc.not_equal(table["error"], "")
        for place, error in zip(places[failed.to_numpy()].tolist(), table["error"].filter(failed), strict=True):
            self._errors[place][error.as_py()] += 1
        warned = pc.not_equal(table["warnings"], "")
        for place, text in zip(places[warned.to_numpy()].tolist(), table["warnings"].filter(warned), strict=True):
            self._warnings[place].update(text.as_py().split("\n"))
        for name in named(table.schema, "figure"):
            moments = self._moments.setdefault(name, Moments(len(self._points)))
            moments.add(table[name].to_numpy(), starts, at)
        ends = [*starts[1:], len(places)]
        for name in diagnosers(table.schema):
            said = {part: table[f"diagnosis.{name}.{part}"].combine_chunks() for part in DIAGNOSIS}
            for place, start, end in zip(at.tolist(), starts.tolist(), ends, strict=True):
                self._diagnosis[name].setdefault(place, _DiagnosisSums()).add(
                    {part: array.slice(start, end - start) for part, array in said.items()}
                )

    def tally(self, place: int, labels: Labels) -> PointTally:
        """Return the tally of a point, the one at that place among those asked for."""
        runs, ok, tripped = self._counts[:, place].tolist()
        spreads = {name: self._moments[name].spread(place) for name in sorted(self._moments)}
        tallies = {name: sums[place].tally() for name, sums in sorted(self._diagnosis.items()) if place in sums}
        return PointTally(
            labels=labels,
            runs=runs,
            ok=ok,
            tripped=tripped,
            errors=_counted(self._errors[place]),
            warnings=_counted(self._warnings[place]),
            metrics={name: spread for name, spread in spreads.items() if spread is not None},
            diagnosis={name: tally for name, tally in tallies.items() if tally is not None},
        )


def _counted(texts: Counter[str]) -> list[str]:
    """Return what most runs said."""
    return [f"{text} ({count} runs)" for text, count in texts.most_common(3)]


class Moments:
    """Count, mean, sum of squared deviations, least and greatest of a figure at each point (Chan et al. 1979)."""

    def __init__(self, points: int) -> None:
        self.count, self.mean, self._square = np.zeros(points), np.zeros(points), np.zeros(points)
        self._low, self._high = np.full(points, np.inf), np.full(points, -np.inf)

    def add(self, values: FloatArray, starts: IntArray, at: IntArray) -> None:
        """Add values that are in the order of points; those of a point begin at its start, nan is none.

        Parameters
        ----------
        values : (runs,) ndarray
        starts : (points,) ndarray
        at : (points,) ndarray
            Where each point stands.
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
        total = np.maximum(self.count[at] + count, 1.0)
        step = mean - self.mean[at]
        self._square[at] += np.where(count > 0.0, square + step**2 * self.count[at] * count / total, 0.0)
        self.mean[at] += step * (count / total)
        self.count[at] += count
        self._low[at] = np.minimum(self._low[at], low)
        self._high[at] = np.maximum(self._high[at], high)

    def spread(self, at: int) -> Spread | None:
        """Return the spread at a point, none where no run had the figure."""
        count = int(self.count[at])
        if not count:
            return None
        return Spread(
            count=count,
            mean=float(self.mean[at]),
            std=math.sqrt(self._square[at] / (count - 1)) if count > 1 else 0.0,
            min=float(self._low[at]),
            max=float(self._high[at]),
        )


class _DiagnosisSums:
    def __init__(self) -> None:
        self._names: list[str] = []
        self._confusion = np.zeros(0, np.int64)
        self._delays: Counter[int] = Counter()
        self._missed = 0
        self._evidence = np.zeros((2, len(EVIDENCE) + 1), np.int64)

    def add(self, said: dict[str, pa.ListArray]) -> None:
        """Add what a diagnoser said in some runs of the point."""
        if not self._names:
            self._names = next((names for names in said["names"].to_pylist() if names), [])
            self._confusion = np.zeros(len(self._names) ** 2, np.int64)
        self._confusion += _summed(said["confusion"], len(self._confusion))
        delays = said["delays"].flatten()
        self._missed += delays.null_count
        self._delays.update(delays.drop_null().to_pylist())
        for row, part in enumerate(("healthy", "faulty")):
            self._evidence[row] += _summed(said[part], self._evidence.shape[1])

    def tally(self) -> DiagnosisTally | None:
        """Return the sums, none where the diagnoser was in no run."""
        if not self._names:
            return None
        return DiagnosisTally(
            names=self._names,
            confusion=self._confusion.reshape(len(self._names), -1).tolist(),
            delays=dict(sorted(self._delays.items())),
            missed=self._missed,
            roc=receiver_operating_characteristic(*self._evidence) if self._evidence.sum(axis=1).all() else None,
        )


def _summed(rows: pa.ListArray, length: int) -> IntArray:
    """Add up rows of one length; a row without numbers adds nothing."""
    numbers: IntArray = rows.flatten().to_numpy(zero_copy_only=False)
    return numbers.reshape(-1, length).sum(axis=0, dtype=np.int64) if len(numbers) else np.zeros(length, np.int64)


def receiver_operating_characteristic(healthy: FloatArray, faulty: FloatArray) -> Roc:
    r"""Return the curve of a detector from samples counted by evidence.

    :math:`P_F(\eta)=P(\Lambda>\eta\mid H_0),\ P_D(\eta)=P(\Lambda>\eta\mid H_1)`; the area by trapezoids.

    Parameters
    ----------
    healthy, faulty : (n,) ndarray
        Samples in each bin of evidence while the truth was healthy, and while it was not.
    """
    false_alarm, detection = (np.append(0.0, np.cumsum(counts[::-1]) / counts.sum()) for counts in (healthy, faulty))
    corner = np.append(True, np.diff(false_alarm) + np.diff(detection) > 0.0)
    thresholds = np.append(EVIDENCE[::-1], -np.inf)[np.flatnonzero(corner[1:])]
    return Roc(
        false_alarm=false_alarm[corner].tolist(),
        detection=detection[corner].tolist(),
        log10_odds=[float(max(value, EVIDENCE[0])) for value in thresholds],
        area=float(np.trapezoid(detection, false_alarm)),
    )


def tally(sweep: Sweep, outcomes: Mapping[str, Outcome]) -> list[PointTally]:
    """Add up a campaign, point by point, without the runs that are still to come.

    Parameters
    ----------
    sweep : Sweep
        The campaign.
    outcomes : mapping
        By the key of the run.
    """
    keys = enumerate(map(sweep.key, range(len(sweep))))
    tallies = Tallies(np.arange(len(sweep.points)))
    rows: list[Row] = [(number, key, outcomes[key]) for number, key in keys if key in outcomes]
    if rows:
        tallies.add(columns(sweep, rows))
    return [tallies.tally(number, point.labels) for number, point in enumerate(sweep.points)]
