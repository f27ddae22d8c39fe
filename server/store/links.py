"""Links: experiments and layouts by a permanent short id, and closed idle benches until they come back."""

from __future__ import annotations

import json
import secrets
from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict
from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from server.errors import ApiError, not_found
from server.paging import WHOLE, ListPage, by_age
from server.store.database import Database
from server.store.experiment import THIS_VERSION, Experiment
from server.store.models import LinkRow

Kind = Literal["experiment", "layout", "bench"]
LETTERS = "23456789abcdefghjkmnpqrstuvwxyz"
"""Letters of an id that is read aloud or copied from a board: none that looks like another."""
ID_LENGTH = 8
MOST_CONTENT = 2_000_000
"""Most characters of the target of a link, as JSON."""
MOST_LET_GO = 500
"""Closed idle benches that can come back; beyond, the oldest is forgotten."""


class Link(BaseModel):
    """A link as lists show it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    kind: Kind
    title: str
    note: str
    scenario_id: str | None
    tick: int | None
    digest: str | None
    version: str
    bytes: int
    created: datetime


class Content(BaseModel):
    """The target of a link: an experiment, a layout of the page, or both."""

    experiment: Experiment | None = None
    layout: dict[str, Any] | None = None


class LinkDetail(Link):
    """A link with its target."""

    content: Content


class Links:
    """Keeps links and finds them.

    Parameters
    ----------
    database : Database
        Where the rows are.
    most : int
        The limit of links, without closed idle benches.
    """

    def __init__(self, database: Database, most: int) -> None:
        self._database, self._most = database, most

    async def keep(self, content: Content, title: str, note: str = "", bench_id: str | None = None) -> LinkDetail:
        """Keep an experiment or a layout under a new id, or a closed idle bench under its own.

        Raises
        ------
        ApiError
            If it is too large, or there are too many.
        """
        plain = content.model_dump(mode="json")
        size = len(json.dumps(plain))
        if size > MOST_CONTENT:
            text = f"the commands and the layout take {size} characters, at most {MOST_CONTENT}"
            raise ApiError(413, "too_large", text, hint="save it as a scenario instead")
        done = content.experiment
        row = LinkRow(
            id=bench_id or "".join(secrets.choice(LETTERS) for _ in range(ID_LENGTH)),
            kind="bench" if bench_id else "experiment" if done else "layout",
            title=title,
            note=note,
            scenario_id=done and str(done.scenario.get("id", ""))[:200],
            tick=done and done.tick,
            digest=done and done.digest,
            version=done.version if done else THIS_VERSION,
            content=plain,
            bytes=size,
        )

        def keep(session: Session) -> LinkRow:
            count = select(func.count()).select_from(LinkRow).where(LinkRow.kind != "bench")
            if bench_id is None and (session.scalar(count) or 0) >= self._most:
                text = f"{self._most} links are kept, the limit (max_links)"
                raise ApiError(409, "too_many_links", text, hint="delete some first")
            there = session.merge(row)
            session.flush()
            if bench_id is not None:
                _forget_oldest(session)
            session.refresh(there)
            return there

        return LinkDetail.model_validate(await self._database.run(keep))

    async def all(self, kind: Kind | None = None, page: ListPage = WHOLE) -> list[Link]:
        """List links, newest first; without closed idle benches."""
        columns = [getattr(LinkRow, name) for name in Link.model_fields]
        query = select(*columns).where(LinkRow.kind != "bench")
        if kind is not None:
            query = query.where(LinkRow.kind == kind)
        query = page.chosen(query, LinkRow.created, LinkRow.id, newest_first=True)
        rows = page.rows(await self._database.run(lambda session: list(session.execute(query))), by_age)
        return [Link.model_validate(row) for row in rows]

    async def get(self, link_id: str) -> LinkDetail:
        """Return a link and its target, or refuse with 404."""
        return _found(await self._database.run(lambda session: session.get(LinkRow, link_id[:64])), link_id)

    async def let_go(self, bench_id: str) -> LinkDetail | None:
        """Return the closed idle bench with this id, if there is one."""
        row = await self._database.run(lambda session: session.get(LinkRow, bench_id[:64]))
        return LinkDetail.model_validate(row) if row is not None and row.kind == "bench" else None

    async def change(self, link_id: str, **values: Any) -> LinkDetail:
        """Change the title or the note of a link; its target stays."""

        def change(session: Session) -> LinkRow | None:
            row = session.get(LinkRow, link_id[:64])
            if row is not None:
                for name, value in values.items():
                    setattr(row, name, value)
            return row

        return _found(await self._database.run(change), link_id)

    async def delete(self, link_id: str) -> None:
        """Delete a link, or forget a closed idle bench."""
        await self._database.run(lambda session: session.execute(delete(LinkRow).where(LinkRow.id == link_id)))


def _found(row: LinkRow | None, link_id: str) -> LinkDetail:
    """Describe a link, or refuse with 404."""
    if row is None:
        raise not_found("link", link_id, "it may have been deleted")
    return LinkDetail.model_validate(row)


def _forget_oldest(session: Session) -> None:
    """Delete the oldest benches beyond their number."""
    newest = select(LinkRow.id).where(LinkRow.kind == "bench").order_by(LinkRow.created.desc())
    ids = list(session.scalars(newest.offset(MOST_LET_GO)))
    session.execute(delete(LinkRow).where(LinkRow.id.in_(ids)))
