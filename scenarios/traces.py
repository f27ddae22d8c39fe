"""Traces on disk: written to a temporary name, then renamed, so that what is there is whole."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

if TYPE_CHECKING:
    from scenarios.run import Result


def write_parquet(path: Path, columns: dict[str, np.ndarray[Any, Any]], metadata: dict[str, Any]) -> None:
    """Write columns of one length with metadata under ``combbench``."""
    table = pa.table({name: pa.array(np.ascontiguousarray(values)) for name, values in columns.items()})
    table = table.replace_schema_metadata({"combbench": json.dumps(metadata)})
    temporary = path.with_name(path.name + ".part")
    pq.write_table(table, temporary, compression="zstd")
    os.replace(temporary, path)


def write_json(path: Path, document: Any) -> None:
    """Write a JSON document."""
    temporary = path.with_name(path.name + ".part")
    temporary.write_text(json.dumps(document, indent=2, allow_nan=False) + "\n", "utf-8")
    os.replace(temporary, path)


def write_result(result: Result, folder: Path) -> Path:
    """Write trace and summary of a run into ``folder`` and return the stem of both files."""
    folder.mkdir(parents=True, exist_ok=True)
    stem = folder / f"{result.scenario.id}-seed{result.seed}"
    ticks = np.arange(result.board.tick)
    columns: dict[str, np.ndarray[Any, Any]] = {"tick": ticks, "time_ms": ticks * result.board.dt_ms}
    for signal in result.board.signals:
        if signal.kind == "output" or result.taps is not None:
            columns[signal.name] = result.signal(signal.name)
    summary = result.summary()
    write_parquet(stem.with_suffix(".parquet"), columns, {"scenario": result.scenario.document, "seed": result.seed})
    write_json(stem.with_suffix(".json"), summary)
    return stem
