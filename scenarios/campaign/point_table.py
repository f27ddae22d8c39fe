"""Points of a campaign from a design of experiments: rows of a document, of a CSV file or of a Parquet file."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from core.errors import InputError, short
from core.table import Table
from scenarios.arrow import csv, pa, pq
from scenarios.campaign.points import RowsAxis
from scenarios.reading import read_bytes

FIELD = "points.table"
MOST_POINTS = 100_000
MOST_PATHS = 50
"""Values that vary at once."""
MOST_BYTES = 256 << 20
"""Bytes of a file, and of its content in memory."""
KINDS: dict[type, str] = {bool: "truth value", int: "finite number", float: "finite number", str: "text"}
"""Kinds of the values of a column, by the type of a value."""


class PointTable(Table):
    """Points from outside: a row for each, with values for some paths of the scenario.

    The rows are in the document, or are CSV text in it, or in a file that the command line reads in its place.
    """

    table: str = Field("", description="CSV or Parquet file, whose columns are the paths; relative to the campaign")
    csv: str = Field("", description="the rows as CSV text, whose header has the paths")
    paths: list[str] = Field([], max_length=MOST_PATHS, description="dotted paths of the scenario, a column for each")
    rows: list[list[Any]] = Field([], max_length=MOST_POINTS, description="values, a row for each point")

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if self.table:
            text = f"only the command line and Python read the file {short(self.table)}"
            raise ValueError(f"{text}; here give csv, or paths and rows")
        if self.csv:
            if self.paths or self.rows:
                raise ValueError("give csv, or paths and rows, not both")
            self.paths, self.rows = _listed(self.csv.encode(), _csv, "csv")
        if not self.paths or not self.rows:
            raise ValueError("needs paths, and at least one row")
        if len({*self.paths}) < len(self.paths):
            raise ValueError(f"has a path twice: {next(path for path in self.paths if self.paths.count(path) > 1)}")
        for number, row in enumerate(self.rows, 1):
            if len(row) != len(self.paths):
                raise ValueError(f"row {number} has {len(row)} values for {len(self.paths)} paths")
        return self

    def steps(self) -> RowsAxis:
        """Return the rows as columns of one kind each.

        Raises
        ------
        InputError
            For a value that is no finite number, text or truth value, or of another kind than the first of its column.
        """
        return RowsAxis({path: _column(path, [row[at] for row in self.rows]) for at, path in enumerate(self.paths)})


def _column(path: str, values: list[Any]) -> NDArray[Any]:
    kind = KINDS.get(type(values[0]), "finite number")
    for number, value in enumerate(values, 1):
        if KINDS.get(type(value)) != kind or (isinstance(value, float) and not math.isfinite(value)):
            raise InputError(f"row {number} has {short(value)}; allowed: a {kind}", f"points.{path}")
    if kind != "finite number":
        return np.array(values, object)
    return np.array(values, int if all(isinstance(value, int) for value in values) else float)


def read_point_table(path: Path) -> dict[str, Any]:
    """Return the paths and rows of a CSV or Parquet file.

    Raises
    ------
    InputError
        When it cannot be read, or is too large.
    """
    content = read_bytes(path, FIELD, MOST_BYTES)
    is_parquet = path.suffix.lower() in (".parquet", ".pq")
    try:
        paths, rows = _listed(content, _parquet if is_parquet else _csv, str(path))
    except ValueError as error:
        raise InputError(str(error), FIELD) from None
    return {"paths": paths, "rows": rows}


def _listed(content: bytes, read: Callable[[Any], Any], name: str) -> tuple[list[str], list[list[Any]]]:
    """Return the names of columns, and the rows.

    Raises
    ------
    ValueError
        When the content cannot be read, or is too large.
    """
    try:
        table = read(pa.BufferReader(content))
    except (pa.ArrowException, OSError, UnicodeError) as error:
        raise ValueError(f"{name} cannot be read: {' '.join(str(error).split())}") from None
    columns = [column.to_pylist() for column in table.columns]
    return table.column_names, [list(row) for row in zip(*columns, strict=True)]


def _parquet(content: Any) -> Any:
    file = pq.ParquetFile(content)
    groups = (file.metadata.row_group(number) for number in range(file.metadata.num_row_groups))
    _check_size(file.metadata.num_rows, file.metadata.num_columns)
    if sum(group.total_byte_size for group in groups) > MOST_BYTES:
        raise ValueError(f"the table has more than {MOST_BYTES} bytes in memory")
    return file.read()


def _csv(content: Any) -> Any:
    table = csv.read_csv(content)
    _check_size(table.num_rows, table.num_columns)
    return table


def _check_size(rows: int, columns: int) -> None:
    if rows > MOST_POINTS or columns > MOST_PATHS:
        text = f"the table has {rows} rows and {columns} columns"
        raise ValueError(f"{text}; at most {MOST_POINTS} and {MOST_PATHS}")
