"""Runs and campaigns as rows: their selection, their names, the removal of ended rows."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy import Select, delete, or_, select, update
from sqlalchemy.orm import Session, defer

from core.errors import InputError
from scenarios.key import code_version
from server.errors import ApiError, ErrorBody, not_found
from server.paging import ListPage, by_age
from server.runs.changed import ChangedValue
from server.runs.summary import RunSummary
from server.store.base import now
from server.store.database import Database
from server.store.models import RequestRow

ACTIVE = ("queued", "running")
AT_ONCE = 500
"""Rows deleted by one statement."""
LONGEST_LABEL = 120
Kind = Literal["run", "campaign", "threshold"]
State = Literal["queued", "running", "done", "failed", "cancelled", "aborted"]


class Run(BaseModel):
    """A headless run as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    key: str
    state: State
    scenario_id: str
    title: str
    label: str = Field("", description="Name given by a user")
    seeds: list[int]
    all: bool = Field(
        validation_alias="everything", description="Whether the trace has the signals of blocks in shadow too"
    )
    created: datetime
    finished: datetime | None
    progress: float
    changed: list[ChangedValue] = Field([], description="Values that differ from its scenario in the library")
    summary: RunSummary | None
    error: ErrorBody | None


class RunFilter(BaseModel):
    """Which runs or campaigns a list is to have."""

    text: str = Field("", max_length=200, description="Words in the name, the title or the id of the scenario")
    state: State | None = Field(None, description="Only rows in this state")
    scenario: str = Field("", max_length=200, description="Only rows of this scenario")

    def of(self, kind: Kind) -> Select[Any]:
        """Return the requested rows."""
        row = RequestRow
        query = select(row).where(row.kind == kind)
        for word in self.text.split():
            named = (column.icontains(word, autoescape=True) for column in (row.label, row.title, row.scenario_id))
            query = query.where(or_(*named))
        if self.state is not None:
            query = query.where(row.state == self.state)
        return query.where(row.scenario_id == self.scenario) if self.scenario else query


def clean_label(label: str) -> str:
    """Return a name as it is kept: one line, no space around it.

    Raises
    ------
    InputError
        When it is too long.
    """
    text = " ".join(label.split())
    if len(text) > LONGEST_LABEL:
        raise InputError(f"has {len(text)} characters, at most {LONGEST_LABEL}", "label")
    return text


class Requests:
    """The table of requests.

    Parameters
    ----------
    database : Database
        Where it is.
    data : Path
        The data folder, in which each run and each campaign has a folder of its own.
    """

    def __init__(self, database: Database, data: Path) -> None:
        self._database = database
        self.folders: dict[Kind, Path] = {
            "run": data / "runs",
            "campaign": data / "sweeps",
            "threshold": data / "thresholds",  # which keeps no files
        }

    async def settle(self, row: RequestRow, has_room: bool) -> RequestRow | None:
        """Return the same request if it waits, is under way or done, named anew; otherwise put it there if it may.

        A run is not the same if its trace lacks requested signals.

        Raises
        ------
        ApiError
            If such a run waits or is under way.
        """

        def work(session: Session) -> RequestRow | None:
            known = session.get(RequestRow, row.id)
            lacks = known is not None and row.everything and not known.everything
            if known is not None and lacks and known.state in ACTIVE:
                text = f"the same run is {known.state} and keeps fewer signals; ask again once it has ended"
                raise ApiError(409, "conflict", text, "all")
            if known is not None and not lacks and known.state in (*ACTIVE, "done"):
                known.label = row.label or known.label
                return known
            row.label = row.label or (known.label if known is not None else "")
            if has_room:
                session.merge(row)
            return None

        return await self._database.run(work)

    async def all(self, kind: Kind, wanted: RunFilter, page: ListPage) -> list[RequestRow]:
        """List the selected rows, newest first, without their documents."""
        query = page.chosen(wanted.of(kind), RequestRow.created, RequestRow.id, newest_first=True)
        return page.rows(await self._rows(query.options(defer(RequestRow.document))), by_age)

    async def some(self, kind: Kind, ids: Sequence[str]) -> list[RequestRow]:
        """Return the known rows among some ids."""
        return await self._rows(select(RequestRow).where(RequestRow.id.in_(ids), RequestRow.kind == kind))

    async def documents(self, ids: Sequence[str]) -> dict[str, dict[str, Any]]:
        """Return the documents of some requests by id."""
        query = select(RequestRow.id, RequestRow.document).where(RequestRow.id.in_(ids))
        rows = await self._database.run(lambda session: list(session.execute(query)))
        return {row.id: row.document for row in rows}

    async def recover(self) -> list[RequestRow]:
        """Return the waiting and active rows, in the order of their requests."""
        active = select(RequestRow).where(RequestRow.state.in_(ACTIVE))
        return await self._rows(active.order_by(RequestRow.created, RequestRow.id))

    async def get(self, kind: Kind, row_id: str) -> RequestRow:
        """Return one, or refuse with 404."""
        for row in await self.some(kind, [row_id]):
            return row
        raise not_found(kind, row_id)

    async def update(self, row_id: str, **values: Any) -> bool:
        """Change a row; return whether there is one."""
        return await self._database.run(lambda session: change(session, row_id, **values))

    async def rename(self, kind: Kind, row_id: str, label: str) -> RequestRow:
        """Give a run or a campaign a name; an empty one takes it away."""
        name = clean_label(label)

        def named(session: Session) -> RequestRow:
            row = session.get(RequestRow, row_id)
            if row is None or row.kind != kind:
                raise not_found(kind, row_id)
            row.label = name
            return row

        return await self._database.run(named)

    async def remove(self, kind: Kind, ids: Sequence[str] | None) -> int:
        """Remove some that have ended, or all if none is named; return how many.

        If one of them cannot be removed, none is.

        Results stay, for others share them.
        """
        if ids is None:
            query = select(RequestRow.id).where(RequestRow.kind == kind, RequestRow.state.not_in(ACTIVE))
            ids = await self._database.run(lambda session: list(session.scalars(query)))
        else:
            rows = {row.id: row for row in await self.some(kind, ids)}
            for row_id in ids:
                if row_id not in rows:
                    raise not_found(kind, row_id)
                if (state := rows[row_id].state) in ACTIVE:
                    raise ApiError(409, "conflict", f"the {kind} {row_id} is {state}; cancel it first", "ids")

        def delete_rows(session: Session) -> None:
            for first in range(0, len(ids), AT_ONCE):
                some = RequestRow.id.in_(ids[first : first + AT_ONCE])
                session.execute(delete(RequestRow).where(some, RequestRow.state.not_in(ACTIVE)))

        def remove() -> None:
            for row_id in ids:
                shutil.rmtree(self.folders[kind] / row_id, ignore_errors=True)

        await self._database.run_or_make_room(delete_rows, remove)
        return len(set(ids))

    async def _rows(self, query: Select[Any]) -> list[RequestRow]:
        return await self._database.run(lambda session: list(session.scalars(query)))


def fresh(**values: Any) -> RequestRow:
    """Return a request that waits from now on."""
    return RequestRow(
        **{"id": values["key"][:32], "label": "", "seeds": None, **values},
        state="queued",
        version=code_version(),
        done=0,
        attempts=0,
        created=now(),
        finished=None,
        summary=None,
        error=None,
    )


def change(session: Session, row_id: str, **values: Any) -> bool:
    """Change a row; return whether there is one."""
    statement = update(RequestRow).where(RequestRow.id == row_id).values(**values)
    return session.execute(statement.returning(RequestRow.id)).first() is not None
