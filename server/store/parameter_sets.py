"""Named sets of parameters: values by path, taken from a bench."""

from __future__ import annotations

import secrets
from datetime import datetime
from typing import Any

from pydantic import BaseModel, ConfigDict
from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from server.errors import ApiError, not_found
from server.paging import ListPage
from server.store.database import Database
from server.store.models import ParameterSetRow

MOST = 500
"""Sets kept."""


class ParameterSet(BaseModel):
    """A set as a list shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    name: str
    scenario: str
    created: datetime


class ParameterSetDetail(ParameterSet):
    """A set with its values."""

    values: dict[str, Any]


class ParameterSets:
    """Keeps sets, and finds them by id; names are unique.

    Parameters
    ----------
    database : Database
        Where the rows are.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    async def save(self, name: str, scenario: str, values: dict[str, Any]) -> ParameterSetDetail:
        """Keep values under a name."""

        def add(session: Session) -> ParameterSetRow:
            _check_name(session, name)
            if (session.scalar(select(func.count()).select_from(ParameterSetRow)) or 0) >= MOST:
                raise ApiError(409, "limit", f"{MOST} sets are kept, the limit", hint="delete some first")
            row = ParameterSetRow(id=secrets.token_hex(8), name=name, scenario=scenario, values=values)
            session.add(row)
            session.flush()
            return row

        return ParameterSetDetail.model_validate(await self._database.run(add))

    async def all(self, page: ListPage) -> list[ParameterSet]:
        """List the sets by name."""
        query = page.chosen(select(ParameterSetRow), ParameterSetRow.name)
        found = await self._database.run(lambda session: list(session.scalars(query)))
        rows = page.rows(found, lambda row: (row.name,))
        return [ParameterSet.model_validate(row) for row in rows]

    async def get(self, set_id: str) -> ParameterSetDetail:
        """Return a set, or refuse with 404."""
        return _found(await self._database.run(lambda session: session.get(ParameterSetRow, set_id)), set_id)

    async def rename(self, set_id: str, name: str) -> ParameterSetDetail:
        """Give a set another name."""

        def change(session: Session) -> ParameterSetRow | None:
            row = session.get(ParameterSetRow, set_id)
            if row is not None and row.name != name:
                _check_name(session, name)
                row.name = name
            return row

        return _found(await self._database.run(change), set_id)

    async def delete(self, set_id: str) -> None:
        """Forget a set."""
        await self.get(set_id)
        await self._database.run(lambda session: session.execute(delete(ParameterSetRow).filter_by(id=set_id)))


def _found(row: ParameterSetRow | None, set_id: str) -> ParameterSetDetail:
    """Describe a set, or refuse with 404."""
    if row is None:
        raise not_found("parameter set", set_id)
    return ParameterSetDetail.model_validate(row)


def _check_name(session: Session, name: str) -> None:
    """Refuse a name that another set has."""
    if session.scalar(select(ParameterSetRow.id).filter_by(name=name)):
        raise ApiError(409, "conflict", f"there is a set named {name!r} already", "name", "choose another name")
