"""Points of a campaign: every combination of its axes, each made when it is read."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Protocol, overload

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray, IntArray
from core.board.document import says_the_same
from core.errors import InputError
from scenarios.edit import written
from scenarios.key import content_hash
from scenarios.schema import HEAD, Scenario

Values = dict[str, Any]
Labels = dict[str, str | float]
Step = tuple[Labels, Values]
"""One step of an axis: its label in tables, and the values it writes over a scenario."""


class SweepAxis(Protocol):
    """Steps to combine with the steps of other axes."""

    def __len__(self) -> int:
        """Return the number of steps."""

    def __getitem__(self, at: int, /) -> Step:
        """Return a step."""


class RowsAxis:
    """An axis whose steps are rows of a table, kept as columns: a step as a dictionary takes hundreds of bytes.

    Parameters
    ----------
    columns : dict of ndarray
        By the field of the scenario that a column sets, a value for each step: numbers, or texts as objects.
    number : str
        Name under which tables show the number of a row, for those drawn by chance; empty: they show its values.
    """

    def __init__(self, columns: Mapping[str, NDArray[Any]], number: str = "") -> None:
        self.paths, self._columns, self._number = tuple(columns), columns, number

    def __len__(self) -> int:
        """Return the number of steps."""
        return len(self._columns[self.paths[0]])

    def __getitem__(self, at: int) -> Step:
        """Return a step."""
        values = {path: column.item(at) for path, column in self._columns.items()}
        return ({self._number: float(at + 1)} if self._number else _labels(values)), values

    @property
    def numbers(self) -> list[str]:
        """The fields that are set to numbers."""
        return [path for path, column in self._columns.items() if column.dtype.kind in "if"]

    def column(self, path: str) -> FloatArray:
        """Return the numbers that the steps write to a field; nan in place of texts."""
        column = self._columns[path]
        return column.astype(float) if path in self.numbers else np.full(len(self), math.nan)

    def ends(self, most: int) -> list[Step]:
        """Return the steps with the least and the greatest number of each field, and those with its first texts.

        There are none where chance draws them.
        """
        if self._number:
            return []
        found: set[int] = set()
        for path, column in self._columns.items():
            if path in self.numbers:
                found |= {int(column.argmin()), int(column.argmax())}
            else:
                first = {text: at for at, text in reversed([*enumerate(column.tolist())])}
                found |= {*sorted(first.values())[:most]}
        return [self[at] for at in sorted(found)]


def _labels(values: Values) -> Labels:
    """Write values for a table."""
    return {path: str(value) if isinstance(value, bool) else value for path, value in values.items()}


@dataclass(frozen=True, slots=True)
class Point:
    """One set of values: its labels in tables, and the values it writes over a scenario."""

    labels: Labels
    values: Values
    base: dict[str, Any]

    @property
    def document(self) -> dict[str, Any]:
        """The scenario with its values; built anew at each call, because thousands of them take much memory."""
        return written(self.base, self.values) if self.values else self.base

    def read(self, last: tuple[Point, Scenario] | None = None) -> Scenario:
        """Return its scenario; ``last`` is another point with its own, which may be alike.

        Points of one base that write numbers to the same fields of the bench differ by these numbers alone: then
        nothing else is read again.

        Raises
        ------
        InputError
            When its values give no valid scenario.
        """
        point, like = last or (None, None)
        if point is not None and like is not None and _are_numbers(point, self):
            with suppress(InputError):  # which does not name the field as it is written
                return like.with_numbers(self.values, lambda: self.document)
        return Scenario.load(self.document, like=like)


def _are_numbers(*points: Point) -> bool:
    """Say whether points of one base write numbers to the same fields of the bench, and nothing else."""
    one, other = (point.values for point in points)
    return (
        says_the_same(*(point.base for point in points))
        and one.keys() == other.keys()
        and all(type(value) is float for values in (one, other) for value in values.values())
        and not any(path.partition(".")[0] in HEAD for path in one)
    )


class Points(Sequence[Point]):
    """Every combination of the steps of some axes; the last axis changes fastest.

    Parameters
    ----------
    axes : sequence of Axis
        Varied fields.
    base : dict
        The scenario that the points differ from.

    Attributes
    ----------
    varied : sequence of Axis
        Varied fields.
    """

    def __init__(self, axes: Sequence[SweepAxis], base: dict[str, Any]) -> None:
        self.varied, self._base = axes, base
        self._count = math.prod(len(axis) for axis in axes)

    def __len__(self) -> int:
        """Return the number of points."""
        return self._count

    @overload
    def __getitem__(self, at: int) -> Point: ...
    @overload
    def __getitem__(self, at: slice) -> list[Point]: ...
    def __getitem__(self, at: int | slice) -> Point | list[Point]:
        """Return a point, or some."""
        if isinstance(at, slice):
            return [self[number] for number in range(*at.indices(self._count))]
        if not 0 <= at < self._count:
            raise IndexError(at)
        steps = []
        for axis in reversed(self.varied):
            at, step = divmod(at, len(axis))
            steps.append(axis[step])
        return self.of(reversed(steps))

    def of(self, steps: Iterable[Step]) -> Point:
        """Return the point of some steps, one of each axis."""
        labels: Labels = {}
        values: Values = {}
        for names, written_over in steps:
            labels |= names
            values |= written_over
        return Point(labels, values, self._base)

    def column(self, path: str, numbers: IntArray) -> FloatArray:
        """Return the values that some points write to a numeric field; nan where they write none."""
        for axis in reversed(self.varied):
            numbers, steps = np.divmod(numbers, len(axis))
            if isinstance(axis, RowsAxis):
                if path in axis.paths:
                    return axis.column(path)[steps]
            elif any(path in axis[at][1] for at in range(len(axis))):
                return np.array([axis[at][1].get(path, math.nan) for at in range(len(axis))], float)[steps]
        return np.full(len(numbers), math.nan)

    def axes(self) -> dict[str, bool]:
        """Return the names of labels, in their order, and whether one of the values is a text."""
        found: dict[str, bool] = {}
        for axis in self.varied:
            for number in range(1 if isinstance(axis, RowsAxis) else len(axis)):  # columns have values of one kind
                for name, value in axis[number][0].items():
                    found[name] = found.get(name, False) or isinstance(value, str)
        return found


class Contents(Sequence[str]):
    """The hashes of points, from which the keys of their runs are built; each worked out once, in less than 0.1 ms."""

    def __init__(self, points: Points) -> None:
        self._points, self._known = points, [""] * len(points)

    def __len__(self) -> int:
        """Return the number of points."""
        return len(self._known)

    @overload
    def __getitem__(self, at: int) -> str: ...
    @overload
    def __getitem__(self, at: slice) -> list[str]: ...
    def __getitem__(self, at: int | slice) -> str | list[str]:
        """Return a hash, or some."""
        if isinstance(at, slice):
            return [self[number] for number in range(*at.indices(len(self)))]
        if not self._known[at]:
            point = self._points[at]
            try:
                self._known[at] = content_hash(point.document)
            except InputError:  # its values give no valid scenario: its runs carry the error
                self._known[at] = content_hash({"scenario": point.base, "set": point.values})
        return self._known[at]
