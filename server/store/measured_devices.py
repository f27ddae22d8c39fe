"""Measured devices: what records calibrated, by name."""

from __future__ import annotations

import secrets
from datetime import datetime
from typing import Any

from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from server.errors import ApiError, not_found
from server.paging import ListPage
from server.store.database import Database
from server.store.models import MeasuredDeviceRow

MOST = 500
"""Devices kept."""


class MeasuredDevice(BaseModel):
    """A device that a record calibrated."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    name: str
    record_key: str = Field(description="Key of the record that calibrated it")
    values: dict[str, float] = Field(description="Values of a bench by dotted path")
    created: datetime

    def for_bench(self, *, plays_record: bool) -> dict[str, float]:
        """Return the values for a bench; offset, delay and noise are of the record, not of the device."""
        return {path: value for path, value in self.values.items() if plays_record or path.startswith("device.")}


class MeasuredDevices:
    """Keeps devices, and finds them by id; names are unique.

    Parameters
    ----------
    database : Database
        Where the rows are.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    async def check(self, name: str) -> None:
        """Refuse a name that another device has, and one device too many."""
        await self._database.run(lambda session: _check(session, name))

    async def save(
        self, name: str, record_key: str, values: dict[str, float], calibration: dict[str, Any]
    ) -> MeasuredDevice:
        """Keep a device under a name."""

        def add(session: Session) -> MeasuredDeviceRow:
            _check(session, name)
            row = MeasuredDeviceRow(
                id=secrets.token_hex(8), name=name, record_key=record_key, values=values, calibration=calibration
            )
            session.add(row)
            session.flush()
            return row

        return MeasuredDevice.model_validate(await self._database.run(add))

    async def all(self, page: ListPage) -> list[MeasuredDevice]:
        """List the devices by name."""
        query = page.chosen(select(MeasuredDeviceRow), MeasuredDeviceRow.name)
        found = await self._database.run(lambda session: list(session.scalars(query)))
        return [MeasuredDevice.model_validate(row) for row in page.rows(found, lambda row: (row.name,))]

    async def get(self, device_id: str) -> MeasuredDevice:
        """Return a device, or refuse with 404."""
        row = await self._database.run(lambda session: session.get(MeasuredDeviceRow, device_id))
        if row is None:
            raise not_found("measured device", device_id)
        return MeasuredDevice.model_validate(row)

    async def delete(self, device_id: str) -> None:
        """Forget a device; benches that have it keep it."""
        await self.get(device_id)
        await self._database.run(lambda session: session.execute(delete(MeasuredDeviceRow).filter_by(id=device_id)))


def _check(session: Session, name: str) -> None:
    if session.scalar(select(MeasuredDeviceRow.id).filter_by(name=name)):
        raise ApiError(409, "conflict", f"there is a device named {name!r} already", "name", "choose another name")
    if (session.scalar(select(func.count()).select_from(MeasuredDeviceRow)) or 0) >= MOST:
        raise ApiError(409, "limit", f"{MOST} devices are kept, the limit", hint="delete some first")
