"""A comparison of two recordings: the largest difference of every signal against a tolerance."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, Field

from core.errors import InputError, unknown
from scenarios.arrow import pq


class SignalDifference(BaseModel):
    """One signal of both."""

    signal: str
    unit: str
    max_difference: float = Field(description="Largest absolute difference")
    at_tick: int = Field(description="Tick of the first recording where that is")
    rms_difference: float
    tolerance: float
    ok: bool


class Comparison(BaseModel):
    """The table of a comparison."""

    ok: bool
    ticks: int = Field(description="Ticks compared")
    signals: list[SignalDifference]
    only_in_first: list[str]
    only_in_second: list[str]


def compare(
    first: Path,
    second: Path,
    absolute: float,
    relative: float,
    tolerances: dict[str, float],
    by_start: bool,
) -> Comparison:
    """Compare two recordings tick by tick.

    Parameters
    ----------
    first, second : Path
        The files.
    absolute, relative : float
        Tolerance of every signal: an absolute part, plus a share of its largest value in the first recording.
    tolerances : dict
        Tolerance of some signals instead.
    by_start : bool
        Lay the first ticks upon each other instead of equal ticks.

    Raises
    ------
    InputError
        When they have no tick or no signal in common, or a tolerance names none.
    """
    files = [pq.ParquetFile(path) for path in (first, second)]
    names = [file.schema_arrow.names for file in files]
    common = [name for name in names[0][2:] if name in names[1]]
    for name in tolerances:
        if name not in common:
            raise unknown("signal of both recordings", name, common, "tolerances")
    ticks = [_column(file, "tick") for file in files]
    if by_start:
        length = min(len(ticks[0]), len(ticks[1]))
        rows = [np.arange(length), np.arange(length)]
    else:
        _, *rows = np.intersect1d(ticks[0], ticks[1], assume_unique=True, return_indices=True)
    if not len(rows[0]) or not common:
        raise InputError("have no tick and signal in common", "other", 'align them by "start"')
    differences = []
    for name in common:
        first_values, second_values = (
            _column(file, name)[at].astype(np.float64) for file, at in zip(files, rows, strict=True)
        )
        difference = np.abs(first_values - second_values)
        difference[np.isnan(first_values) & np.isnan(second_values)] = 0.0
        difference[np.isnan(difference)] = np.inf
        peak = float(np.max(np.abs(first_values), initial=0.0, where=np.isfinite(first_values)))
        tolerance = tolerances.get(name, absolute + relative * peak)
        worst = int(np.argmax(difference))
        largest = min(float(difference[worst]), float(np.finfo(np.float64).max))
        rms = float(np.sqrt(np.mean(np.minimum(difference, 1e150) ** 2)))
        differences.append(
            SignalDifference(
                signal=name,
                unit=(files[0].schema_arrow.field(name).metadata or {}).get(b"unit", b"").decode(),
                max_difference=largest,
                at_tick=int(ticks[0][rows[0][worst]]),
                rms_difference=rms,
                tolerance=tolerance,
                ok=largest <= tolerance,
            )
        )
    return Comparison(
        ok=all(entry.ok for entry in differences),
        ticks=len(rows[0]),
        signals=differences,
        only_in_first=[name for name in names[0][2:] if name not in names[1]],
        only_in_second=[name for name in names[1][2:] if name not in names[0]],
    )


def _column(file: pq.ParquetFile, name: str) -> NDArray[np.float64]:
    column: NDArray[np.float64] = file.read(columns=[name]).column(0).to_numpy()
    return column
