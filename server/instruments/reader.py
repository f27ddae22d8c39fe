"""One connection of an instrument: it is read block by block, and refused in one line."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable

from core.errors import InputError
from scenarios.records.line import HEAD, MOST_HEADER, PAIR, LineHeader, read_head, read_header, read_pairs
from server.instruments.source import Source

PATIENCE_S = 10.0
"""Longest time for the header, and for a block from its first byte on."""


class InstrumentReader:
    """Reads a connection, one block at a time.

    Parameters
    ----------
    reader, writer
        The connection.
    enter : callable
        Called with itself, the header and the address; returns the source, or refuses.
    clock : callable
        Seconds.
    """

    def __init__(
        self,
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
        enter: Callable[[InstrumentReader, LineHeader, str], Source],
        clock: Callable[[], float],
    ) -> None:
        self._reader, self._writer, self._enter, self._clock = reader, writer, enter, clock
        self._waits_since: float | None = clock()
        self._awaited = "the header"
        self._late = ""
        self.address = "{}:{}".format(*writer.get_extra_info("peername", ("unknown", 0))[:2])

    async def run(self) -> str:
        """Read to the end; return why it was refused, or nothing."""
        source, why, is_refusal = None, "its connection has ended", False
        try:
            header = await self._header()
            source = self._enter(self, header, self.address)
            self._writer.write(b'{"ok": true}\n')
            while await self._block(source, header):
                pass
        except InputError as error:
            why, is_refusal = str(error), True
        except asyncio.IncompleteReadError as error:
            is_refusal = bool(self._late or self._waits_since is not None)
            why = self._late or f"its connection has ended in {self._awaited}, after {len(error.partial)} bytes"
        except OSError as error:
            why = f"its connection has failed: {error.strerror or error}"
        finally:
            if source is not None:
                source.leave(self, why, is_refusal=is_refusal)
            self.close(why if is_refusal else "")
        return why if is_refusal else ""

    def look(self) -> None:
        """Refuse an instrument that is too slow."""
        if self._waits_since is not None and self._clock() - self._waits_since >= PATIENCE_S and not self._late:
            self._late = f"{self._awaited} did not come whole within {PATIENCE_S:g} s"
            self.close(self._late)

    def close(self, why: str) -> None:
        """Close, after a line that says why."""
        if self._writer.is_closing():
            return
        if why:
            self._writer.write(json.dumps({"error": why}).encode() + b"\n")
        self._writer.close()

    async def _header(self) -> LineHeader:
        try:
            line = await self._reader.readuntil(b"\n")
        except asyncio.LimitOverrunError:
            line = bytes(MOST_HEADER + 1)
        if len(line) > MOST_HEADER:
            raise InputError(f"is longer than {MOST_HEADER} bytes", "header", "begin with one line of JSON")
        header = read_header(line)
        self._waits_since = None
        return header

    async def _block(self, source: Source, header: LineHeader) -> bool:
        """Read a block; false where the connection ends between two blocks."""
        first = await self._reader.read(1)
        if not first:
            return False
        self._waits_since, self._awaited = self._clock(), f"the block after {source.order.blocks} blocks"
        head = read_head(first + await self._reader.readexactly(HEAD.size - 1))
        self._awaited = f"block {head.number}"
        content = await self._reader.readexactly(PAIR * head.samples)
        self._waits_since = None
        if source.connection is not self:
            return False
        await source.take(head, read_pairs(head, content, header.factors))
        return True
