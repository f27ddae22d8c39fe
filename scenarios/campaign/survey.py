"""Looks at the results of a campaign in its Parquet files: points page by page, and how runs are spread."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, Field, TypeAdapter

from core.block import FloatArray, IntArray
from core.errors import unknown
from scenarios.arrow import pa, pc
from scenarios.campaign.columns import named
from scenarios.campaign.moments import Sums
from scenarios.campaign.parquet import PART, ParquetParts
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import PointTally, Tallies

TALLY = TypeAdapter(PointTally)
MOST_DOTS = 2000
"""Runs that are drawn one by one; more are counted in cells."""
BINS = 60
"""Cells of a histogram."""
CELLS = (72, 44)
"""Cells across and up."""
COUNTED = {"runs": None, "ok": "ok", "tripped": "trip"}
"""Sort keys of points besides axes and figures, and the column of their count."""


class Extent(BaseModel):
    """The range of an axis that is cut into equal cells."""

    name: str
    low: float
    high: float
    cells: int


class Distribution(BaseModel):
    """How the runs of a campaign are spread over one quantity, or over two."""

    runs: int = Field(description="Runs that have the quantities")
    x: Extent
    y: Extent | None
    counts: list[list[int]] = Field(description="Runs in each cell: rows upward, one row for a histogram")
    dots: list[list[float]] | None = Field(description="The runs themselves, where they are few")


class Survey:
    """The results of a campaign that are in its files.

    Parameters
    ----------
    sweep : Sweep
        The campaign.
    parts : Parts
        Its files.
    """

    def __init__(self, sweep: Sweep, parts: ParquetParts) -> None:
        self.sweep, self.parts = sweep, parts
        self._schema = parts.schema() or pa.schema([])

    @property
    def points(self) -> int:
        """Points of the campaign, with runs or without."""
        return len(self.sweep.points)

    @property
    def figures(self) -> list[str]:
        """Figures that a run has."""
        return named(self._schema, "figure")

    @property
    def quantities(self) -> list[str]:
        """Possible axes of a plot of runs: numeric axes, the seed, figures."""
        axes = [name for name in self._axes if pa.types.is_floating(self._schema.field(name).type)]
        return [*axes, "seed", *self.figures]

    @property
    def _axes(self) -> list[str]:
        return named(self._schema, "axis")

    def order(self, sort: str = "", *, descending: bool = False) -> IntArray:
        """Return the points that have runs, in their own order or by an axis, a mean figure or a count.

        Raises
        ------
        InputError
            When there is nothing of that name.
        """
        counts = self._per_point(None)
        there = np.flatnonzero(counts)
        if not sort or not len(there):
            return there
        known = [*self._axes, *COUNTED, *self.figures]
        if sort not in known:
            raise unknown("column", sort, known, "sort")
        if sort in self._axes:
            labels = [self.sweep.points[number].labels.get(sort) for number in there.tolist()]
            is_text = pa.types.is_string(self._schema.field(sort).type)
            ranks = {text: rank for rank, text in enumerate(sorted({str(label) for label in labels}))}
            values = np.array([ranks[str(label)] if is_text else label for label in labels], float)
        elif sort in COUNTED:
            column = COUNTED[sort]
            values = (counts if column is None else self._per_point(column))[there].astype(float)
        else:
            values = self._means(sort)[there]
        order = np.argsort(-values if descending else values, kind="stable")  # nan comes last
        return there[order]

    def place_after(self, order: IntArray, number: int) -> int:
        """Return the place in an order of points that follows a point."""
        there = np.flatnonzero(order == number)
        return int(there[0]) + 1 if len(there) else int(np.searchsorted(order, number))

    def page(self, points: Sequence[int] | IntArray, figures: Sequence[str] | None = None) -> list[PointTally]:
        """Add up the runs of some points, in the order given; with figures named, these alone."""
        wanted, places = np.unique(np.asarray(points, np.int64), return_inverse=True)
        if not len(wanted):
            return []
        seeds = len(self.sweep.seeds)
        files = np.unique(np.concatenate([_files(number * seeds, (number + 1) * seeds) for number in wanted.tolist()]))
        tallies = Tallies(wanted)
        chosen = [*self.figures, *named(self._schema, "diagnosis")] if figures is None else figures
        names = ["point", "ok", "trip", "error", "warnings", *chosen]
        for number in files.tolist():
            sums = self.parts.sums(number)
            if sums is None:
                for table in self.parts.tables(names if len(self._schema) else None, [number]):
                    tallies.add(table)
            for place in np.flatnonzero(np.isin(wanted, list(sums or ()))).tolist():
                tallies.add_sums(place, _only((sums or {})[int(wanted[place])], figures))
        done = tallies.tallies(self.sweep.points[number].labels for number in wanted.tolist())
        return [done[place] for place in places.tolist()]

    def listed(self, points: Sequence[int]) -> bytes:
        """Return the tallies of some points as JSON, separated by commas."""
        return b",\n".join(map(TALLY.dump_json, self.page(points)))

    def distribution(self, x: str, y: str = "") -> Distribution:
        """Count the runs over one quantity, or over two.

        Raises
        ------
        InputError
            When there is no such quantity.
        """
        names = [x, y] if y else [x]
        for name, field in zip(names, ("x", "y"), strict=False):
            if name not in self.quantities:
                raise unknown("quantity", name, self.quantities, field)
        values = self._values(names)
        cells = CELLS if y else (BINS,)
        extents = [_extent(*entry) for entry in zip(names, values, cells, strict=True)]
        edges = [np.linspace(extent.low, extent.high, extent.cells + 1) for extent in extents]
        counts = np.histogramdd(values.T, edges)[0].astype(int)
        return Distribution(
            runs=values.shape[1],
            x=extents[0],
            y=extents[1] if y else None,
            counts=counts.T.tolist() if y else [counts.tolist()],
            dots=values.T.tolist() if y and values.shape[1] <= MOST_DOTS else None,
        )

    def runs(self) -> int:
        """Return how many runs there are."""
        return self.parts.rows()

    def failed(self) -> int:
        """Return how many runs could not be carried out."""
        return sum(int(pc.sum(pc.not_equal(table["error"], "")).as_py() or 0) for table in self.parts.tables(["error"]))

    def warnings(self) -> list[str]:
        """Return the warnings of runs, once each."""
        said = (table["warnings"].unique().to_pylist() for table in self.parts.tables(["warnings"]))
        return list(dict.fromkeys(text for texts in said for lines in texts for text in lines.split("\n") if text))

    def _values(self, names: list[str]) -> FloatArray:
        """Return columns of numbers, a row for each, of the runs that have all of them."""
        read = list(dict.fromkeys(names))
        pieces = [np.array([table[name].to_numpy() for name in names], float) for table in self.parts.tables(read)]
        values: FloatArray = np.concatenate([np.zeros((len(names), 0)), *pieces], axis=1)
        complete: FloatArray = values.compress(np.isfinite(values).all(axis=0), axis=1)
        return complete

    def _per_point(self, column: str | None) -> IntArray:
        """Count the runs of every point: all, the expected runs, or the tripped runs."""
        found = np.zeros(len(self.sweep.points), np.int64)
        for table in self.parts.tables(["point", column] if column else ["point"]):
            points = table["point"].to_numpy()
            if column is not None:
                points = points[(pc.not_equal(table[column], "") if column == "trip" else table[column]).to_numpy()]
            found += np.bincount(points, minlength=len(found))
        return found

    def _means(self, figure: str) -> FloatArray:
        """Return the mean of a figure at every point, nan where no run has it."""
        count, total = np.zeros((2, len(self.sweep.points)))
        for table in self.parts.tables(["point", figure]):
            values = table[figure].to_numpy()
            there = np.isfinite(values)
            points = table["point"].to_numpy()[there]
            count += np.bincount(points, minlength=len(count))
            total += np.bincount(points, values[there], len(count))
        means: FloatArray = np.divide(total, count, out=np.full(len(count), np.nan), where=count > 0)
        return means


def listed(document: dict[str, Any], folder: Path, points: Sequence[int]) -> bytes:
    """Return the tallies of some points as JSON; in a worker, from the files of the campaign."""
    sweep = Sweep(document)
    return Survey(sweep, ParquetParts(sweep, folder)).listed(points)


def _only(sums: Sums, figures: Sequence[str] | None) -> Sums:
    """Return sums with some figures, and without the verdicts of diagnosers."""
    if figures is None:
        return sums
    chosen = {name: moments for name, moments in sums["figures"].items() if name in figures}
    return {**sums, "figures": chosen, "diagnosis": {}}


def _files(first: int, end: int) -> IntArray:
    """Return which files hold some runs."""
    return np.arange(first // PART, (end - 1) // PART + 1)


def _extent(name: str, values: FloatArray, cells: int) -> Extent:
    """Return the range of values, with some air when they are all alike."""
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        air = 0.5 * abs(high) or 0.5
        low, high = low - air, high + air
    return Extent(name=name, low=low, high=high, cells=cells)
