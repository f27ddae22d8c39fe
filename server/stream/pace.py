"""The rate of pictures: the rate of the settings, or less while the event loop is too busy."""

from __future__ import annotations

import time
from collections.abc import Callable

SLACK = 0.25
"""Share of a period a picture may come early: it follows a round of the engine, and rounds have their own period."""

BUSY = 0.5
"""Share of its time the event loop may work; above it commands wait too long behind pictures."""

SLOWEST_S = 0.2
OVER_S = 0.25
"""Time over which the work of the loop is measured."""


class Pace:
    """The period of pictures, chosen so that the event loop is busy for a given share of its time at most.

    Pictures cost in proportion to their rate and are nearly all the work of a busy loop. The period is therefore
    stretched by the ratio of the load of the loop to `BUSY`, and shrinks again in the same way.

    Parameters
    ----------
    rate_hz : float
        Pictures per second when there is time for them.
    clock : callable
        Seconds the calling thread has worked.
    """

    def __init__(self, rate_hz: float, clock: Callable[[], float] = time.thread_time) -> None:
        self._wanted_s = self.period_s = 1.0 / rate_hz
        self._clock = clock
        self._next = 0.0
        self._since: tuple[float, float] | None = None

    def is_due(self, now: float) -> bool:
        """Return whether it is time for a picture."""
        return now >= self._next

    def wait_s(self, now: float) -> float:
        """Return how long it is until a picture is late: rounds that come before that are in time to send it."""
        return max(self._next + SLACK * self.period_s - now, 0.0)

    def begin(self, now: float) -> None:
        """Note that pictures are sent now."""
        worked = self._clock()
        if self._since is None:
            self._since = (now, worked)
        elif (passed := now - self._since[0]) >= OVER_S:
            busy = (worked - self._since[1]) / passed
            stretch = min(max(busy / BUSY, 0.8), 1.5)
            self.period_s = min(max(self.period_s * stretch, self._wanted_s), SLOWEST_S)
            self._since = (now, worked)
        self._next = now + (1.0 - SLACK) * self.period_s
