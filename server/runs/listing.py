"""Lists of runs and campaigns: which are asked for, how they are called, and how those that have ended are removed."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy import Delete, Select, delete, or_, select, update

from core.errors import InputError
from server.errors import ApiError, not_found
from server.store.database import Database
from server.store.models import RunRow, SweepRow

ACTIVE = ("queued", "running")
MOST = 200
"""Rows of one list."""
LONGEST_LABEL = 120
State = Literal["queued", "running", "done", "failed", "cancelled", "aborted"]


class Run(BaseModel):
    """A headless run as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    key: str
    state: str
    scenario_id: str
    title: str
    label: str = Field("", description="Name that somebody gave it")
    seeds: list[int]
    created: datetime
    finished: datetime | None
    progress: float
    summary: dict[str, Any] | None
    error: dict[str, Any] | None


class RunFilter(BaseModel):
    """Which runs or campaigns a list is to have."""

    text: str = Field("", max_length=200, description="Words in the name, the title or the id of the scenario")
    state: State | None = Field(None, description="Only those in this state")
    scenario: str = Field("", max_length=200, description="Only those of this scenario")

    def of(self, table: type[RunRow] | type[SweepRow]) -> Select[Any]:
        """Return the rows that are asked for, newest first."""
        scenario: Any = RunRow.scenario_id if table is RunRow else SweepRow.document["scenario"].as_string()
        query = select(table).order_by(table.created.desc()).limit(MOST)
        for word in self.text.split():
            named = (column.icontains(word, autoescape=True) for column in (table.label, table.title, scenario))
            query = query.where(or_(*named))
        if self.state is not None:
            query = query.where(table.state == self.state)
        return query.where(scenario == self.scenario) if self.scenario else query


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


async def rename(database: Database, table: type[RunRow] | type[SweepRow], noun: str, row_id: str, label: str) -> None:
    """Give a run or a campaign a name; an empty one takes it away."""
    statement = update(table).where(table.id == row_id).values(label=clean_label(label)).returning(table.id)
    if await database.run(lambda session: session.execute(statement).first()) is None:
        raise not_found(noun, row_id)


async def remove(
    database: Database,
    table: type[RunRow] | type[SweepRow],
    noun: str,
    ids: Sequence[str] | None,
    folder: Path | None = None,
) -> int:
    """Remove some that have ended, or all; return how many. If one of them cannot be removed, none is.

    Parameters
    ----------
    ids : sequence of str, optional
        Those to remove; all that have ended when left out.
    folder : Path, optional
        Where each has a folder of its own. Files go first: on a full disk the row can be deleted only after they have
        made room.
    """
    query = select(table.id, table.state)
    rows = await database.run(lambda session: dict(session.execute(query).all()))
    if ids is None:
        ids = [row_id for row_id, state in rows.items() if state not in ACTIVE]
    for row_id in ids:
        if row_id not in rows:
            raise not_found(noun, row_id)
        if rows[row_id] in ACTIVE:
            raise ApiError(409, "conflict", f"the {noun} {row_id} is {rows[row_id]}; cancel it first", "ids")
    for row_id in dict.fromkeys(ids):
        if folder is not None:
            await asyncio.to_thread(shutil.rmtree, folder / row_id, ignore_errors=True)
        statement: Delete = delete(table).where(table.id == row_id, table.state.not_in(ACTIVE))
        await database.run(lambda session, s=statement: session.execute(s))  # type: ignore[misc]
    return len(set(ids))
