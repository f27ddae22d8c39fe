"""Recordings: rows in the database, files in the data folder."""

from __future__ import annotations

import asyncio
import json
import logging
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict
from sqlalchemy import Update, delete, select, update
from sqlalchemy.exc import DBAPIError

from scenarios.arrow import pa
from server.errors import ApiError, not_found
from server.paging import WHOLE, ListPage, by_age
from server.store.database import Database, reason_of
from server.store.earlier import in_this_notation
from server.store.experiment import THIS_VERSION
from server.store.models import RecordingRow
from server.store.recording import EVENTS, PART, RecordingFile, events_of, first_tick, is_readable, rescue

log = logging.getLogger(__name__)

OPEN = ("armed", "recording")
DAMAGED = "cannot be read any more: it is damaged or gone"
State = Literal["armed", "recording", "done", "cut_short", "failed", "aborted"]
"""It waits; it grows; it ended as intended; it ended early but is whole; it is empty; the server stopped."""


class Recording(BaseModel):
    """A recording as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    bench_id: str
    name: str
    title: str
    state: State
    dt_ms: float
    start_tick: int
    ticks: int
    signals: list[dict[str, str]]
    seed: int | None
    version: str
    condition: str
    bytes: int
    created: datetime
    finished: datetime | None
    reason: str


class RecordingDetail(Recording):
    """A recording with the data needed to understand and repeat it."""

    scenario: dict[str, Any] | None
    events: Annotated[list[dict[str, Any]] | None, AfterValidator(in_this_notation)]
    layout: dict[str, Any] | None


@dataclass(frozen=True)
class About:
    """The description of a recording at its beginning."""

    bench_id: str
    name: str
    title: str
    dt_ms: float
    scenario: dict[str, Any]
    seed: int
    layout: dict[str, Any] | None = None
    condition: str = ""


def _damaged(recording_id: str) -> Update:
    """Return the change that marks a recording as unreadable."""
    table = RecordingRow
    return update(table).where(table.id == recording_id).values(state="failed", ticks=0, reason=f"its file {DAMAGED}")


class Recordings:
    """Opens, lists and finds recordings.

    Parameters
    ----------
    database : Database
        Where the rows are.
    folder : Path
        Where the files are.
    reserve_bytes : int
        Free space that recordings must leave.
    """

    def __init__(self, database: Database, folder: Path, reserve_bytes: int) -> None:
        self._database, self._folder, self._reserve_bytes = database, folder, reserve_bytes
        self._unclosed: dict[str, dict[str, Any]] = {}

    def path(self, recording_id: str) -> Path:
        """Return the file of a recording; the id must come from the service, never from a caller's text."""
        return self._folder / f"{recording_id}.parquet"

    async def open(self, about: About, schema: pa.Schema) -> tuple[Recording, RecordingFile]:
        """Make the row and the growing file of a new recording."""
        row = RecordingRow(
            **{**vars(about), "scenario": json.loads(json.dumps(about.scenario, default=str))},
            id=secrets.token_hex(15),
            state="armed" if about.condition else "recording",
            start_tick=0,
            signals=[
                {"name": field.name, "unit": (field.metadata or {}).get(b"unit", b"").decode()}
                for field in list(schema)[2:]
            ],
            version=THIS_VERSION,
        )
        try:
            file = await asyncio.to_thread(RecordingFile, self.path(row.id), schema, self._reserve_bytes)
        except OSError as error:
            text = f"the recording cannot be opened: {error.strerror or error}"
            raise ApiError(507, "no_space", text) from None
        try:
            await self._database.run(lambda session: session.add(row))
        except BaseException:
            await asyncio.to_thread(file.discard)
            raise
        return Recording.model_validate(row), file

    def begin(self, recording: Recording, start_tick: int) -> Recording:
        """Note the first tick, which is known once the engine has begun; if it cannot be kept, the end notes it."""
        begun: dict[str, Any] = {"start_tick": start_tick, "state": "recording"}
        statement = update(RecordingRow).where(RecordingRow.id == recording.id, RecordingRow.finished.is_(None))
        self._database.run_later(lambda session: session.execute(statement.values(**begun)))
        return recording.model_copy(update=begun)

    def closer(self, recording_id: str) -> Callable[[int, int, str, bool], None]:
        """Return the function that closes the row, cut short or not; called on the recorder's thread."""

        def close(first: int, ticks: int, reason: str, is_cut: bool) -> None:
            state = "failed" if not ticks else "cut_short" if is_cut else "done"
            self._close(recording_id, {"state": state, "start_tick": first, "ticks": ticks, "reason": reason})

        return close

    def _close(self, recording_id: str, values: dict[str, Any]) -> None:
        """Close a row; the events move into it from the file of the events."""
        path = self.path(recording_id)
        if events := events_of(path):  # without the file they are in the row already, or there were none
            values = {"events": events, **values}
        values = {"finished": datetime.now(UTC), **values}
        values["bytes"] = path.stat().st_size if path.exists() else 0
        statement = update(RecordingRow).where(RecordingRow.id == recording_id).values(**values)
        try:
            self._database.transact(lambda session: session.execute(statement))
        except DBAPIError as error:  # a full disk; closing is tried again at the next request
            log.error("recording %s is not closed in the database: %s", recording_id, reason_of(error))
            self._unclosed[recording_id] = values
        else:
            self._unclosed.pop(recording_id, None)
            path.with_suffix(EVENTS).unlink(missing_ok=True)

    async def _settle(self) -> None:
        """Close the recordings that a full disk kept from closing, and complete their files."""
        for recording_id, values in list(self._unclosed.items()):
            if not values["ticks"]:
                values["ticks"] = await asyncio.to_thread(rescue, self.path(recording_id))
                values["state"] = "cut_short" if values["ticks"] else values["state"]
            await asyncio.to_thread(self._close, recording_id, values)

    async def all(self, benches: list[str] | None = None, page: ListPage = WHOLE) -> list[Recording]:
        """List recordings, newest first: all of them, or the recordings of some benches."""
        await self._settle()
        query = page.chosen(select(RecordingRow), RecordingRow.created, RecordingRow.id, newest_first=True)
        if benches is not None:
            query = query.where(RecordingRow.bench_id.in_(benches))
        rows = page.rows(await self._database.run(lambda session: list(session.scalars(query))), by_age)
        return [Recording.model_validate(row).model_copy(update=self._unclosed.get(row.id)) for row in rows]

    async def get(self, recording_id: str) -> RecordingDetail:
        """Return one recording, or refuse with 404."""
        await self._settle()
        row = await self._database.run(lambda session: session.get(RecordingRow, recording_id))
        if row is None:
            raise not_found("recording", recording_id)
        return RecordingDetail.model_validate(row).model_copy(update=self._unclosed.get(row.id))

    async def finished(self, recording_id: str) -> tuple[RecordingDetail, Path]:
        """Return a recording that has ended, and its file."""
        recording = await self.get(recording_id)
        path = self.path(recording.id)
        if recording.state in OPEN or not path.is_file():
            raise not_found("finished trace of recording", recording_id, "stop the recording first")
        if not await asyncio.to_thread(is_readable, path):
            await self._database.run(lambda session: session.execute(_damaged(recording_id)))
            raise ApiError(410, "damaged", f"the file of the recording {DAMAGED}", hint="delete it")
        return recording, path

    async def delete(self, recording_id: str) -> None:
        """Delete a recording that has ended."""
        recording = await self.get(recording_id)
        if recording.state in OPEN:
            raise ApiError(409, "conflict", "the recording is under way", hint="stop it first")
        paths = [self.path(recording_id).with_suffix(kind) for kind in (".parquet", PART, EVENTS)]

        def unlink() -> None:
            for path in paths:
                path.unlink(missing_ok=True)

        gone = delete(RecordingRow).filter_by(id=recording_id)
        await self._database.run_or_make_room(lambda session: session.execute(gone), unlink)
        self._unclosed.pop(recording_id, None)

    async def recover(self) -> None:
        """Complete recordings after a crash: keep the ticks that reached the disk, mark the rows aborted."""
        query = select(RecordingRow.id, RecordingRow.state, RecordingRow.ticks)
        rows = await self._database.run(lambda session: list(session.execute(query)))
        known = {row.id: row.state for row in rows}
        for row in rows:
            whole = row.state in OPEN or not row.ticks or self.path(row.id).with_suffix(PART).exists()
            if not whole and not await asyncio.to_thread(is_readable, self.path(row.id)):
                await self._database.run(lambda session, id_=row.id: session.execute(_damaged(id_)))  # type: ignore[misc]
                log.warning("the file of recording %s %s", row.id, DAMAGED)
        for recording_id, state in known.items():
            # A full disk leaves the stream of a recording that has ended.
            if state in OPEN or self.path(recording_id).with_suffix(PART).exists():
                ticks = await asyncio.to_thread(self._rescue, recording_id)
                log.warning("recovered %d ticks of recording %s", ticks, recording_id)
        for path in self._folder.glob("*"):
            recording_id = path.name.split(".")[0]
            # A crash between making a file and its row leaves the file; one just after closing a row, its events.
            is_orphan = path.suffix in (PART, EVENTS, ".part") and recording_id not in known
            is_in_row = path.suffix == EVENTS and recording_id not in self._unclosed
            if is_orphan or is_in_row:
                path.unlink(missing_ok=True)

    def _rescue(self, recording_id: str) -> int:
        """Complete a file and close its row."""
        path = self.path(recording_id)
        ticks = rescue(path)
        values: dict[str, Any] = {"state": "aborted", "ticks": ticks, "reason": "the server stopped"}
        if ticks:
            values["start_tick"] = first_tick(path)
        self._close(recording_id, values)
        return ticks
