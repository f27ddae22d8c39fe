"""Traces as MCAP, for Foxglove, PlotJuggler and others: a channel for each block, messages as JSON with a schema."""

from __future__ import annotations

import json
import math
from typing import Any, BinaryIO

from core.signals import CLOCK
from scenarios.arrow import pa
from scenarios.extras import require

PIECE = 4096
"""Ticks that are Python objects at a time."""
NS_PER_MS = 1_000_000


def write_mcap(table: pa.Table, file: BinaryIO) -> None:
    """Write a table with ticks and times; a number that is not finite becomes null.

    Raises
    ------
    InputError
        When the package is not installed.
    """
    require("mcap", "files", "format")
    from mcap.writer import CompressionType, Writer

    writer = Writer(file, compression=CompressionType.ZSTD)
    writer.start(profile="", library="combbench")
    blocks: dict[str, list[str]] = {}
    for name in table.column_names:
        if name not in CLOCK:
            blocks.setdefault(name.partition(".")[0], []).append(name)
    channels = {}
    for block, names in blocks.items():
        schema = json.dumps(message_schema(table.schema, block, names)).encode()
        number = writer.register_schema(f"combbench.{block}", "jsonschema", schema)
        channels[block] = writer.register_channel(f"/{block}", "json", number)
    row = 0
    for batch in table.to_batches(PIECE):
        columns = batch.to_pydict()
        for i, (tick, time_ms) in enumerate(zip(columns["tick"], columns["time_ms"], strict=True)):
            at = round(time_ms * NS_PER_MS)
            for block, names in blocks.items():
                message = {"tick": tick, "time_ms": time_ms}
                message |= {_port(name): _finite(columns[name][i]) for name in names}
                writer.add_message(channels[block], max(at, 0), json.dumps(message).encode(), max(at, 0), row)
            row += 1
    writer.finish()  # type: ignore[no-untyped-call]


def message_schema(schema: pa.Schema, block: str, names: list[str]) -> dict[str, Any]:
    """Return the JSON Schema of the messages of a block, with the unit of each number."""
    clock = {"tick": {"type": "integer"}, "time_ms": {"type": "number", "unit": "ms"}}
    ports = {}
    for name in names:
        unit = (schema.field(name).metadata or {}).get(b"unit", b"").decode()
        ports[_port(name)] = {"type": ["number", "null"], "unit": unit, "description": f"{name}, {unit}"}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"combbench.{block}",
        "type": "object",
        "properties": clock | ports,
        "required": [*clock, *ports],
        "additionalProperties": False,
    }


def _port(name: str) -> str:
    """Return the name of a signal within its block."""
    return name.partition(".")[2] or name


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
