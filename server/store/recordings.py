"""Recordings: rows in the database, files beside it."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pyarrow as pa
from pydantic import BaseModel, ConfigDict
from sqlalchemy import select, update

from server.errors import ApiError, not_found
from server.store.database import Database
from server.store.models import RecordingRow
from server.store.recording import PART, RecordingFile, convert

log = logging.getLogger(__name__)


class Recording(BaseModel):
    """A recording as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    bench_id: str
    name: str
    title: str
    state: str
    dt_ms: float
    start_tick: int
    ticks: int
    signals: list[dict[str, str]]
    created: datetime
    finished: datetime | None
    reason: str


class Recordings:
    """Opens, lists and finds recordings.

    Parameters
    ----------
    database : Database
        Where the rows are.
    folder : Path
        Where the files are.
    """

    def __init__(self, database: Database, folder: Path) -> None:
        self._database, self._folder = database, folder

    def path(self, recording_id: str) -> Path:
        """Return the file of a recording; the id is ours, never a caller's text."""
        return self._folder / f"{recording_id}.parquet"

    async def open(
        self, bench_id: str, name: str, title: str, dt_ms: float, schema: pa.Schema
    ) -> tuple[Recording, RecordingFile]:
        """Make the row and the growing file of a new recording."""
        row = RecordingRow(
            id=secrets.token_hex(16),
            bench_id=bench_id,
            name=name,
            title=title,
            state="recording",
            dt_ms=dt_ms,
            start_tick=0,
            signals=[
                {"name": field.name, "unit": (field.metadata or {}).get(b"unit", b"").decode()}
                for field in list(schema)[2:]
            ],
        )
        try:
            file = await asyncio.to_thread(RecordingFile, self.path(row.id), schema)
        except OSError as error:
            text = f"the recording cannot be opened: {error.strerror or error}"
            raise ApiError(507, "no_space", text) from None
        await self._database.run(lambda session: session.add(row))
        return Recording.model_validate(row), file

    async def begin(self, recording_id: str, start_tick: int) -> Recording:
        """Note the first tick, which is known once the engine has begun."""
        statement = update(RecordingRow).where(RecordingRow.id == recording_id).values(start_tick=start_tick)
        await self._database.run(lambda session: session.execute(statement))
        return await self.get(recording_id)

    def closer(self, recording_id: str) -> Callable[[int, str], None]:
        """Return the function that closes the row; called on the recorder's thread."""

        def close(ticks: int, reason: str) -> None:
            values: dict[str, Any] = {
                "state": "done" if ticks else "failed",
                "ticks": ticks,
                "reason": reason,
                "finished": datetime.now(UTC),
            }
            statement = update(RecordingRow).where(RecordingRow.id == recording_id).values(**values)
            try:
                self._database.transact(lambda session: session.execute(statement))
            except Exception:
                log.exception("recording %s could not be closed in the database", recording_id)

        return close

    async def all(self, bench_id: str | None = None) -> list[Recording]:
        """List recordings, newest first."""
        query = select(RecordingRow).order_by(RecordingRow.created.desc())
        if bench_id is not None:
            query = query.where(RecordingRow.bench_id == bench_id)
        rows = await self._database.run(lambda session: list(session.scalars(query)))
        return [Recording.model_validate(row) for row in rows]

    async def get(self, recording_id: str) -> Recording:
        """Return one recording, or refuse with 404."""
        row = await self._database.run(lambda session: session.get(RecordingRow, recording_id))
        if row is None:
            raise not_found("recording", recording_id)
        return Recording.model_validate(row)

    async def recover(self) -> None:
        """Make whole what a crash has left: keep the ticks that reached the disk, mark the row aborted."""
        query = select(RecordingRow.id).where(RecordingRow.state == "recording")
        ids = await self._database.run(lambda session: list(session.scalars(query)))
        for recording_id in ids:
            ticks = await asyncio.to_thread(self._rescue, recording_id)
            statement = (
                update(RecordingRow)
                .where(RecordingRow.id == recording_id)
                .values(state="aborted", ticks=ticks, reason="the server stopped", finished=datetime.now(UTC))
            )
            await self._database.run(lambda session, do=statement: session.execute(do))  # type: ignore[misc]
            log.warning("recovered %d ticks of recording %s", ticks, recording_id)

    def _rescue(self, recording_id: str) -> int:
        """Convert a stream that was cut off; 0 if there is nothing in it."""
        path = self.path(recording_id)
        if not path.with_suffix(PART).exists():
            return 0
        try:
            return convert(path)
        except (OSError, pa.ArrowException):
            return 0
