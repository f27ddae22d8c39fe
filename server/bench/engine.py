"""The engine: one thread that keeps time, with one worker for each processor to advance benches side by side.

The event loop serves clients; the engine thread advances boards. A busy loop or a slow client delays frames but no
board. A command, a snapshot and a new bench are jobs: the engine runs them between two slices, and the loop awaits
their results. The compiled ticks run without the interpreter's lock, so benches do not wait for each other. One thread
at a time advances a bench. All threads end with the process, however they hang.
"""

from __future__ import annotations

import asyncio
import logging
import os
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any, TypeVar

from server.clock import Clock
from server.lag import Lateness
from server.metrics import Metrics

if TYPE_CHECKING:
    from server.bench.bench import LiveBench

log = logging.getLogger(__name__)
T = TypeVar("T")

PERIOD_S = 1.0 / 120.0
"""Two rounds per screen frame."""

LATE_S, LATE_AGAIN_S = 0.1, 60.0
"""A round this late is logged, and then no other one for a while. The histogram counts all of them."""

SPARE_S = 0.001
"""Part of every round left to the rest of the process when a bench runs as fast as possible."""

PATIENCE_S = 5.0
"""How long the end of a thread is awaited, which may hang in the code of a unit."""

PROCESSORS = os.cpu_count() or 1
"""How many benches are advanced side by side."""


class Job:
    """A function that the engine runs between two slices, and its outcome.

    Parameters
    ----------
    function : callable
        The function.
    """

    def __init__(self, function: Callable[[], Any]) -> None:
        self._function = function
        self.future: Future[Any] = Future()

    def __call__(self) -> None:
        """Run it, unless its caller was cancelled."""
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            self.future.set_result(self._function())
        except BaseException as error:
            self.future.set_exception(error)
            if not isinstance(error, Exception):
                raise


class Helpers:
    """Threads that share the work of another thread.

    Parameters
    ----------
    count : int
        How many.
    """

    def __init__(self, count: int) -> None:
        self._tasks: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self.threads = [
            threading.Thread(target=self._run, name=f"combbench-bench-{number}", daemon=True) for number in range(count)
        ]

    def start(self) -> None:
        """Start the threads."""
        for thread in self.threads:
            thread.start()

    def stop(self) -> None:
        """End the threads after the work in hand."""
        for _ in self.threads:
            self._tasks.put(None)

    def together(self, work: Callable[[], None], count: int) -> None:
        """Do the same work in this thread and in some helpers; return when all have ended."""
        ended: SimpleQueue[BaseException | None] = SimpleQueue()

        def help_along() -> None:
            error: BaseException | None = None
            try:
                work()
            except BaseException as raised:
                error = raised
            ended.put(error)

        for _ in range(count):
            self._tasks.put(help_along)
        work()
        for _ in range(count):
            if (error := ended.get()) is not None:
                raise error

    def _run(self) -> None:
        while (task := self._tasks.get()) is not None:
            task()


