"""The results of runs, by the key of the run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

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
        keys_there: set[str] = set()
        for start in range(0, len(keys), AT_ONCE):
            query = select(ResultRow.key).where(ResultRow.key.in_(keys[start : start + AT_ONCE]))
            keys_there |= set(self._database.transact(lambda session, q=query: list(session.scalars(q))))  # type: ignore[misc]
        return keys_there

    def put(self, outcomes: list[tuple[str, str]]) -> None:
        """Add outcomes, JSON texts, in one transaction; existing outcomes stay as they are."""
        rows = [{"key": key, "text": outcome} for key, outcome in outcomes]
        if rows:
            self._database.transact(lambda session: session.execute(self._insert(), rows))

    def outcomes(self, keys: Sequence[str]) -> Iterator[tuple[str, str]]:
        """Yield the outcomes in the table as JSON texts, a few hundred at a time."""
        for start in range(0, len(keys), AT_ONCE):
            query = select(ResultRow.key, cast(ResultRow.outcome, Text)).where(
                ResultRow.key.in_(keys[start : start + AT_ONCE])
            )
            rows = self._database.transact(lambda session, q=query: list(session.execute(q)))  # type: ignore[misc]
            yield from ((key, outcome) for key, outcome in rows)

    def _insert(self) -> Insert:
        """Return the statement "insert unless it exists" in the dialect of the database; it takes the JSON as it is."""
        key: BindParameter[str] = bindparam("key")
        text = bindparam("text", type_=Text)
        if self._database.url.startswith("sqlite"):
            return sqlite.insert(ResultRow).values(key=key, outcome=text).on_conflict_do_nothing()
        from sqlalchemy.dialects import postgresql  # a third of the time to load SQLAlchemy

        return postgresql.insert(ResultRow).values(key=key, outcome=cast(text, JSON)).on_conflict_do_nothing()
