"""Traces as downloads: made in a temporary file, one at a time, gone when sent."""

from __future__ import annotations

import asyncio
import re
import tempfile
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
from fastapi.responses import FileResponse
from starlette.background import BackgroundTask

from server.errors import ApiError
from server.store.traces import MEDIA_TYPES, Format, write

FORMAT_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {"content": {media: {} for media in MEDIA_TYPES.values()}, "description": "The trace as a file"}
}

_one_at_a_time = asyncio.Semaphore(1)


def file_name(name: str, kind: Format) -> str:
    """Make a harmless file name."""
    return (re.sub(r"[^A-Za-z0-9._-]+", "-", name).strip("-.") or "trace") + f".{kind}"


async def table_response(table: pa.Table, name: str, kind: Format) -> FileResponse:
    """Send a table in the format asked for."""
    async with _one_at_a_time:
        path = await asyncio.to_thread(_temporary, table, kind)
    return FileResponse(
        path,
        media_type=MEDIA_TYPES[kind],
        filename=file_name(name, kind),
        background=BackgroundTask(path.unlink, missing_ok=True),
    )


async def stored_trace(path: Path, name: str, kind: Format, most: int) -> FileResponse:
    """Send a stored Parquet file as it is, or converted if it is not too long for that."""
    if kind == "parquet":
        return FileResponse(path, media_type=MEDIA_TYPES[kind], filename=file_name(name, kind))
    ticks = await asyncio.to_thread(lambda: pq.read_metadata(path).num_rows)
    if ticks > most:
        raise ApiError(
            422,
            "too_long",
            f"{ticks} ticks are too many for {kind} ({most} at most)",
            "format",
            "take parquet",
        )
    return await table_response(await asyncio.to_thread(pq.read_table, path), name, kind)


def _temporary(table: pa.Table, kind: Format) -> Path:
    """Write a table to a temporary file."""
    handle, name = tempfile.mkstemp(prefix="combbench-", suffix=f".{kind}")
    path = Path(name)
    try:
        open(handle, "wb").close()
        write(table, path, kind)
    except BaseException:
        path.unlink(missing_ok=True)
        raise
    return path
