"""Records of devices: rows in the database with their owners, files in the data folder under their keys."""

from __future__ import annotations

import asyncio
import os
import secrets
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from core.measured_record import MeasuredRecord
from scenarios.records.shelf import RecordFolder
from server.errors import ApiError, not_found
from server.paging import WHOLE, ListPage, by_age
from server.store.database import Database
from server.store.models import RecordRow

MOST_OF_STUDENT = 8
"""Records that a student may keep."""
UPLOADING = ".uploading-"
"""Beginning of the names of the folders of uploads under way."""


class KeptRecord(BaseModel):
    """A record of a device as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    key: str = Field(description="SHA-256 of its numbers, by which a scenario names it")
    name: str = Field(description="Name of its file")
    rate_khz: float
    samples: int
    bytes: int
    columns: dict[str, str] = Field(description="The column of the file for each part")
    notes: list[str] = Field(description="Sentences about lost samples and irregular times")
    labels: list[str] = Field(description="Names of its labels; empty: it has none, and so no score")
    lost: int = Field(description="Samples without a displacement")
    drive_v: list[float] = Field(description="Least and largest voltage")
    displacement_um: list[float] = Field(description="Least and largest displacement")
    created: datetime


class MeasuredRecords:
    """Keeps records, each for its owner.

    Parameters
    ----------
    database : Database
        Where the rows are.
    folder : Path
        Where the files are.
    """

    def __init__(self, database: Database, folder: Path) -> None:
        self._database, self.folder = database, folder
        self._turn = asyncio.Lock()

    @contextmanager
    def uploading(self) -> Iterator[Path]:
        """Make a folder for an upload, which is deleted with all that is left in it."""
        self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        folder = Path(tempfile.mkdtemp(dir=self.folder, prefix=UPLOADING))
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    async def recover(self) -> None:
        """Delete the uploads that were under way when the server stopped; a file without a row may be another's."""
        for path in self.folder.glob(f"{UPLOADING}*"):
            await asyncio.to_thread(shutil.rmtree, path, ignore_errors=True)

    async def keep(self, name: str, owner: str, file: Path, key: str, **fields: Any) -> tuple[KeptRecord, bool]:
        """Keep the file of a record that was read; a record that its owner has already is not kept twice.

        Returns
        -------
        KeptRecord, bool
            The record, and whether it is new.
        """
        async with self._turn:
            place = self.folder / f"{key}.npz"
            is_new = not place.exists()

            def add(session: Session) -> tuple[RecordRow, bool]:
                found = session.scalar(select(RecordRow).filter_by(key=key, owner=owner))
                if found is not None:
                    return found, False
                row = RecordRow(id=secrets.token_hex(15), key=key, name=name[:200], owner=owner, **fields)
                session.add(row)
                session.flush()
                return row, True

            await asyncio.to_thread(os.replace, file, place)
            try:
                row, is_added = await self._database.run(add)
            except BaseException:
                if is_new:
                    place.unlink(missing_ok=True)
                raise
            return _shown(row), is_added

    async def check_room(self, owner: str) -> None:
        """Refuse a student more records than the limit."""
        if not owner:
            return
        query = select(func.count()).select_from(RecordRow).filter_by(owner=owner)
        if await self._database.run(lambda session: session.scalar(query) or 0) >= MOST_OF_STUDENT:
            text = f"you have {MOST_OF_STUDENT} records, the most of a student"
            raise ApiError(409, "limit", text, hint="delete one first")

    async def all(self, owner: str | None = None, page: ListPage = WHOLE) -> list[KeptRecord]:
        """List records, newest first: all of them, or the records of an owner."""
        query = page.chosen(select(RecordRow), RecordRow.created, RecordRow.id, newest_first=True)
        if owner is not None:
            query = query.where(RecordRow.owner == owner)
        rows = await self._database.run(lambda session: list(session.scalars(query)))
        return [_shown(row) for row in page.rows(rows, by_age)]

    async def get(self, record_id: str, owner: str | None = None) -> KeptRecord:
        """Return a record, or refuse with 404; with an owner also the record of another."""
        row = await self._database.run(lambda session: session.get(RecordRow, record_id))
        if row is None or (owner is not None and row.owner != owner):
            raise not_found("record", record_id)
        return _shown(row)

    async def samples(self, record: KeptRecord) -> MeasuredRecord:
        """Return the samples of a record, or refuse a damaged file with 410."""
        found = await asyncio.to_thread(RecordFolder(self.folder).whole, record.key)
        if found is None:
            raise ApiError(410, "damaged", "the file of the record is damaged or gone", hint="delete it")
        return found

    async def delete(self, record: KeptRecord) -> None:
        """Delete a record; its file stays while another owner has the same numbers."""
        async with self._turn:

            def gone(session: Session) -> bool:
                session.execute(delete(RecordRow).filter_by(id=record.id))
                return session.scalar(select(RecordRow.id).filter_by(key=record.key)) is None

            if await self._database.run(gone):
                await asyncio.to_thread(RecordFolder(self.folder).remove, record.key)


def _shown(row: RecordRow) -> KeptRecord:
    plain = {name: getattr(row, name) for name in ("id", "key", "name", "rate_khz", "samples", "bytes", "created")}
    return KeptRecord.model_validate({**plain, **row.about})
