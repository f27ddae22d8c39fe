"""Shared memory of a worker and its master process: the worker counts ticks, the master can stop it."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing import RawArray
from typing import Any, TypeVar

T = TypeVar("T")


class Cancelled(Exception):
    """The work was called off."""


class Signs:
    """Two numbers in shared memory for each piece of work that is given out.

    Parameters
    ----------
    count : int
        Most pieces at once.
    """

    def __init__(self, count: int) -> None:
        self.ticks: Any = RawArray("q", count)
        self.stop: Any = RawArray("b", count)


_received: tuple[Signs, int] | None = None
"""In a worker: the signs, and the place of the present work among them."""


def receive(signs: Signs) -> None:
    """Keep the signs; in a worker, when it starts."""
    global _received
    _received = signs, 0


def watched(place: int, function: Callable[..., T], *arguments: object) -> T:
    """Call a function that reports its progress; in a worker."""
    global _received
    assert _received is not None
    _received = _received[0], place
    tell(0)
    return function(*arguments)


def tell(ticks: int) -> None:
    """Report how many ticks of the work are done; without effect outside a worker.

    Raises
    ------
    Cancelled
        When the work was called off.
    """
    if _received is None:
        return
    signs, place = _received
    signs.ticks[place] = ticks
    if signs.stop[place]:
        raise Cancelled
