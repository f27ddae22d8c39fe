"""Files on disk: written under a temporary name, then renamed, so that every file there is complete."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

PIECE_TICKS = 1 << 15


def packing(schema: pa.Schema) -> dict[str, Any]:
    """Say how Parquet is to pack a trace.

    A dictionary makes noise larger; sorting the bytes of its numbers by their place makes it smaller.
    """
    floats = [field.name for field in schema if pa.types.is_floating(field.type)]
    return {"use_dictionary": False, "use_byte_stream_split": floats, "compression": "zstd"}


def write_parquet(
    path: Path, columns: dict[str, np.ndarray[Any, Any]], metadata: dict[str, Any], units: dict[str, str]
) -> None:
    """Write columns of one length with metadata under ``combbench``, piece by piece: no trace is in memory twice."""
    fields = [
        pa.field(name, pa.from_numpy_dtype(values.dtype), metadata={"unit": units[name]} if name in units else None)
        for name, values in columns.items()
    ]
    schema = pa.schema(fields, metadata={"combbench": json.dumps(metadata)})
    temporary = path.with_name(path.name + ".part")
    length = max((len(values) for values in columns.values()), default=0)
    with pq.ParquetWriter(temporary, schema, **packing(schema)) as writer:
        for start in range(0, max(length, 1), PIECE_TICKS):
            pieces = [np.ascontiguousarray(values[start : start + PIECE_TICKS]) for values in columns.values()]
            writer.write_table(pa.table(pieces, schema=schema))
    os.replace(temporary, path)


def write_text(path: Path, text: str) -> None:
    """Write a text."""
    temporary = path.with_name(path.name + ".part")
    temporary.write_text(text, "utf-8")
    os.replace(temporary, path)


def write_json(path: Path, document: Any) -> None:
    """Write a JSON document."""
    write_text(path, json.dumps(document, indent=2, allow_nan=False) + "\n")
