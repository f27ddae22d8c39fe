"""Results of a campaign as Parquet files that others read in place: each file some thousand runs, in order.

The table of results is the truth. A file is written once all its runs are in the table, or with the finished runs when
it is read; a missing or incomplete file is made anew from the table. All files of a campaign have the same columns, so
that a folder of them is one table.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import BinaryIO, Literal

import numpy as np

from scenarios.arrow import csv, pa, pq
from scenarios.campaign.columns import ABOUT, Row, about, columns, fitted, union
from scenarios.campaign.moments import Sums
from scenarios.campaign.outcome import RunOutcome
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import Tallies
from scenarios.key import content_hash, run_key

PART = 5000
"""Runs of a file."""
AT_ONCE = 500
"""Outcomes that are read together: each takes 10 kB of memory before it is a row."""
MANY = 500
"""Runs of a point, from which their sums are worth their place."""
SUMS = b"combbench.sums"
"""Where a file holds them."""
Read = Callable[[list[str]], Iterable[tuple[str, str]]]
"""Reads outcomes, JSON texts, from the table of results by their keys."""


class ParquetParts:
    """The files of a campaign.

    Parameters
    ----------
    sweep : Sweep
        The campaign.
    folder : Path
        Where the files are; made when there is something to write.
    """

    def __init__(self, sweep: Sweep, folder: Path) -> None:
        self._sweep, self._folder = sweep, folder
        self._mark = run_key(content_hash({"sweep": sweep.document})).encode()
        self._complete: set[int] = set()
        self._is_cleared = False
        self._followed = 0

    def __len__(self) -> int:
        """Return how many files all runs make."""
        return -(-len(self._sweep) // PART)

    def path(self, number: int) -> Path:
        """Return the name of a file."""
        return self._folder / f"part-{number:05d}.parquet"

    def paths(self) -> list[Path]:
        """Return the existing files, in order."""
        return [path for path in map(self.path, range(len(self))) if path.exists()]

    def whole(self) -> int:
        """Return how many files have all their runs."""
        return sum(self._rows(number) == self._whole(number) for number in range(len(self)))

    def rows(self) -> int:
        """Return how many runs the files have."""
        return sum(self._rows(number) for number in range(len(self)))

    def schema(self) -> pa.Schema | None:
        """Return the columns, the same in all files."""
        return next((pq.read_schema(path) for path in self.paths()), None)

    def tables(self, names: list[str] | None = None, numbers: Iterable[int] | None = None) -> Iterator[pa.Table]:
        """Read some columns of the files, or of those with such numbers, one file after the other."""
        schema = self.schema()
        for path in self.paths() if numbers is None else map(self.path, numbers):
            if path.exists():
                yield pq.read_table(path, columns=names, schema=schema, partitioning=None)

    def sums(self, number: int) -> dict[int, Sums] | None:
        """Return the totals of the runs of a file, by the number of the point; None for a file of many points."""
        path = self.path(number)
        said = (pq.read_metadata(path).metadata or {}).get(SUMS) if path.exists() else None
        return None if said is None else {int(point): sums for point, sums in json.loads(said).items()}

    def follow(self, done: int, read: Read) -> None:
        """Write complete files, as soon as enough runs have finished since the last time."""
        if done - self._followed >= PART:
            self.keep_up(read)
            self._followed = done

    def keep_up(self, read: Read, *, to_end: bool = False) -> int:
        """Write the files that have become more complete; return how many runs the files have.

        Runs are made in order: without ``to_end`` nothing is looked for behind the first runs that are missing.
        """
        self._clear()
        for number in range(len(self)):
            had, whole = self._rows(number), self._whole(number)
            if had == whole:
                continue
            table = self._made(number, read, to_end)
            rows = 0 if table is None else table.num_rows
            if table is not None and rows > had:
                self._write(number, table)
            if not rows and not to_end:
                break
        return self.rows()

    def begin(self, read: Read) -> int:
        """Write the first few runs, which takes a moment, if there are no files; return how many runs they have."""
        self._clear()
        if not self.rows() and (table := self._rows_of(range(min(AT_ONCE, self._whole(0))), read)) is not None:
            self._write(0, table)
        return self.rows()

    def _whole(self, number: int) -> int:
        return min(PART, len(self._sweep) - number * PART)

    def _rows(self, number: int) -> int:
        if number in self._complete and self.path(number).exists():
            return self._whole(number)
        rows = self._rows_in(self.path(number))
        if rows == self._whole(number):
            self._complete.add(number)
        return rows

    def _rows_in(self, path: Path) -> int:
        """Return how many runs of this campaign a file has: none if it belongs to another campaign or is missing."""
        try:
            metadata = pq.read_metadata(path)
        except (FileNotFoundError, pa.ArrowInvalid):
            return 0
        return metadata.num_rows if (metadata.metadata or {}).get(ABOUT) == self._mark else 0

    def _clear(self) -> None:
        """Remove the files of the campaign before its change, once."""
        if not self._is_cleared:
            for path in self._folder.glob("part-*.parquet"):
                if not self._rows_in(path):
                    path.unlink()
            self._is_cleared = True

    def _made(self, number: int, read: Read, to_end: bool) -> pa.Table | None:
        """Return the runs of a file that are in the table of results."""
        tables = []
        end = number * PART + self._whole(number)
        for first in range(number * PART, end, AT_ONCE):
            if (table := self._rows_of(range(first, min(first + AT_ONCE, end)), read)) is not None:
                tables.append(table)
            elif not to_end:
                break
        if not tables:
            return None
        schema = union([table.schema for table in tables])
        return pa.concat_tables(fitted(table, schema) for table in tables)

    def _rows_of(self, numbers: range, read: Read) -> pa.Table | None:
        """Return the stored rows of some runs."""
        keys = {number: self._sweep.key(number) for number in numbers}
        texts = dict(read(list(dict.fromkeys(keys.values()))))
        rows: list[Row] = [
            (number, key, RunOutcome.model_validate_json(texts[key])) for number, key in keys.items() if key in texts
        ]
        return columns(self._sweep, rows) if rows else None

    def _write(self, number: int, table: pa.Table) -> None:
        """Write a file; when it brings columns that the others lack, they are written anew."""
        self._folder.mkdir(parents=True, exist_ok=True)
        known = self.schema()
        schema = (table.schema if known is None else union([known, table.schema])).with_metadata({ABOUT: self._mark})
        if known is not None and len(schema) > len(known):
            for path in self.paths():
                _put(path, fitted(pq.read_table(path, partitioning=None), schema))
        _put(self.path(number), fitted(table, schema))


def write_runs(parts: ParquetParts, file: BinaryIO, *, kind: Literal["csv", "parquet"]) -> int:
    """Write a row for each run, without the verdicts of single samples; return the number of rows."""
    rows = 0
    schema = parts.schema() or pa.schema([])
    names = [name for name in schema.names if about(schema.field(name)) != "diagnosis" and name != "key"]
    names = ["key", *names] if "key" in schema.names else names
    chosen = pa.schema([schema.field(name).remove_metadata() for name in names])
    made = pq.ParquetWriter(file, chosen, compression="zstd") if kind == "parquet" else csv.CSVWriter(file, chosen)
    with made as writer:
        for table in parts.tables(names):
            writer.write_table(table.select(names).replace_schema_metadata().cast(chosen))
            rows += table.num_rows
    return rows


def _put(path: Path, table: pa.Table) -> None:
    """Write a file under a name that no reader of the folder takes for one of its own, then rename it.

    A file with many runs of each point holds their totals: reading the totals takes a moment, reading the runs takes
    long.
    """
    points = np.unique(table["point"].to_numpy())
    if len(points) * MANY <= table.num_rows:
        tallies = Tallies(points)
        tallies.add(table)
        sums = {int(point): tallies.sums(place) for place, point in enumerate(points)}
        table = table.replace_schema_metadata({**table.schema.metadata, SUMS: json.dumps(sums)})
    temporary = path.with_name(f".{path.name}.part")
    pq.write_table(table, temporary, compression="zstd")
    os.replace(temporary, path)
