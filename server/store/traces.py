"""Traces as files: Parquet, CSV, NPZ, MAT."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, BinaryIO, Literal, cast

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq
from numpy.typing import NDArray

Format = Literal["csv", "parquet", "npz", "mat"]

MEDIA_TYPES: dict[str, str] = {
    "csv": "text/csv; charset=utf-8",
    "parquet": "application/vnd.apache.parquet",
    "npz": "application/octet-stream",
    "mat": "application/octet-stream",
}


def schema_of(signals: Mapping[str, str], about: Mapping[str, Any]) -> pa.Schema:
    """Describe a trace table: tick, time, one column per signal with its unit.

    Parameters
    ----------
    signals : mapping
        Name to unit.
    about : mapping
        Kept with the file: scenario, version, sample interval.
    """
    fields = [pa.field("tick", pa.int64()), pa.field("time_ms", pa.float64())]
    fields += [pa.field(name, pa.float32(), metadata={"unit": unit}) for name, unit in signals.items()]
    return pa.schema(fields, metadata={"combbench": json.dumps(about)})


def table_of(schema: pa.Schema, first_tick: int, dt_ms: float, samples: NDArray[np.floating[Any]]) -> pa.Table:
    """Build a table from samples ``(n_signals, ticks)``."""
    ticks = np.arange(first_tick, first_tick + samples.shape[1], dtype=np.int64)
    columns = [pa.array(ticks), pa.array(ticks * dt_ms)]
    columns += [pa.array(np.ascontiguousarray(row, np.float32)) for row in samples]
    return pa.Table.from_arrays(columns, schema=schema)


def write(table: pa.Table, file: BinaryIO, kind: Format) -> None:
    """Write a table into an open file."""
    if kind == "parquet":
        pq.write_table(table, file, compression="zstd")
        return
    if kind == "csv":
        pyarrow.csv.write_csv(table, file)
        return
    arrays = {name: table.column(name).to_numpy() for name in table.column_names}
    if kind == "npz":
        np.savez_compressed(file, **arrays)
        return
    from scipy.io import savemat  # loads half of scipy

    # MATLAB knows no dots in a name.
    named = {name.replace(".", "_"): array for name, array in arrays.items()}
    savemat(cast(Any, file), named, oned_as="column")
