"""Files on disk: written under a temporary name, then renamed, so that every file there is complete."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.board.rows import Rows
from core.signals import CLOCK, Signal
from scenarios.arrow import pa, pq

PIECE_TICKS = 1 << 15


def schema_of(
    signals: Mapping[str, str], about: Mapping[str, Any], number: Literal["float32", "float64"] = "float64"
) -> pa.Schema:
    """Describe the table of a trace: tick, time, one column per signal with its unit.

    Parameters
    ----------
    signals : mapping
        Name to unit.
    about : mapping
        Kept with the file: scenario, seed, version.
    number : str
        Type of the samples.
    """
    fields = [pa.field(name, kind) for name, kind in zip(CLOCK, (pa.int64(), pa.float64()), strict=True)]
    fields += [pa.field(name, number, metadata={"unit": unit}) for name, unit in signals.items()]
    return pa.schema(fields, metadata={"combbench": json.dumps(about, default=str)})


def packing(schema: pa.Schema) -> dict[str, Any]:
    """Say how Parquet is to pack a trace.

    A dictionary makes noise larger; sorting the bytes of its numbers by their place makes it smaller.
    """
    floats = [field.name for field in schema if pa.types.is_floating(field.type)]
    return {"use_dictionary": False, "use_byte_stream_split": floats, "compression": "zstd"}


class TraceFile:
    """The trace of a run as Parquet, written piece by piece while it runs; a context that renames it at the end.

    Parameters
    ----------
    path : Path
        The file; its folder is created when the run begins.
    scenario : dict
        The document of the scenario, kept as metadata under ``combbench`` with the seed.
    """

    def __init__(self, path: Path, scenario: dict[str, Any]) -> None:
        self._path, self._scenario = path, scenario
        self._part = path.with_name(path.name + ".part")
        self._writer: pq.ParquetWriter | None = None
        self._rows: list[FloatArray] = []
        self._tick = 0

    def begin(self, board: Board, signals: list[Signal]) -> None:
        """Open the file."""
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._dt_ms, split = board.dt_ms, board.signals.outputs
        self._outputs = [signal.index for signal in signals if signal.kind == "output"]
        self._taps = [signal.index - split for signal in signals if signal.kind == "tap"]
        about = {"scenario": self._scenario, "seed": board.spec.seed}
        self._schema = schema_of({signal.name: signal.unit for signal in signals}, about)
        self._writer = pq.ParquetWriter(self._part, self._schema, **packing(self._schema))

    def add(self, rows: Rows) -> None:
        """Take rows, and write a piece when there are enough."""
        self._rows.append(np.hstack([rows.outputs[:, self._outputs], rows.taps[:, self._taps]]))
        if sum(map(len, self._rows)) >= PIECE_TICKS:
            self._write()

    def _write(self) -> None:
        assert self._writer is not None
        samples = np.vstack(self._rows) if self._rows else np.empty((0, len(self._outputs) + len(self._taps)))
        ticks = np.arange(self._tick, self._tick + len(samples))
        columns = [ticks, ticks * self._dt_ms, *np.ascontiguousarray(samples.T)]
        self._writer.write_table(pa.table(columns, schema=self._schema))
        self._rows, self._tick = [], self._tick + len(samples)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if self._writer is None:
            return
        try:
            if kind is None and (self._rows or not self._tick):
                self._write()
            self._writer.close()
            if kind is None:
                os.replace(self._part, self._path)
        finally:
            self._part.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a text."""
    temporary = path.with_name(path.name + ".part")
    temporary.write_text(text, "utf-8")
    os.replace(temporary, path)


def write_json(path: Path, document: Any) -> None:
    """Write a JSON document."""
    write_text(path, json.dumps(document, indent=2, allow_nan=False) + "\n")
