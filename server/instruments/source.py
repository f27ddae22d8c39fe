"""A source: an instrument by its name, the connection by which it sends, and the records that grow from it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, Field

from core.errors import InputError
from scenarios.records.arrivals import Arrivals
from scenarios.records.line import BlockHead, LineHeader
from scenarios.records.live import LiveRecord
from scenarios.records.order import BlockOrder

if TYPE_CHECKING:
    from server.instruments.reader import InstrumentReader

SILENT_S = 5.0
"""Time without a block after which another connection may take the place of the first."""


class SourceStatus(BaseModel):
    """A source of samples."""

    name: str
    address: str = Field(description="Address and port from which it sends, or sent last")
    is_connected: bool
    names: list[str] = Field(description="Its names of drive and displacement")
    units: list[str]
    rate_khz: float = Field(description="Samples for each ms that it promises")
    received_khz: float = Field(description="Samples for each ms that came lately")
    blocks: int
    lost_blocks: int = Field(description="Numbers that were left out")
    late_blocks: int = Field(description="Blocks that came after a later one; they are left out")
    doubled_blocks: int = Field(description="Blocks that came twice; they are left out")
    lost_samples: int
    breaks: int = Field(description="Gaps whose length is not known, or above 10 s")
    records: int = Field(description="Records that grow from it now")
    refused: str = Field(description="Why its last connection was refused; empty: it was not")


class Source:
    """An instrument by its name.

    Parameters
    ----------
    header : LineHeader
        Its first header.
    clock : callable
        The clock of the engine, s.
    most_samples : int
        The longest record.
    tell : callable
        Called with a record and a sentence for the benches that play it.
    """

    def __init__(
        self,
        header: LineHeader,
        clock: Callable[[], float],
        most_samples: int,
        tell: Callable[[LiveRecord, str], None],
    ) -> None:
        self.header, self._clock, self._most_samples, self._tell = header, clock, most_samples, tell
        self.name, self.address, self.refused = header.source, "", ""
        self.connection: InstrumentReader | None = None
        """The connection by which it sends now."""
        self.records: list[LiveRecord] = []
        self.order, self._arrivals = BlockOrder(header.rate_khz, header.shots), Arrivals()
        self._samples = 0
        self._last = clock()
        self._left: float | None = None

    @property
    def is_silent(self) -> bool:
        """Whether no block has come for a while."""
        return self._clock() - self._last >= SILENT_S

    def enter(self, connection: InstrumentReader, header: LineHeader, address: str) -> None:
        """Send by this connection from now on; a record continues if the header still describes it.

        Raises
        ------
        InputError
            When another connection sends.
        """
        if self.connection is not None and not self.is_silent:
            raise InputError(f"{self.name} sends already, from {self.address}", "header.source", code="conflict")
        if self.connection is not None:
            self.connection.close("another connection has taken its place")
        described = {"rate_khz", "pairing", "shots"}
        if header.model_dump(include=described) != self.header.model_dump(include=described):
            for record in list(self.records):
                self.end(record, f"{self.name} has come back with another rate, pairing or shots")
            self.order = BlockOrder(header.rate_khz, header.shots)
        self.header, self.connection, self.address = header, connection, address
        self._last, self.refused = self._clock(), ""
        self.order.begin(header.session)
        for record in self.records:
            record.order.begin(header.session)
            record.is_connected = True
            away = f" after {self._clock() - self._left:.1f} s" if self._left is not None else ""
            self._tell(record, f"instrument {self.name} is back{away}")

    def leave(self, connection: InstrumentReader, why: str, *, is_refusal: bool) -> None:
        """Note that a connection has ended."""
        if self.connection is not connection:
            return
        self.connection, self._left = None, self._clock()
        self.refused = why if is_refusal else ""
        for record in self.records:
            record.is_connected = False
            self._tell(record, f"instrument {self.name} is gone: {why}; the bench waits")

    async def take(self, head: BlockHead, pairs: NDArray[np.float64]) -> None:
        """Add a block to all records.

        Raises
        ------
        InputError
            When its time runs back.
        """
        now = self._clock()
        if self.order.place(head) is not None:
            self._samples += head.samples
            self._arrivals.came(self._samples, now)
        self._last = now
        for record in list(self.records):
            try:
                await asyncio.to_thread(record.take, head, pairs, self._most_samples)
            except InputError as error:
                self.end(record, str(error))
            else:
                record.arrivals.came(record.samples, now)

    def end(self, record: LiveRecord, why: str) -> None:
        """End a record."""
        self.records.remove(record)
        record.end(why)
        self._tell(record, record.last_line)

    def status(self) -> SourceStatus:
        """Describe the source."""
        return SourceStatus(
            name=self.name,
            address=self.address,
            is_connected=self.connection is not None,
            names=self.header.names,
            units=self.header.units,
            rate_khz=self.header.rate_khz,
            received_khz=self._arrivals.rate_khz(self._clock()),
            **self.order.counts(),
            records=len(self.records),
            refused=self.refused,
        )
