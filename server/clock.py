"""The clock of the service: seconds of the machine, or seconds that tests advance."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import AsyncGenerator
from dataclasses import dataclass, field


class Clock:
    """The monotonic seconds of the machine."""

    is_manual = False
    """Whether its time passes only when it is advanced."""

    def __call__(self) -> float:
        """Return the time, s."""
        return time.perf_counter()

    def wait(self, condition: threading.Condition, seconds: float) -> None:
        """Block a thread until the condition is notified or the time has passed."""
        condition.wait(seconds)

    async def every(self, seconds: float) -> AsyncGenerator[None, None]:
        """Yield again and again, each time after an interval."""
        while True:
            await asyncio.sleep(seconds)
            yield


@dataclass
class Sleeper:
    """A loop that waits for its time."""

    until: float
    woken: asyncio.Event = field(default_factory=asyncio.Event)


class ManualClock(Clock):
    """A clock whose time passes only by `advance`; except for reading it, for the event loop alone.

    Parameters
    ----------
    start : float
        Its first reading, s.
    """

    is_manual = True

    def __init__(self, start: float = 1000.0) -> None:
        self._now = start
        self._sleepers: list[Sleeper] = []
        self._awake = 0
        self._quiet = asyncio.Event()
        self.turn = asyncio.Lock()
        """Held while time passes, so that requests to advance follow each other."""

    def __call__(self) -> float:
        """Return the time, s."""
        return self._now

    def wait(self, condition: threading.Condition, seconds: float) -> None:  # noqa: ARG002
        """Block a thread until the condition is notified: no time passes meanwhile."""
        condition.wait()

    async def every(self, seconds: float) -> AsyncGenerator[None, None]:
        """Yield again and again, each time that the clock has been advanced by an interval."""
        while True:
            sleeper = Sleeper(self._now + seconds)
            self._sleepers.append(sleeper)
            try:
                await sleeper.woken.wait()
                yield
            finally:
                if sleeper.woken.is_set():
                    self._awake -= 1
                    if not self._awake:
                        self._quiet.set()
                else:
                    self._sleepers.remove(sleeper)

    @property
    def next_wake_s(self) -> float:
        """The time at which the next loop wakes, s; infinite if none sleeps."""
        return min((sleeper.until for sleeper in self._sleepers), default=float("inf"))

    async def advance(self, until: float) -> None:
        """Let time pass, and return once all loops that it woke have done their work."""
        self._now = max(self._now, until)
        due = [sleeper for sleeper in self._sleepers if sleeper.until <= self._now]
        for sleeper in due:
            self._sleepers.remove(sleeper)
            sleeper.woken.set()
        if due:
            self._awake += len(due)
            self._quiet.clear()
            await self._quiet.wait()
