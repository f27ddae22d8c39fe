"""The table of links: stored, refused and forgotten links; SQLite and PostgreSQL alike."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from sqlalchemy import text

from server.errors import ApiError
from server.store.database import Database
from server.store.links import MOST_CONTENT, MOST_LET_GO, Content, Links

LAYOUT = {"grid": {"root": {"data": []}}}


def test_links_survive_the_server_and_what_is_too_large_is_refused(place: Any) -> None:
    async def work() -> None:
        links = Links(database, 10)
        kept = await links.keep(Content(layout=LAYOUT), "Mine")
        assert (await Links(database, 10).get(kept.id)).content.layout == LAYOUT
        with pytest.raises(ApiError, match="at most 2000000"):
            await links.keep(Content(layout={"a": "x" * MOST_CONTENT}), "Large")
        row = "INSERT INTO links (id, kind, title, note, version, content, bytes, created) VALUES "
        old = ", ".join(
            f"('b{n}', 'bench', '', '', '', '{{}}', 2, '2020-01-01 00:00:{n % 60:02d}')" for n in range(MOST_LET_GO)
        )
        await database.run(lambda session: session.execute(text(row + old)))
        await links.keep(Content(), "Newest", bench_id="newest")
        count = text("SELECT count(*) FROM links WHERE kind = 'bench'")
        assert await database.run(lambda session: session.scalar(count)) == MOST_LET_GO
        assert await links.let_go("newest") and await links.let_go(kept.id) is None
        assert [one.id for one in await links.all()] == [kept.id]

    database = Database(place)
    database.migrate()
    asyncio.run(work())
    database.close()
