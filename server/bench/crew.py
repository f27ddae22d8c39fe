"""The threads that turn the engine: one thread keeps time, and helpers advance benches in parallel.

The watchdog leaves a crew behind that hangs, and another takes its place. Until then a thread has its present work to
itself. A thread of the old crew that wakes up ends before its next line.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from typing import Generic, TypeVar

T = TypeVar("T")


class LeftBehind(BaseException):
    """Ends a thread whose place another has taken."""


class Crew(Generic[T]):
    """Threads that end with the process, however they hang.

    Parameters
    ----------
    run : callable
        The work of the thread that keeps time.
    helpers : int
        Threads in addition to the timing thread.
    """

    def __init__(self, run: Callable[[], None], helpers: int) -> None:
        self._tasks: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self.main = threading.Thread(target=run, name="combbench-engine", daemon=True)
        self._helpers = [
            threading.Thread(target=self._help, name=f"combbench-bench-{number}", daemon=True)
            for number in range(helpers)
        ]
        self.in_hand: dict[int, T] = {}
        """The work of each thread, by the number of the thread."""

    @property
    def threads(self) -> list[threading.Thread]:
        """The threads that have not ended."""
        return [thread for thread in (self.main, *self._helpers) if thread.is_alive()]

    @property
    def held(self) -> list[T]:
        """The work of its threads; a thread that has ended has none."""
        in_hand = self.in_hand.copy()
        return [in_hand[number] for thread in self.threads if (number := thread.ident or 0) in in_hand]

    def start(self) -> None:
        """Start the helpers, then the thread that keeps time."""
        for thread in (*self._helpers, self.main):
            thread.start()

    def together(self, work: Callable[[], None], helpers: int) -> None:
        """Do the same work in this thread and in some helpers; return when all have ended."""
        ended: SimpleQueue[BaseException | None] = SimpleQueue()

        def help_along() -> None:
            error: BaseException | None = None
            try:
                work()
            except BaseException as raised:
                error = raised
            ended.put(error)

        for _ in range(helpers):
            self._tasks.put(help_along)
        work()
        for _ in range(helpers):
            if (error := ended.get()) is not None:
                raise error

    def leave(self) -> None:
        """End idle threads now, and end hanging threads before they would run their next line."""
        for thread in self.threads:
            if thread is self.main or thread.ident in self.in_hand:
                number, error = ctypes.c_ulong(thread.ident or 0), ctypes.py_object(LeftBehind)
                ctypes.pythonapi.PyThreadState_SetAsyncExc(number, error)
        for _ in self._helpers:
            self._tasks.put(None)

    def _help(self) -> None:
        """Take tasks until the end."""
        with suppress(LeftBehind):
            while (task := self._tasks.get()) is not None:
                task()
