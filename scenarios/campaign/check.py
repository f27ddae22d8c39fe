"""Checks of a campaign before it begins: its whole document, but not every point.

Each value of a variant or a grid, and the rows with the least and the greatest number of each column, are tried with
the first values of all else. The points themselves are read when their runs are made; a point that gives no valid
scenario gives runs with an error. Of random draws, such as devices, one possible draw is enough.
"""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Real
from typing import Any

from core.errors import InputError
from scenarios.campaign.points import Point, Points, RowsAxis, Step, SweepAxis, Values
from scenarios.campaign.sweep import Sweep
from scenarios.run import DEFAULT_SAMPLES
from scenarios.schema import Scenario

MOST = 100
"""Steps of an axis that are tried; beyond them, those with the least and the greatest number at each path."""
LENGTH = frozenset({"samples", "duration_ms", "sample_rate_khz"})
"""The fields that determine the length of a run."""


def check(sweep: Sweep) -> Scenario:
    """Check a campaign; return a scenario as long as its longest.

    Raises
    ------
    InputError
        For the first value that is not allowed.
    """
    points = sweep.points
    number, scenario = _first(points)
    first = [_step(axis, number) for axis in points.varied]
    for position, axis in enumerate(points.varied):
        for step in axis.ends(MOST) if isinstance(axis, RowsAxis) else _telling(axis):
            steps = [*first[:position], step, *first[position + 1 :]]
            scenario = Scenario.load(points.of(steps).document, like=scenario)
    return Scenario.load(_longest(sweep, first).document, like=scenario)


def _first(points: Points) -> tuple[int, Scenario]:
    """Return the first row of numbers that can be carried out, and the scenario of this point."""
    refusals: list[InputError] = []
    for number in range(max((min(len(axis), MOST) for axis in points.varied if isinstance(axis, RowsAxis)), default=1)):
        try:
            return number, Scenario.load(points.of(_step(axis, number) for axis in points.varied).document)
        except InputError as error:
            refusals.append(error)
    raise refusals[0]


def _step(axis: SweepAxis, number: int) -> Step:
    """Return a row of numbers, of other axes the first step."""
    return axis[min(number, len(axis) - 1)] if isinstance(axis, RowsAxis) else axis[0]


def _telling(axis: SweepAxis) -> list[Step]:
    """Return the steps of a variant or a grid that show whether it was mistyped."""
    steps = [axis[number] for number in range(len(axis))]
    least: dict[str, tuple[Any, int]] = {}
    greatest: dict[str, tuple[Any, int]] = {}
    for number, (_, values) in enumerate(steps[MOST:], MOST):
        for path, value in values.items():
            if isinstance(value, Real):
                least[path] = min(least.get(path, (value, number)), (value, number))
                greatest[path] = max(greatest.get(path, (value, number)), (value, number))
    ends = {number for _, number in (*least.values(), *greatest.values())}
    return [*steps[:MOST], *(steps[number] for number in sorted(ends))]


def _longest(sweep: Sweep, first: Sequence[Step]) -> Point:
    """Return the first point, as long as the longest of all."""
    deciding = [axis for axis in sweep.points.varied if _sets_length(axis)]
    points = Points(deciding, sweep.base.document)
    longest = max((point.values for point in points), key=lambda values: _ticks(sweep.base, values))
    usual = sweep.points.of(first)
    values = {path: value for path, value in usual.values.items() if path not in LENGTH}
    values |= {path: value for path, value in longest.items() if path in LENGTH}
    return Point(usual.labels, values, usual.base)


def _sets_length(axis: SweepAxis) -> bool:
    some = 1 if isinstance(axis, RowsAxis) else len(axis)  # all rows set the same
    return any(LENGTH & axis[number][1].keys() for number in range(some))


def _ticks(base: Scenario, values: Values) -> float:
    """Return the length of a point; a value that is no number is refused when the point is read."""

    def number(path: str, usual: float) -> float:
        value = values.get(path, usual)
        return float(value) if isinstance(value, Real) else 0.0

    usual_ms = 0.0 if "samples" in values else base.head.duration_ms or 0.0
    if duration_ms := number("duration_ms", usual_ms):
        return duration_ms * number("sample_rate_khz", base.spec.frame.sample_rate_khz)
    return number("samples", base.samples or DEFAULT_SAMPLES)
