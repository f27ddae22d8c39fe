"""The file of a recording: a stream while it grows, a Parquet file at the end.

Rows go to an Arrow stream first, which is readable up to its last whole batch even after a power cut; at the
end it is rewritten as Parquet. A stream left by a crash is recovered at the next start.
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from core.errors import InputError
from scenarios.arrow import pa, pq
from scenarios.report.traces import packing

PART, EVENTS = ".arrows", ".events"
GROUP_TICKS = 1 << 15
"""Ticks in a row group of the Parquet file: a small group takes more space for its description than for its data."""


class RecordingFile:
    """Appends tables to a growing stream.

    Parameters
    ----------
    path : Path
        The Parquet file it will become.
    schema : pa.Schema
        Columns.
    reserve_bytes : int
        Free space that recordings must leave.
    """

    def __init__(self, path: Path, schema: pa.Schema, reserve_bytes: int = 0) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        self._path, self._reserve_bytes = path, reserve_bytes
        self._sink = path.with_suffix(PART).open("wb")
        self._stream = pa.ipc.new_stream(self._sink, schema)

    def append(self, table: pa.Table) -> None:
        """Write a batch; it survives a crash from here on.

        Raises
        ------
        OSError
            When the disk is full, or will be with the additional Parquet file.
        """
        free = free_bytes(self._path.parent)
        if free < self._reserve_bytes + self._sink.tell():
            raise OSError(errno.ENOSPC, f"only {free / 1e6:.0f} MB are free")
        self._stream.write_table(table)
        self._sink.flush()

    def note(self, line: str) -> None:
        """Write an event, a line of JSON; it survives a crash from here on."""
        with self._path.with_suffix(EVENTS).open("a", encoding="utf-8") as file:
            file.write(line + "\n")

    def finish(self) -> int:
        """Close the stream, turn it into Parquet, return the number of ticks."""
        self._stream.close()
        self._sink.close()
        return convert(self._path)

    def discard(self) -> None:
        """Close a stream that nothing has come to, and leave no file."""
        self._sink.close()
        self._path.with_suffix(PART).unlink(missing_ok=True)

    def salvage(self) -> int:
        """Close a stream that cannot be written any more; keep the batches that have reached the disk."""
        with contextlib.suppress(OSError):
            self._sink.close()
        try:
            return convert(self._path)
        except (OSError, pa.ArrowException):
            return 0


def free_bytes(folder: Path) -> int:
    """Return the free space of the disk that holds a folder, or would hold it."""
    while not folder.exists():
        folder = folder.parent
    return shutil.disk_usage(folder).free


def rescue(path: Path) -> int:
    """Complete the file of a recording after a crash; return the ticks of its Parquet file, 0 without one."""
    try:
        if path.with_suffix(PART).exists():
            return convert(path)
        return int(pq.read_metadata(path).num_rows)
    except pa.ArrowInvalid:  # the header has not reached the disk
        path.with_suffix(PART).unlink(missing_ok=True)
        return 0
    except (OSError, pa.ArrowException):
        return 0


def is_readable(path: Path) -> bool:
    """Return whether a file exists and its footer can be read."""
    try:
        pq.read_metadata(path)
    except (OSError, pa.ArrowException):
        return False
    return True


def first_tick(path: Path) -> int:
    """Return the first tick of a recording.

    Raises
    ------
    InputError
        When it has none.
    """
    for batch in pq.ParquetFile(path).iter_batches(1, columns=["tick"]):
        return int(batch.column(0)[0].as_py())
    raise InputError("is empty", "recording")


def events_of(path: Path) -> list[dict[str, Any]]:
    """Return the events in the file next to a recording; a line that was cut off is left out."""
    try:
        lines = path.with_suffix(EVENTS).read_text("utf-8", errors="replace").splitlines(keepends=True)
    except OSError:
        return []
    return [json.loads(line) for line in lines if line.endswith("\n")]


def convert(path: Path) -> int:
    """Rewrite the stream file of ``path`` as Parquet; return the number of ticks."""
    source, part = path.with_suffix(PART), path.with_name(path.name + ".part")
    ticks = 0
    with source.open("rb") as file:
        reader = pa.ipc.open_stream(file)
        with pq.ParquetWriter(part, reader.schema, **packing(reader.schema)) as writer:
            held: list[pa.RecordBatch] = []
            for batch in _whole_batches(reader):
                held.append(batch)
                ticks += batch.num_rows
                if sum(held_batch.num_rows for held_batch in held) >= GROUP_TICKS:
                    writer.write_table(pa.Table.from_batches(held))
                    held = []
            if held:
                writer.write_table(pa.Table.from_batches(held))
    with part.open("rb") as file:
        os.fsync(file.fileno())
    part.rename(path)
    source.unlink()
    return ticks


def _whole_batches(reader: pa.RecordBatchStreamReader) -> Iterator[pa.RecordBatch]:
    """Yield batches until the end, or until an incomplete batch."""
    while True:
        try:
            yield reader.read_next_batch()
        except (StopIteration, pa.ArrowInvalid, OSError):
            return
