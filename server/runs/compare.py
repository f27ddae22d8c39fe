"""A comparison of finished runs: their figures with differences from the first, and traces that all of them have."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from pydantic import BaseModel, Field

from core.errors import unknown
from core.signals import CLOCK
from scenarios.arrow import pq
from scenarios.report.svg import thin
from server.errors import ApiError
from server.runs.listing import Run

MOST = 8
"""Runs that are distinguishable in one table and one chart."""


class FigureRow(BaseModel):
    """One figure of all runs."""

    metric: str
    values: list[float | None] = Field(description="In the order of the runs; null where a run has no such figure")
    differences: list[float | None] = Field(description="Each value less the value of the first run")


class RunSignal(BaseModel):
    """A signal whose trace all runs have."""

    name: str
    unit: str


class RunComparison(BaseModel):
    """Runs side by side."""

    runs: list[Run]
    figures: list[FigureRow]
    signals: list[RunSignal]


class RunTrace(BaseModel):
    """One signal of one run, thinned to the smallest and largest value of each column."""

    id: str
    time_ms: list[float]
    values: list[float]


class RunTraces(BaseModel):
    """One signal of several runs, to be laid over each other."""

    signal: str
    unit: str
    runs: list[RunTrace]


def compare_runs(runs: Sequence[Run], paths: Sequence[Path]) -> RunComparison:
    """Compare the figures of runs, and list the signals that all of them have.

    Raises
    ------
    ApiError
        When there are fewer than two, or one of them is not done.
    """
    if not 2 <= len({run.id for run in runs}) == len(runs) <= MOST:
        raise ApiError(422, "invalid", f"name from 2 to {MOST} different runs", "ids")
    for run in runs:
        if run.state != "done" or run.summary is None:
            raise ApiError(409, "conflict", f"the run {run.id} is {run.state}; only finished runs are compared", "ids")
    metrics = [dict(run.summary["metrics"]) for run in runs if run.summary is not None]
    rows = []
    for name in dict.fromkeys(name for one in metrics for name in one):
        values = [one.get(name) for one in metrics]
        base = values[0]
        differences = [None if value is None or base is None else value - base for value in values]
        rows.append(FigureRow(metric=name, values=values, differences=differences))
    return RunComparison(runs=list(runs), figures=rows, signals=_common(paths))


def traces(runs: Sequence[Run], paths: Sequence[Path], signal: str, columns: int) -> RunTraces:
    """Read one signal of runs.

    Raises
    ------
    InputError
        When not all of them have it.
    """
    common = {one.name: one for one in _common(paths)}
    if signal not in common:
        raise unknown("signal of all these runs", signal, common, "signal")
    found = []
    for run, path in zip(runs, paths, strict=True):
        table = pq.read_table(path, columns=[CLOCK[1], signal])
        time, values = (table.column(name).to_numpy().astype(float) for name in (CLOCK[1], signal))
        kept, thinned = thin(np.asarray, values, most=columns)
        found.append(RunTrace(id=run.id, time_ms=time[kept].tolist(), values=thinned))
    return RunTraces(signal=signal, unit=common[signal].unit, runs=found)


def _common(paths: Sequence[Path]) -> list[RunSignal]:
    """Return the signals that are in all files; none where a run, being a study, has no trace."""
    files = [pq.ParquetFile(path) for path in paths if path.is_file()]
    if len(files) < len(paths) or any(file.metadata.num_rows == 0 for file in files):
        return []
    schemas = [file.schema_arrow for file in files]
    names = [name for name in schemas[0].names[2:] if all(name in schema.names for schema in schemas)]
    units = {name: (schemas[0].field(name).metadata or {}).get(b"unit", b"").decode() for name in names}
    return [RunSignal(name=name, unit=unit) for name, unit in units.items()]
