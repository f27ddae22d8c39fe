"""Adds up the runs of a point: spreads of figures, confusion, delays, the receiver operating characteristic."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray, IntArray
from scenarios.arrow import pa, pc
from scenarios.campaign.columns import DIAGNOSIS, Row, columns, diagnosers, named
from scenarios.campaign.moments import DiagnosisSums, Moments, Spread, Sums
from scenarios.campaign.outcome import EVIDENCE, RunOutcome
from scenarios.campaign.points import Labels
from scenarios.campaign.sweep import Sweep

FALLING = np.append(EVIDENCE[::-1], EVIDENCE[0])
"""The threshold of each point of a curve, as it falls; the last bin has no end."""


@dataclass(slots=True)
class Roc:
    """Share of faulty samples called faulty against share of healthy ones, as the threshold falls."""

    false_alarm: list[float]
    detection: list[float]
    log10_odds: list[float]
    area: float


@dataclass(slots=True)
class DiagnosisTally:
    """The results of one diagnoser in all runs of a point."""

    names: list[str]
    confusion: list[list[int]]
    delays: dict[int, int]
    missed: int
    roc: Roc | None


@dataclass(slots=True)
class PointTally:
    """All runs of a point."""

    labels: dict[str, str | float]
    runs: int
    ok: int
    tripped: int
    errors: list[str]
    warnings: list[str]
    metrics: dict[str, Spread]
    diagnosis: dict[str, DiagnosisTally]


class Tallies:
    """Adds up the runs of some points, table after table: further runs take no more memory.

    Parameters
    ----------
    points : ndarray of int
        Numbers of the points, ascending; runs of others are passed over.
    """

    def __init__(self, points: IntArray) -> None:
        self._points = points
        self._counts = np.zeros((3, len(points)), np.int64)  # runs, expected runs, tripped runs
        self._errors: dict[int, Counter[str]] = defaultdict(Counter)
        self._warnings: dict[int, Counter[str]] = defaultdict(Counter)
        self._moments: dict[str, Moments] = {}
        self._diagnosis: dict[str, dict[int, DiagnosisSums]] = defaultdict(dict)

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
            said = {part: _Rows(table[f"diagnosis.{name}.{part}"].combine_chunks()) for part in DIAGNOSIS}
            for place, start, end in zip(at.tolist(), starts.tolist(), ends, strict=True):
                self._diagnosis[name].setdefault(place, DiagnosisSums()).add(
                    {part: rows.of(start, end) for part, rows in said.items()}
                )

    def sums(self, place: int) -> Sums:
        """Return the sums at a place, as JSON can carry them."""
        return {
            "counts": self._counts[:, place].tolist(),
            "errors": self._errors[place],
            "warnings": self._warnings[place],
            "figures": {name: moments.at(place) for name, moments in self._moments.items() if moments.count[place]},
            "diagnosis": {name: said[place].as_json() for name, said in self._diagnosis.items() if place in said},
        }

    def add_sums(self, place: int, sums: Sums) -> None:
        """Add the sums of further runs of the point at a place."""
        self._counts[:, place] += sums["counts"]
        self._errors[place].update(sums["errors"])
        self._warnings[place].update(sums["warnings"])
        for name, figures in sums["figures"].items():
            moments = self._moments.setdefault(name, Moments(len(self._points)))
            moments.merge(np.array([place]), *(np.array([value]) for value in figures))
        for name, said in sums["diagnosis"].items():
            self._diagnosis[name].setdefault(place, DiagnosisSums()).merge(DiagnosisSums.of(said))

    def tallies(self, labels: Iterable[Labels]) -> list[PointTally]:
        """Return the tally of each point, by the labels of each."""
        spreads = {name: self._moments[name].spreads() for name in sorted(self._moments)}
        diagnosis = sorted(self._diagnosis.items())
        found = []
        for place, (own, (runs, ok, tripped)) in enumerate(zip(labels, self._counts.T.tolist(), strict=True)):
            said = {name: _tally(sums[place]) for name, sums in diagnosis if place in sums}
            tally = PointTally(
                own,
                runs,
                ok,
                tripped,
                errors=_counted(self._errors[place]) if place in self._errors else [],
                warnings=_counted(self._warnings[place]) if place in self._warnings else [],
                metrics={name: spread for name, at in spreads.items() if (spread := at[place]) is not None},
                diagnosis={name: tally for name, tally in said.items() if tally is not None},
            )
            found.append(tally)
        return found


def _counted(texts: Counter[str]) -> list[str]:
    """Return the most common texts."""
    return [f"{text} ({count} runs)" for text, count in texts.most_common(3)]


class _Rows:
    """Rows of numbers or texts, each of its own length, as one array."""

    def __init__(self, rows: pa.ListArray) -> None:
        lengths = pc.fill_null(pc.list_value_length(rows), 0).to_numpy()
        self._ends = [0, *np.cumsum(lengths).tolist()]
        self._values = rows.flatten().to_numpy(zero_copy_only=False)

    def of(self, first: int, end: int) -> NDArray[Any]:
        """Return the items of some rows, one after another; nan stands for null."""
        found: NDArray[Any] = self._values[self._ends[first] : self._ends[end]]
        return found


def _tally(sums: DiagnosisSums) -> DiagnosisTally | None:
    """Return the results of a diagnoser, None where it was in no run."""
    if not sums.names:
        return None
    return DiagnosisTally(
        names=sums.names,
        confusion=sums.confusion.reshape(len(sums.names), -1).tolist(),
        delays=dict(sorted(sums.delays.items())),
        missed=sums.missed,
        roc=receiver_operating_characteristic(*sums.evidence) if sums.evidence.sum(axis=1).all() else None,
    )


def receiver_operating_characteristic(healthy: FloatArray, faulty: FloatArray) -> Roc:
    r"""Return the curve of a detector from samples counted by evidence.

    :math:`P_F(\eta)=P(\Lambda>\eta\mid H_0),\ P_D(\eta)=P(\Lambda>\eta\mid H_1)`; the area by trapezoids.

    Parameters
    ----------
    healthy, faulty : (n,) ndarray
        Samples in each bin of evidence while the truth was healthy, and while it was not.
    """
    counts = np.array([healthy, faulty])[:, ::-1]
    moved = counts.any(axis=0)
    sofar = np.cumsum(counts[:, moved], axis=1)
    shares = np.zeros((2, sofar.shape[1] + 1))
    np.divide(sofar, sofar[:, -1:], out=shares[:, 1:])
    false_alarm, detection = shares
    steps, heights = false_alarm[1:] - false_alarm[:-1], detection[1:] + detection[:-1]
    return Roc(
        false_alarm=false_alarm.tolist(),
        detection=detection.tolist(),
        log10_odds=FALLING[moved].tolist(),
        area=0.5 * float((steps * heights).sum()),
    )


def tally(sweep: Sweep, outcomes: Mapping[str, RunOutcome]) -> list[PointTally]:
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
    return tallies.tallies(point.labels for point in sweep.points)
