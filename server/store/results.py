"""The results of runs, by the key of the run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from sqlalchemy import JSON, BindParameter, Insert, Text, bindparam, cast, select
from sqlalchemy.dialects import sqlite

from server.store.database import Database
from server.store.models import ResultRow

AT_ONCE = 500
"""Keys in one query: SQLite takes 999 parameters where it is old."""


class Results:
    """The table of results of all runs and campaigns.

    Parameters
    ----------
    database : Database
        The database of the table.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    def have(self, keys: Sequence[str]) -> set[str]:
        """Return the keys that have a result."""
        return {row.key for row in self._rows(keys, ResultRow.key)}

    def put(self, outcomes: list[tuple[str, str]]) -> None:
        """Add outcomes, JSON texts, in one transaction; existing outcomes stay as they are."""
        rows = [{"key": key, "text": outcome} for key, outcome in outcomes]
        if rows:
            self._database.transact(lambda session: session.execute(self._insert(), rows))

    def outcomes(self, keys: Sequence[str]) -> Iterator[tuple[str, str]]:
        """Yield the outcomes in the table as JSON texts, a few hundred at a time."""
        yield from self._rows(keys, ResultRow.key, cast(ResultRow.outcome, Text))

    def _rows(self, keys: Sequence[str], *columns: Any) -> Iterator[Any]:
        """Yield columns of the rows with some keys."""
        for start in range(0, len(keys), AT_ONCE):
            query = select(*columns).where(ResultRow.key.in_(keys[start : start + AT_ONCE]))
            yield from self._database.transact(lambda session, q=query: list(session.execute(q)))  # type: ignore[misc]

    def _insert(self) -> Insert:
        """Return the statement "insert unless it exists" in the dialect of the database; it takes the JSON as it is."""
        key: BindParameter[str] = bindparam("key")
        text = bindparam("text", type_=Text)
        if self._database.url.startswith("sqlite"):
            return sqlite.insert(ResultRow).values(key=key, outcome=text).on_conflict_do_nothing()
        from sqlalchemy.dialects import postgresql  # a third of the time to load SQLAlchemy

        return postgresql.insert(ResultRow).values(key=key, outcome=cast(text, JSON)).on_conflict_do_nothing()
