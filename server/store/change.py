"""A change of what is kept: how it is written, and what is true in memory once it is."""

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
