"""The instruments of a server: it listens for them, knows their names, and opens benches on them."""

from __future__ import annotations

import asyncio
import logging
import shutil
from ipaddress import ip_address, ip_network
from typing import Any

from core.errors import InputError
from scenarios.records.bench import on_record
from scenarios.records.line import LineHeader
from scenarios.records.live import LiveRecord
from scenarios.records.shelf import RecordFolder
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.engine import Engine
from server.bench.instrument import live_record
from server.clock import Clock
from server.errors import not_found
from server.instruments.reader import InstrumentReader
from server.instruments.source import Source
from server.settings import Settings

log = logging.getLogger(__name__)

MOST_READERS = 16
"""Connections at once."""
MOST_SOURCES = 64
"""Names that are remembered; of more, a source that is gone is forgotten."""
LOOK_S = 1.0
"""Between two looks at slow connections, at records without a bench, and at the disk."""


class Instruments:
    """Listens where the settings say so, and nowhere else; on the event loop.

    Parameters
    ----------
    settings : Settings
        Address, port, and the addresses that may connect.
    benches : Benches
        The live benches.
    engine : Engine
        Whose thread may change a bench.
    """

    def __init__(self, settings: Settings, benches: Benches, engine: Engine) -> None:
        self._settings, self._benches, self._engine = settings, benches, engine
        self._peers = [ip_network(one) for one in settings.instrument_peers]
        self._sources: dict[str, Source] = {}
        self._readers: dict[InstrumentReader, asyncio.Task[None]] = {}
        self._server: asyncio.Server | None = None
        self.listens = ""
        """Address and port on which it listens; empty: it does not."""

    async def start(self) -> None:
        """Listen, if a port is set; the server runs without instruments where it cannot."""
        port, host = self._settings.instrument_port, self._settings.instrument_host
        if port is None:
            return
        try:
            self._server = await asyncio.start_server(self._connected, host, port)
        except OSError as error:
            log.error("instruments cannot connect: %s port %d: %s", host, port, error.strerror or error)
            return
        self.listens = "{}:{}".format(*self._server.sockets[0].getsockname()[:2])
        log.info("instruments may connect to %s", self.listens)

    async def close(self) -> None:
        """Listen no longer, and end all connections and records."""
        if self._server is not None:
            self._server.close()
        for reader in self._readers:
            reader.close("the server is stopping")
        await asyncio.gather(*self._readers.values(), return_exceptions=True)
        for source in self._sources.values():
            for record in list(source.records):
                source.end(record, "the server was stopped")

    async def run(self, clock: Clock) -> None:
        """Look again and again at slow connections, at records that no bench plays, and at the disk."""
        async for _ in clock.every(LOOK_S):
            for reader in list(self._readers):
                reader.look()
            for source in self._sources.values():
                for record in list(source.records):
                    if why := self._why_to_end(record):
                        source.end(record, why)

    def all(self) -> list[Source]:
        """List the sources that have connected since the server was started, by name."""
        return [self._sources[name] for name in sorted(self._sources)]

    def get(self, name: str) -> Source:
        """Return a source, or refuse with 404."""
        source = self._sources.get(name)
        if source is None:
            hint = "no instrument with this name has connected" if self.listens else "set instrument_port"
            raise not_found("instrument", name, hint, "name", self._sources)
        return source

    async def open(
        self, source: Source, scenario: Scenario, noise_um: float | None, values: dict[str, Any], paused: bool
    ) -> LiveBench:
        """Make a bench that plays a source from its next block on, with the identifiers and diagnosers of a scenario.

        Raises
        ------
        InputError
            If the scenario has no place for a record, or a value is wrong.
        ApiError
            If there are too many benches.
        """
        record = await asyncio.to_thread(LiveRecord.begin, RecordFolder().path, source.header)
        try:
            document = on_record(scenario, record, noise_um)
            document |= {
                "id": f"live-{source.name.lower().replace('.', '-').replace('_', '-')}",
                "title": f"{source.name}, live, on the bench of {scenario.id}",
            }
            await self._benches.check(document, values)
            session = await self._benches.create(document, values, None, paused, None)
        except BaseException:
            record.remove()
            raise
        session.keep = True
        record.is_connected = source.connection is not None
        source.records.append(record)
        return session

    async def _connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Read a connection to its end."""
        line = InstrumentReader(reader, writer, self._enter, self._engine.clock)
        host = line.address.rpartition(":")[0]
        if not self._may_connect(host):
            line.close(f"{host} may not connect (instrument_peers)")
            log.warning("%s tried to connect as an instrument; allowed: instrument_peers", host)
            return
        if len(self._readers) >= MOST_READERS:
            line.close(f"{MOST_READERS} instruments are connected already")
            return
        task = asyncio.current_task()
        assert task is not None
        self._readers[line] = task
        try:
            if why := await line.run():
                log.warning("the instrument at %s was refused: %s", line.address, why)
        finally:
            del self._readers[line]

    def _may_connect(self, host: str) -> bool:
        try:
            return any(ip_address(host) in one for one in self._peers)
        except ValueError:
            return False

    def _enter(self, line: InstrumentReader, header: LineHeader, address: str) -> Source:
        """Give a connection to its source, a new one if its name is new."""
        source = self._sources.get(header.source)
        if source is None:
            if len(self._sources) >= MOST_SOURCES:
                gone = next((one for one in self._sources.values() if one.connection is None and not one.records), None)
                if gone is None:
                    raise InputError(f"{MOST_SOURCES} sources are known already", "header.source", code="limit")
                del self._sources[gone.name]
            source = Source(header, self._engine.clock, self._settings.instrument_samples, self._tell)
            self._sources[header.source] = source
        source.enter(line, header, address)
        return source

    def _tell(self, record: LiveRecord, text: str) -> None:
        """Note a sentence on the benches that play a record."""
        for session in self._playing(record):
            self._engine.submit(_note, session, text)

    def _playing(self, record: LiveRecord) -> list[LiveBench]:
        return [session for session in self._benches.all() if live_record(session.board) is record]

    def _why_to_end(self, record: LiveRecord) -> str:
        if not self._playing(record):
            return "no bench plays it"
        least, free = self._settings.disk_reserve_bytes, shutil.disk_usage(record.path.parent).free
        return f"the disk has less than {least} bytes free" if free < least else ""


def _note(session: LiveBench, text: str) -> None:
    """Note a sentence on a bench, and show it (a job)."""
    session.note("instrument", "instrument", text)
    session.refresh_status()
