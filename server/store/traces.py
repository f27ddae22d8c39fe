"""Traces as files: Parquet, CSV, NPZ, MAT, MCAP."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Literal, cast

import numpy as np
from numpy.typing import NDArray

from core.errors import InputError, unknown
from scenarios.arrow import csv, pa, pq
from scenarios.report.matlab import variables
from scenarios.report.traces import packing
from server.store.mcap_trace import write_mcap

LARGEST = 2**62
NAMES = "names"
"""Structure of a MAT file with the name of the signal in each variable."""
Format = Literal["csv", "parquet", "npz", "mat", "mcap"]

MEDIA_TYPES: dict[str, str] = {
    "csv": "text/csv; charset=utf-8",
    "parquet": "application/vnd.apache.parquet",
    "npz": "application/octet-stream",
    "mat": "application/octet-stream",
    "mcap": "application/octet-stream",
}


def table_of(schema: pa.Schema, first_tick: int, dt_ms: float, samples: NDArray[np.floating[Any]]) -> pa.Table:
    """Build a table from samples ``(n_signals, ticks)``."""
    ticks = np.arange(first_tick, first_tick + samples.shape[1], dtype=np.int64)
    columns = [pa.array(ticks), pa.array(ticks * dt_ms)]
    columns += [pa.array(np.ascontiguousarray(row, np.float32)) for row in samples]
    return pa.Table.from_arrays(columns, schema=schema)


@dataclass(frozen=True)
class Cut:
    """A part of a trace: requested signals (all when empty), ticks from start to before end, every n-th tick."""

    signals: tuple[str, ...] = ()
    start: int | None = None
    end: int | None = None
    every: int = 1

    @property
    def is_all(self) -> bool:
        """Whether the part is the whole trace."""
        return self == Cut()


def read_cut(path: Path, cut: Cut, most: int) -> pa.Table:
    """Read a part of a stored trace, piece by piece, so that a long one fits as well.

    Parameters
    ----------
    path : Path
        A Parquet file with a column ``tick``.
    cut : Cut
        The part.
    most : int
        Ticks it may have.

    Raises
    ------
    InputError
        For a signal that is not in it, or when nothing or too much is left.
    """
    file = pq.ParquetFile(path)
    known = file.schema_arrow.names
    signals = asked(cut.signals, known)
    for name in signals:
        if name not in known[2:]:
            raise unknown("signal", name, known[2:], "signals")
    columns = [*known[:2], *signals] if signals else known
    start, end = cut.start if cut.start is not None else -LARGEST, cut.end if cut.end is not None else LARGEST
    pieces, count, first = [], 0, None
    for batch in file.iter_batches(columns=columns):
        tick = batch.column(0).to_numpy()
        inside = (tick >= start) & (tick < end)
        if first is None and inside.any():
            first = tick[inside.argmax()]
        if first is not None:
            inside &= (tick - first) % cut.every == 0
        piece = batch.filter(pa.array(inside))
        count += piece.num_rows
        if count > most:
            text = f"more than {most} ticks (max_trace_ticks)"
            raise InputError(
                text, "end_tick", "a shorter span, every so many ticks, or all of it as parquet", "too_long"
            )
        pieces.append(piece)
    if not count:
        raise InputError("the trace has no tick in that span", "start_tick")
    schema = pa.schema([file.schema_arrow.field(name) for name in columns], metadata=file.schema_arrow.metadata)
    return pa.Table.from_batches(pieces).cast(schema)


def write(table: pa.Table, file: BinaryIO, kind: Format) -> None:
    """Write a table into an open file."""
    if kind == "parquet":
        pq.write_table(table, file, **packing(table.schema))
        return
    if kind == "csv":
        csv.write_csv(table, file)
        return
    if kind == "mcap":
        write_mcap(table, file)
        return
    arrays = {name: table.column(name).to_numpy() for name in table.column_names}
    if kind == "npz":
        np.savez_compressed(file, **arrays)
        return
    from scipy.io import savemat  # loads half of scipy

    own = variables(list(arrays), taken=[NAMES])
    named: dict[str, Any] = {own[name]: array for name, array in arrays.items()}
    named[NAMES] = {variable: name for name, variable in own.items()}
    savemat(cast(Any, file), named, oned_as="column", long_field_names=True)


def asked(given: Iterable[str], known: Collection[str]) -> tuple[str, ...]:
    """Return the requested names, each once: a text is a known name, or names between commas."""
    parts = ([text] if text in known else text.split(",") for text in given)
    return tuple(dict.fromkeys(name.strip() for part in parts for name in part if name.strip()))
