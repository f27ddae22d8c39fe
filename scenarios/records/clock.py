"""Regular samples from the times of a file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.errors import InputError, one_line, short
from scenarios.records.columns import Columns, Numbers

NEAR = 0.05
"""Largest distance of a time from its place in the grid, in samples, for which a row is the sample of this place."""
GAP = 2.0
"""Longest time between two rows, in samples, across which irregular rows are interpolated."""
MOST_LOST = 0.5
"""Largest share of samples that may be lost."""


@dataclass(frozen=True)
class Grid:
    """Rate, the place of each row, and a sentence about it; without places the rows are interpolated at ``times``."""

    rate_khz: float
    places: NDArray[np.int64] | None
    times: Numbers
    note: str = ""


def grid(columns: Columns, name: str, time_ms: Numbers) -> Grid:
    """Return the grid of samples behind the times of a file.

    Raises
    ------
    InputError
        Naming the row of a time that is no number or does not rise, or when too many samples are lost.
    """
    said, wrong = one_line(short(name)), np.flatnonzero(~np.isfinite(time_ms))
    if len(wrong):
        raise InputError(f"row {columns.row(int(wrong[0]))}, column {said}: a time must be a finite number", "record")
    between = np.diff(time_ms)
    back = np.flatnonzero(between <= 0.0)
    if len(back):
        row, before, after = columns.row(int(back[0]) + 1), time_ms[back[0]], time_ms[back[0] + 1]
        raise InputError(f"row {row}, column {said} does not rise: {after:.9g} ms after {before:.9g} ms", "record")
    if len(between) == 0:
        raise InputError("has 1 sample; 2 are the least", "record")
    usual = float(np.median(between))
    if not 1e-300 < usual < 1e300:
        raise InputError(f"column {said} rises by {usual:.3g} ms from row to row", "record")
    if (time_ms[-1] - time_ms[0]) / usual > 2.0 * len(time_ms) / MOST_LOST:
        raise InputError(
            f"has {len(time_ms)} rows for a time of {time_ms[-1] - time_ms[0]:.3g} ms; most are lost", "record"
        )
    places = np.concatenate(([0], np.cumsum(np.maximum(np.rint(between / usual), 1.0)))).astype(np.int64)
    step = (time_ms[-1] - time_ms[0]) / places[-1]
    rate = float(f"{1.0 / step:.9g}")
    lost = int(places[-1]) + 1 - len(places)
    if lost > MOST_LOST * (places[-1] + 1):
        raise InputError(f"has {len(places)} rows for {places[-1] + 1} samples; most are lost", "record")
    off = np.abs(time_ms - time_ms[0] - places * step)
    if off.max() <= NEAR * step:
        return Grid(rate, places, time_ms, said_lost(lost))
    usual = float(between[between < GAP * usual].mean())  # gaps aside
    rate = float(f"{1.0 / usual:.9g}")
    count = int(np.floor((time_ms[-1] - time_ms[0]) * rate + NEAR)) + 1
    times = time_ms[0] + np.arange(count) / rate
    note = f"times are irregular: displacements are interpolated at {rate:g} samples for each ms, longer gaps are lost"
    return Grid(rate, None, times, note)


def said_lost(count: int) -> str:
    """Return the sentence about lost samples; nothing where none is."""
    return "" if count == 0 else "1 sample is lost" if count == 1 else f"{count} samples are lost"


def rows_at(where: Grid, time_ms: Numbers) -> NDArray[np.int64]:
    """Return for each sample of the grid the last row until then: drive and label are held."""
    if where.places is None:
        at, of = where.times, time_ms
    else:
        at, of = np.arange(int(where.places[-1]) + 1).astype(np.float64), where.places.astype(np.float64)
    return np.clip(np.searchsorted(of, at, side="right") - 1, 0, len(of) - 1).astype(np.int64)


def displacements_at(where: Grid, time_ms: Numbers, displacement: Numbers) -> Numbers:
    """Return the displacement at each sample of the grid; a lost sample is no number."""
    if where.places is not None:
        found = np.full(int(where.places[-1]) + 1, np.nan)
        found[where.places] = displacement
        return found
    known = np.isfinite(displacement)
    left = np.minimum(rows_at(where, time_ms), len(time_ms) - 2)
    found = np.interp(where.times, time_ms[known], displacement[known])
    wide = (time_ms[left + 1] - time_ms[left]) * where.rate_khz > GAP
    found[wide | ~(known[left] & known[left + 1])] = np.nan
    return found
