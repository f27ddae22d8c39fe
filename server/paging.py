"""Pages of lists: their rows, and the cursor of the next page.

A cursor is the key of the last row of a page. The next page begins after this key, whether the row is still there or
not, so rows that come or go between two pages neither repeat nor hide another row.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, TypeVar

from sqlalchemy import ColumnElement, Select, literal, tuple_

T = TypeVar("T")
Key = tuple[Any, ...]
"""The place of a row in its list: unique, and the same for as long as the row exists."""


def _ignore(_query: dict[str, Any]) -> None:
    """Need no next page."""


@dataclass(frozen=True)
class ListPage:
    """A page of a list.

    Parameters
    ----------
    limit : int, optional
        Most rows; all of them unless given.
    after : tuple, optional
        Key of the row before its first; it begins with the list unless given.
    tell : callable
        Called with the query of the next page, if there is one.
    """

    limit: int | None = None
    after: Key | None = None
    tell: Callable[[dict[str, Any]], None] = _ignore

    def cut(self, rows: Iterable[T], key: Callable[[T], Key]) -> list[T]:
        """Return the rows of the page from a whole list, in the order of the key."""
        ordered = sorted(rows, key=key)
        return self.rows([row for row in ordered if self.after is None or key(row) > self.after], key)

    def chosen(self, query: Select[Any], *columns: Any, newest_first: bool = False) -> Select[Any]:
        """Return a query for the rows of the page and one more, in the order of some columns."""
        if self.after is not None:
            place = tuple_(*columns)
            bound: ColumnElement[Any] = tuple_(
                *(literal(value, column.type) for value, column in zip(self.after, columns, strict=True))
            )
            query = query.where(place < bound if newest_first else place > bound)
        query = query.order_by(*(column.desc() if newest_first else column for column in columns))
        return query if self.limit is None else query.limit(self.limit + 1)

    def rows(self, found: Sequence[T], key: Callable[[T], Key], **query: Any) -> list[T]:
        """Return the rows of the page from the rows after its beginning, and tell the next page if some are left.

        The next page has further values in its query if they are given.
        """
        if self.limit is None or len(found) <= self.limit:
            return list(found)
        rows = list(found[: self.limit])
        self.tell({**query, "after": cursor(key(rows[-1]))})
        return rows


WHOLE = ListPage()
"""All rows."""


def cursor(key: Key) -> str:
    """Write a key as a caller sends it: JSON values between commas, so that a number is only its digits."""
    return json.dumps([one.isoformat() if isinstance(one, datetime) else one for one in key])[1:-1]


def by_age(row: Any) -> Key:
    """Return the key of a row in a list by the time of its creation."""
    return row.created, row.id
