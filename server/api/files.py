"""Traces as downloads: written to an unnamed file, one at a time, deleted when sent."""

from __future__ import annotations

import asyncio
import errno
import io
import os
import re
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any, BinaryIO, cast

from fastapi import Depends, Query
from fastapi.responses import FileResponse, Response, StreamingResponse
from pydantic import Field

from scenarios.arrow import pa
from server.service import Service
from server.store.traces import MEDIA_TYPES, Cut, Format, read_cut, write

FILES: dict[str, dict[str, Any]] = {media.partition(";")[0]: {} for media in reversed(MEDIA_TYPES.values())}
"""Contents of an answer in the requested format; bytes first, for clients that read all formats alike."""
FORMAT_RESPONSES: dict[int | str, dict[str, Any]] = {200: {"content": FILES, "description": "The trace as a file"}}

PIECE = 1 << 16
HTML, PYTHON, SVG = "text/html", "text/x-python", "image/svg+xml"


def file_name(name: str, kind: str) -> str:
    """Make a harmless file name."""
    return (re.sub(r"[^A-Za-z0-9._-]+", "-", name).strip("-.") or "trace") + f".{kind}"


async def table_response(service: Service, table: pa.Table, name: str, kind: Format) -> StreamingResponse:
    """Send a table in the requested format."""
    return await written_response(service, lambda file: write(table, file, kind), name, kind)


async def written_response(
    service: Service, put: Callable[[BinaryIO], None], name: str, kind: Format
) -> StreamingResponse:
    """Send the content that a function writes into a file."""
    try:
        file = tempfile.TemporaryFile(prefix="combbench-")
    except FileNotFoundError as error:  # Python raises this if no temporary folder has room
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)) from error
    try:
        async with service.file_turn:
            await asyncio.to_thread(put, cast(BinaryIO, file))
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


Tick = Annotated[int | None, Query(ge=-(2**53), le=2**53)]
Signals = Annotated[
    Sequence[Annotated[str, Field(max_length=8000)]],
    Query(max_length=1000, description="Names of signals, repeated or separated by commas; left out: all signals"),
]


def get_cut(
    signals: Signals = (),
    start_tick: Tick = None,
    end_tick: Annotated[int | None, Query(ge=-(2**53), le=2**53, description="The tick after the last")] = None,
    every: Annotated[int, Query(ge=1, le=1_000_000, description="Keep one tick of every so many")] = 1,
) -> Cut:
    """Read from the query which part of a trace is wanted."""
    return Cut(tuple(name for name in signals if name.strip()), start_tick, end_tick, every)


CutDep = Annotated[Cut, Depends(get_cut)]


async def stored_trace(service: Service, path: Path, name: str, kind: Format, cut: Cut) -> Response:
    """Send a stored Parquet file as it is, or a part or conversion of it if that is not too long."""
    if kind == "parquet" and cut.is_all:
        return FileResponse(path, media_type=MEDIA_TYPES[kind], filename=file_name(name, kind))
    table = await asyncio.to_thread(read_cut, path, cut, service.settings.max_trace_ticks)
    return await table_response(service, table, name, kind)


def report_response(text: str, name: str) -> Response:
    """Send a report: shown under a policy that allows its own style and nothing else."""
    headers = {
        "Content-Security-Policy": "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'self'",
        "Content-Disposition": f'inline; filename="{file_name(name, "html")}"',
    }
    return Response(text, media_type=HTML, headers=headers)