class Engine:
    """Advances benches on absolute deadlines.

    Parameters
    ----------
    metrics : Metrics
        Where lateness and rounds are counted.
    on_round : callable
        Called on the engine thread after every round and after every batch of jobs.
    clock : Clock, optional
        Monotonic seconds; the clock of the machine by default.
    """

    def __init__(
        self,
        metrics: Metrics,
        on_round: Callable[[], None],
        clock: Clock | None = None,
    ) -> None:
        self._metrics, self._on_round, self.clock = metrics, on_round, clock or Clock()
        self.lateness = Lateness(metrics.wake_lateness)
        self._work: dict[str, LiveBench] = {}
        self._jobs: deque[Job] = deque()
        self._urgent: deque[Callable[[], None]] = deque()
        self._wake = threading.Condition()
        self._stopping = False
        self._main = threading.Thread(target=self._run, name="combbench-engine", daemon=True)
        self._helpers = Helpers(PROCESSORS - 1)
        self._in_hand: dict[int, LiveBench] = {}
        self._settled: list[Future[None]] = []
        self._beat, self._due = self.clock(), 0.0
        self._silent_until = 0.0

    def start(self) -> None:
        """Start the threads."""
        self._helpers.start()
        self._main.start()

    def stop(self) -> None:
        """End the threads after the slice in hand; jobs still waiting are done first."""
        with self._wake:
            self._stopping = True
            self._wake.notify()
        self._main.join(timeout=PATIENCE_S)
        self._helpers.stop()
        if not self._main.is_alive():
            for thread in self._helpers.threads:  # compiled code must not run while the interpreter ends
                thread.join(timeout=PATIENCE_S)

    @property
    def is_alive(self) -> bool:
        """Whether the thread turns: it wakes at least once a second."""
        return self._main.is_alive() and self.clock() - self._beat < 3.0

    @property
    def has_ended(self) -> bool:
        """Whether the thread that keeps time has broken off."""
        return not self._main.is_alive()

    @property
    def threads(self) -> list[threading.Thread]:
        """The threads that have not ended."""
        return [thread for thread in (self._main, *self._helpers.threads) if thread.is_alive()]

    @property
    def held(self) -> list[LiveBench]:
        """The benches in whose slices the threads are."""
        return list(self._in_hand.copy().values())

    @property
    def expected(self) -> float:
        """The moment of its last sign of life, the beginning of a round, a slice or a job; or of the next due."""
        return max(self._beat, self._due)

    @property
    def running(self) -> list[LiveBench]:
        """The benches whose time runs."""
        return [work for work in list(self._work.values()) if work.time.is_running]

    async def call(self, function: Callable[..., T], *arguments: Any) -> T:
        """Run a function between two slices and return its result.

        Raises
        ------
        Exception
            The error that the function raises.
        """
        return await asyncio.wrap_future(self.submit(function, *arguments))

    def submit(self, function: Callable[..., T], *arguments: Any) -> Future[T]:
        """Queue a function to run between two slices."""
        job = Job(lambda: function(*arguments))
        with self._wake:
            if self._stopping:
                raise RuntimeError("the engine has stopped")
            self._jobs.append(job)
            self._wake.notify()
        return job.future

    async def settle(self) -> None:
        """Return once all jobs are done and every bench has reached its tick; for a manual clock."""
        settled: Future[None] = Future()
        with self._wake:
            self._settled.append(settled)
            self._wake.notify()
        await asyncio.wrap_future(settled)

    def interrupt(self, function: Callable[[], None]) -> None:
        """Run a function before the next slice of any bench and before every job; it must not raise an error."""
        self._urgent.appendleft(function)
        with self._wake:
            self._wake.notify()

    def add(self, bench: LiveBench) -> None:
        """Add a bench (a job)."""
        self._work[bench.id] = bench

    def remove(self, bench_id: str) -> None:
        """Remove a bench (a job)."""
        self._work.pop(bench_id, None)

    def _run(self) -> None:
        """Turn until the end."""
        try:
            self._turn()
        except BaseException:
            log.critical("the thread of the engine broke off", exc_info=True)

    def _turn(self) -> None:
        """Wait for a deadline or a job, serve it, and repeat."""
        deadline = served = self.clock()
        while True:
            running = self.running
            if self.clock.is_manual and (self.clock() > served or any(work.time.is_hurried for work in running)):
                deadline = self.clock()
            stopping = self._wait(deadline if running else None)
            self._beat = self.clock()
            if self._run_jobs():
                self._on_round()
            if stopping:
                return
            now = self.clock()
            if not running:
                deadline = now
            elif now >= deadline:
                self.lateness.add(now - deadline)
                if now - deadline > LATE_S and now > self._silent_until:
                    self._silent_until = now + LATE_AGAIN_S
                    log.warning("the engine woke %.0f ms late", 1e3 * (now - deadline))
                whole = self._round(now, deadline + PERIOD_S)
                self._on_round()
                if not whole:
                    continue
                served = now
                deadline += PERIOD_S
                if deadline < self.clock() - PERIOD_S:
                    deadline = self.clock()

    def _wait(self, deadline: float | None) -> bool:
        """Sleep until the deadline, a job or the end."""
        with self._wake:
            if not self._jobs and not self._urgent and not self._stopping:
                now = self.clock()
                pause = 1.0 if deadline is None else deadline - now
                if pause > 0:
                    while self._settled:
                        self._settled.pop().set_result(None)
                    self._due = now + pause
                    self.clock.wait(self._wake, pause)
                    self._due = 0.0
            return self._stopping

    def _run_jobs(self) -> bool:
        """Run all that is urgent, and every job that waits; true if there was one."""
        done = False
        while self._urgent or self._jobs:
            if self._urgent:
                self._urgent.popleft()()
            else:
                self._beat = self.clock()
                self._jobs.popleft()()
            done = True
        return done

    def _round(self, now: float, end: float) -> bool:
        """Bring every paced bench to its target, slice by slice in turn, then spend the rest of the round on free ones.

        A job may change the target of a bench, so the round ends after it (false) and another begins.
        """
        targets = [(work, work.time.target(now)) for work in self._work.values() if work.time.is_running]
        paced = [pair for pair in targets if pair[1] is not None]
        free = [pair for pair in targets if pair[1] is None]
        spare_from = now if self.clock.is_manual else end - SPARE_S  # one slice each where no time passes meanwhile
        if not (self._turns(paced, end) and self._turns(free, spare_from)):
            return False
        done = self.clock()
        for work, target in targets:
            work.time.finish_round(target, done)
        self._metrics.round_seconds.observe(done - now)
        return True

    def _turns(self, pairs: list[tuple[LiveBench, int | None]], end: float) -> bool:
        """Give each bench one slice in turn until all are at their targets or the round is over; false after a job.

        Every processor takes the next bench that is waiting: handing a bench to a thread costs more than a slice.
        """
        waiting = deque((work, target, True) for work, target in pairs)

        def share() -> None:
            while waiting:
                try:
                    work, target, first = waiting.popleft()
                except IndexError:  # another has just taken the last
                    return
                if not first and (self._jobs or self.clock() >= end):
                    return
                if self._slice(work, target):
                    waiting.append((work, target, False))

        self._helpers.together(share, max(0, min(len(pairs), PROCESSORS) - 1))
        return not self._run_jobs()

    def _slice(self, work: LiveBench, target: int | None) -> bool:
        """Advance one bench; an unexpected error stops that bench alone."""
        if self._urgent or not work.time.is_running:
            return False
        self._in_hand[threading.get_ident()] = work
        self._beat = self.clock()
        try:
            return work.time.slice(target)
        except Exception as error:
            log.exception("bench %s failed", work.id)
            work.fail(error)
            return False
        finally:
            self._in_hand.pop(threading.get_ident(), None)
