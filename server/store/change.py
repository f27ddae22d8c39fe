"""A change of stored data: the write to the database, and the change in memory that follows it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from sqlalchemy.orm import Session


def _nothing() -> None:
    """Hold nothing in memory."""


@dataclass(frozen=True)
class Change:
    """A change: the database first, then memory.

    Parameters
    ----------
    write : callable
        Writes it, within a transaction.
    take : callable
        Makes it true in memory. It is called once the transaction is over, and cannot fail.
    """

    write: Callable[[Session], object]
    take: Callable[[], object] = _nothing
