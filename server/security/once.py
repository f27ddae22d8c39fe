"""Secrets that open something once, within a short time: kept in memory, by their hash."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable
from typing import Generic, TypeVar

from server.security.person import hash_of, new_secret

T = TypeVar("T")


class Once(Generic[T]):
    """A store of things, each behind a secret that works once.

    Parameters
    ----------
    seconds : float
        How long a secret lasts.
    most : int
        Things kept at once; beyond, the oldest is forgotten.
    clock : callable
        Seconds.
    """

    def __init__(self, seconds: float, most: int = 4096, clock: Callable[[], float] = time.monotonic) -> None:
        self._seconds, self._most, self._clock = seconds, most, clock
        self._kept: OrderedDict[str, tuple[float, T]] = OrderedDict()

    def put(self, thing: T) -> str:
        """Keep something; return its secret."""
        secret = new_secret()
        self._kept[hash_of(secret)] = (self._clock() + self._seconds, thing)
        while len(self._kept) > self._most:
            self._kept.popitem(last=False)
        return secret

    def take(self, secret: str) -> T | None:
        """Return the value behind a secret, for the first and last time."""
        until, thing = self._kept.pop(hash_of(secret), (0.0, None))
        return thing if thing is not None and until > self._clock() else None
