"""The quota and the retention of recordings and runs."""

from __future__ import annotations

import asyncio
import logging
import shutil
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path

from sqlalchemy import delete, select, true

from server.clock import Clock
from server.errors import ApiError
from server.settings import Settings
from server.store.database import Database
from server.store.models import RecordingRow, RequestRow
from server.store.recording import free_bytes

log = logging.getLogger(__name__)

EVERY_S = 3600.0
FOLDERS = ("recordings", "records", "runs", "sweeps")


class Keeping:
    """Watches the disk space and the age of recordings and runs.

    Parameters
    ----------
    database : Database
        Storage of the rows of recordings and of runs.
    settings : Settings
        Folder, quota, retention.
    """

    def __init__(self, database: Database, settings: Settings) -> None:
        self._database, self._settings = database, settings

    async def room(self) -> int:
        """Return the bytes that may still be written.

        Raises
        ------
        ApiError
            When the quota is used up, or the disk is full except for its reserve.
        """
        free = await asyncio.to_thread(free_bytes, self._settings.data)
        if free <= self._settings.disk_reserve_bytes:
            text = f"{free} bytes of the disk are free, which is its reserve (disk_reserve_bytes)"
            raise ApiError(507, "no_space", text, hint="delete recordings, or make room on the disk")
        used = await asyncio.to_thread(self._used) + await self._database.used_bytes()
        left = self._settings.quota_bytes - used
        if left <= 0:
            quota = f"the quota is {self._settings.quota_bytes} (quota_bytes)"
            text = f"recordings, runs and their database take {used} bytes, {quota}"
            raise ApiError(507, "no_space", text, hint="delete recordings, or wait for their retention to end")
        return left

    async def run(self, clock: Clock) -> None:
        """Delete recordings and runs beyond the retention, now and every hour."""
        await self._try_to_expire()
        async for _ in clock.every(EVERY_S):
            await self._try_to_expire()

    async def _try_to_expire(self) -> None:
        try:
            await self.expire()
        except Exception:
            log.exception("old recordings and runs could not be deleted")

    async def expire(self) -> int:
        """Delete recordings and runs that ended longer ago than the retention; return how many."""
        if not self._settings.retention_days:
            return 0
        before = datetime.now(UTC) - timedelta(days=self._settings.retention_days)
        count = 0
        for table, folder, which in (
            (RecordingRow, "recordings", true()),
            (RequestRow, "runs", RequestRow.kind == "run"),
        ):
            query = select(table.id).where(table.finished < before, which)
            ids = await self._database.run(lambda session, q=query: list(session.scalars(q)))  # type: ignore[misc]
            for key in ids:
                statement = delete(table).filter_by(id=key)
                await self._database.run_or_make_room(
                    lambda session, s=statement: session.execute(s),  # type: ignore[misc]
                    partial(_remove, self._settings.data / folder, key),
                )
            count += len(ids)
        if count:
            log.info("deleted %d recordings and runs older than %g days", count, self._settings.retention_days)
        return count

    def _used(self) -> int:
        """Return the bytes of all files of recordings and runs."""
        total = 0
        for folder in FOLDERS:
            for path in (self._settings.data / folder).rglob("*"):
                try:
                    total += path.stat().st_size if path.is_file() else 0
                except FileNotFoundError:  # gone meanwhile
                    continue
        return total


def _remove(folder: Path, name: str) -> None:
    """Remove the files of a recording, or the folder of a run."""
    shutil.rmtree(folder / name, ignore_errors=True)
    for path in folder.glob(f"{name}.*"):
        path.unlink(missing_ok=True)
