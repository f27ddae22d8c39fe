"""Traces as downloads: made in a file without a name, one at a time, gone when sent."""

from __future__ import annotations

import asyncio
import io
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

import pyarrow as pa
import pyarrow.parquet as pq
from fastapi.responses import FileResponse, Response, StreamingResponse

from server.errors import ApiError
from server.service import Service
from server.store.traces import MEDIA_TYPES, Format, write

FORMAT_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {"content": {media: {} for media in MEDIA_TYPES.values()}, "description": "The trace as a file"}
}

PIECE = 1 << 16


def file_name(name: str, kind: Format) -> str:
    """Make a harmless file name."""
    return (re.sub(r"[^A-Za-z0-9._-]+", "-", name).strip("-.") or "trace") + f".{kind}"


async def table_response(service: Service, table: pa.Table, name: str, kind: Format) -> StreamingResponse:
    """Send a table in the format asked for."""
    file = tempfile.TemporaryFile(prefix="combbench-")
    try:
        async with service.file_turn:
            await asyncio.to_thread(write, table, file, kind)
        size = file.seek(0, io.SEEK_END)
        file.seek(0)
    except BaseException:
        file.close()
        raise
    headers = {
        "Content-Disposition": f'attachment; filename="{file_name(name, kind)}"',
        "Content-Length": str(size),
    }
    return StreamingResponse(_pieces(file), media_type=MEDIA_TYPES[kind], headers=headers)


def _pieces(file: BinaryIO) -> Iterator[bytes]:
    """Read a file to its end and close it."""
    with file:
        while piece := file.read(PIECE):
            yield piece


async def stored_trace(service: Service, path: Path, name: str, kind: Format) -> Response:
    """Send a stored Parquet file as it is, or converted if it is not too long for that."""
    if kind == "parquet":
        return FileResponse(path, media_type=MEDIA_TYPES[kind], filename=file_name(name, kind))
    most = service.settings.max_trace_ticks
    ticks = await asyncio.to_thread(lambda: pq.read_metadata(path).num_rows)
    if ticks > most:
        raise ApiError(
            422,
            "too_long",
            f"{ticks} ticks are too many for {kind} ({most} at most)",
            "format",
            "take parquet",
        )
    return await table_response(service, await asyncio.to_thread(pq.read_table, path), name, kind)
