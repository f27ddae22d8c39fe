"""The room for benches: how many may be live at a time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from core.format import format_count
from server.errors import ApiError
from server.settings import Settings


class Room:
    """Counts the live benches and the benches that are being made.

    Parameters
    ----------
    settings : Settings
        Limits.
    live : callable
        Counts the benches that are live.
    """

    def __init__(self, settings: Settings, live: Callable[[], int]) -> None:
        self._settings, self._live = settings, live
        self._coming = 0

    @contextmanager
    def taken(self) -> Iterator[None]:
        """Take the room of one bench until it is live.

        Raises
        ------
        ApiError
            If there is none.
        """
        self._check()
        self._coming += 1
        try:
            yield
        finally:
            self._coming -= 1

    def _check(self) -> None:
        most, minutes = self._settings.max_benches, self._settings.idle_minutes
        if self._live() + self._coming < most:
            return
        after = format_count(math.ceil(minutes), "minute")
        wait = f"; a bench without watchers is closed after {after}" if minutes else ""
        text = f"the server is full: {most} of {most} benches are live (max_benches)"
        raise ApiError(409, "too_many_benches", text, hint=f"use a running bench, or close one{wait}")
