"""The existing sheets: the sheets of the library, and the sheets of users."""

from __future__ import annotations

import asyncio
import logging
import secrets
from datetime import datetime

from sqlalchemy import delete, select

from core.errors import InputError
from scenarios import sheets as library
from scenarios.sheets.check import check
from scenarios.sheets.sheet import Sheet
from server.errors import ApiError, not_found
from server.paging import Key
from server.store.base import now
from server.store.change import Change
from server.store.database import Database
from server.store.people import SheetRow

log = logging.getLogger(__name__)

MOST_OWN = 100
"""Sheets that may be opened in addition to the library."""


class Shelf:
    """The sheets of this server.

    Parameters
    ----------
    database : Database
        Store of the sheets of users.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self._own: dict[str, Sheet] = {}
        self._opened: dict[str, datetime] = {}

    async def recover(self) -> None:
        """Read the stored sheets of users."""
        query = select(SheetRow).order_by(SheetRow.created)
        for row in await self._database.run(lambda session: list(session.scalars(query))):
            try:
                self._own[row.id] = await asyncio.to_thread(check, row.text, row.id)
                self._opened[row.id] = row.created
            except InputError as error:
                log.warning("a user's sheet cannot be read any more: %s", error)

    def all(self) -> list[Sheet]:
        """List the sheets: the library in its order, then the sheets of users."""
        return [library.get(name) for name in library.ids()] + list(self._own.values())

    def key(self, sheet: Sheet) -> Key:
        """Return the key of a sheet in the list."""
        names = library.ids()
        if self.is_own(sheet.id):
            return len(names), f"{self._opened[sheet.id].isoformat()} {sheet.id}"
        return names.index(sheet.id), ""

    def is_own(self, sheet_id: str) -> bool:
        """Whether it is a user's sheet."""
        return sheet_id in self._own

    async def open(self, text: str) -> Sheet:
        """Keep a user's sheet.

        Raises
        ------
        InputError
            If it is not right; nothing is kept.
        """
        name = f"own-{secrets.token_hex(3)}"
        sheet = await asyncio.to_thread(check, text, name)
        if len(self._own) >= MOST_OWN:
            raise ApiError(409, "limit", f"{MOST_OWN} sheets are open, the limit", hint="delete one first")
        opened = now()
        await self._database.run(lambda session: session.add(SheetRow(id=name, text=text, created=opened)))
        self._own[name], self._opened[name] = sheet, opened
        return sheet

    def deletion(self, sheet_id: str) -> Change:
        """Delete a user's sheet."""
        if sheet_id not in self._own:
            raise not_found("sheet of your own", sheet_id, "the sheets of the library stay")
        gone = delete(SheetRow).where(SheetRow.id == sheet_id)
        return Change(lambda session: session.execute(gone), lambda: self._own.pop(sheet_id, None))
