"""Adds up the runs of a point: spreads of figures, confusion, delays, the receiver operating characteristic."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable

import numpy as np
from pydantic import BaseModel

from core.block import FloatArray
from scenarios.campaign.outcome import EVIDENCE, Diagnosis, Outcome
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


class Sums:
    """Running sums of a point: adding further runs takes no more memory."""

    def __init__(self) -> None:
        self.runs = self.ok = self.tripped = 0
        self.errors: Counter[str] = Counter()
        self.warnings: Counter[str] = Counter()
        self._moments: dict[str, list[float]] = {}
        self._diagnosis: dict[str, _DiagnosisSums] = {}

    def add(self, outcome: Outcome) -> None:
        """Add a run."""
        self.runs += 1
        self.ok += outcome.ok
        self.tripped += bool(outcome.trip)
        if outcome.error:
            self.errors[outcome.error] += 1
        self.warnings.update(outcome.warnings)
        for name, value in outcome.metrics.items():
            count, mean, square, low, high = self._moments.get(name, (0.0, 0.0, 0.0, math.inf, -math.inf))
            count += 1.0  # Welford 1962
            step = value - mean
            mean += step / count
            self._moments[name] = [count, mean, square + step * (value - mean), min(low, value), max(high, value)]
        for name, found in outcome.diagnosis.items():
            self._diagnosis.setdefault(name, _DiagnosisSums(found)).add(found)

    def tally(self, labels: dict[str, str | float]) -> PointTally:
        """Return the tally of the runs added so far."""
        return PointTally(
            labels=labels,
            runs=self.runs,
            ok=self.ok,
            tripped=self.tripped,
            errors=_counted(self.errors),
            warnings=_counted(self.warnings),
            metrics={
                name: Spread(
                    count=int(count),
                    mean=mean,
                    std=math.sqrt(square / (count - 1.0)) if count > 1 else 0.0,
                    min=low,
                    max=high,
                )
                for name, (count, mean, square, low, high) in sorted(self._moments.items())
            },
            diagnosis={name: sums.tally() for name, sums in self._diagnosis.items()},
        )


def _counted(texts: Counter[str]) -> list[str]:
    """Return what most runs said."""
    return [f"{text} ({count} runs)" for text, count in texts.most_common(3)]


class _DiagnosisSums:
    def __init__(self, first: Diagnosis) -> None:
        self._names = first.names
        self._confusion = np.zeros((len(first.names), len(first.names)), np.int64)
        self._delays: Counter[int] = Counter()
        self._missed = 0
        self._evidence = np.zeros((2, len(EVIDENCE) + 1), np.int64)

    def add(self, diagnosis: Diagnosis) -> None:
        self._confusion += np.array(diagnosis.confusion)
        self._delays.update(delay for delay in diagnosis.delays if delay is not None)
        self._missed += sum(delay is None for delay in diagnosis.delays)
        if diagnosis.healthy:
            self._evidence += np.array([diagnosis.healthy, diagnosis.faulty])

    def tally(self) -> DiagnosisTally:
        return DiagnosisTally(
            names=self._names,
            confusion=self._confusion.tolist(),
            delays=dict(sorted(self._delays.items())),
            missed=self._missed,
            roc=receiver_operating_characteristic(*self._evidence) if self._evidence.sum(axis=1).all() else None,
        )


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


def tally(sweep: Sweep, outcomes: dict[str, Outcome] | Iterable[tuple[str, Outcome]]) -> list[PointTally]:
    """Add up a campaign, point by point, without the runs that are still to come.

    Parameters
    ----------
    sweep : Sweep
        The campaign.
    outcomes : iterable of (key, outcome)
        In any order.
    """
    sums = [Sums() for _ in sweep.points]
    positions: dict[str, list[int]] = {}
    for number, (key, _, _) in enumerate(sweep.runs()):
        positions.setdefault(key, []).append(number // len(sweep.seeds))
    for key, outcome in outcomes.items() if isinstance(outcomes, dict) else outcomes:
        for position in positions.get(key, ()):
            sums[position].add(outcome)
    return [total.tally(point.labels) for total, point in zip(sums, sweep.points, strict=True)]
