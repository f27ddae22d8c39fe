"""The engine: one thread that keeps time, with one worker for each processor to advance benches side by side.

The event loop serves clients; the engine thread advances boards. A busy loop or a slow client delays frames but no
board. A command, a snapshot and a new bench are jobs: the engine runs them between two slices, and the loop awaits
their results. The compiled ticks run without the interpreter's lock, so benches do not wait for each other. One thread
at a time advances a bench.
"""

from __future__ import annotations

import asyncio
import logging
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, Protocol, TypeVar

from server.lag import Lateness
from server.metrics import Metrics

log = logging.getLogger(__name__)
T = TypeVar("T")

PERIOD_S = 1.0 / 120.0
"""Two rounds per screen frame."""

LATE_S, LATE_AGAIN_S = 0.1, 60.0
"""A round this late is logged, and then no other one for a while. The histogram counts all of them."""

SPARE_S = 0.001
"""Part of every round left to the rest of the process when a bench runs as fast as possible."""


PROCESSORS = os.cpu_count() or 1
"""How many benches are advanced side by side."""


class Workload(Protocol):
    """The part of a live bench that the engine uses."""

    id: str

    @property
    def is_running(self) -> bool:
        """Whether it wants to advance."""

    def target(self, now: float) -> int | None:
        """Return the tick to reach in this round; none means no limit."""

    def slice(self, target: int | None) -> bool:
        """Advance by one slice of at most 5 ms; true while the target is not reached."""

    def finish_round(self, target: int | None, now: float) -> None:
        """Account for the round."""

    def fail(self, error: Exception) -> None:
        """Stop after an error nobody expected."""


class Engine:
    """Advances benches on absolute deadlines.

    Parameters
    ----------
    metrics : Metrics
        Where lateness and rounds are counted.
    on_round : callable
        Called on the engine thread after every round and after every batch of jobs.
    clock : callable
        Monotonic seconds.
    """

    def __init__(
        self,
        metrics: Metrics,
        on_round: Callable[[], None],
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._metrics, self._on_round, self.clock = metrics, on_round, clock
        self.lateness = Lateness(metrics.wake_lateness)
        self._work: dict[str, Workload] = {}
        self._jobs: deque[Callable[[], None]] = deque()
        self._wake = threading.Condition()
        self._stopping = False
        self._thread = threading.Thread(target=self._run, name="combbench-engine", daemon=True)
        self._workers = ThreadPoolExecutor(PROCESSORS, thread_name_prefix="combbench-bench")
        self._beat = clock()
        self._silent_until = 0.0

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """End the thread after the slice in hand; jobs still waiting are done first."""
        with self._wake:
            self._stopping = True
            self._wake.notify()
        self._thread.join(timeout=5.0)
        self._workers.shutdown()

    @property
    def is_alive(self) -> bool:
        """Whether the thread turns: it wakes at least once a second."""
        return self._thread.is_alive() and self.clock() - self._beat < 3.0

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
        future: Future[T] = Future()

        def job() -> None:
            if not future.set_running_or_notify_cancel():
                return
            try:
                future.set_result(function(*arguments))
            except Exception as error:
                future.set_exception(error)

        with self._wake:
            if self._stopping:
                raise RuntimeError("the engine has stopped")
            self._jobs.append(job)
            self._wake.notify()
        return future

    def add(self, workload: Workload) -> None:
        """Add a bench (a job)."""
        self._work[workload.id] = workload

    def remove(self, workload_id: str) -> None:
        """Remove a bench (a job)."""
        self._work.pop(workload_id, None)

    def _run(self) -> None:
        """Wait for a deadline or a job, serve it, and repeat."""
        deadline = self.clock()
        while True:
            running = any(work.is_running for work in self._work.values())
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
                deadline += PERIOD_S
                if deadline < self.clock() - PERIOD_S:
                    deadline = self.clock()

    def _wait(self, deadline: float | None) -> bool:
        """Sleep until the deadline, a job or the end."""
        with self._wake:
            if not self._jobs and not self._stopping:
                pause = 1.0 if deadline is None else deadline - self.clock()
                if pause > 0:
                    self._wake.wait(pause)
            return self._stopping

    def _run_jobs(self) -> bool:
        """Run every job that waits; true if there was one."""
        done = False
        while self._jobs:
            self._jobs.popleft()()
            done = True
        return done

    def _round(self, now: float, end: float) -> bool:
        """Bring every paced bench to its target, slice by slice in turn, then spend the rest of the round on free ones.

        A job may change what a bench should do, so the round ends there (false) and another begins.
        """
        targets = [(work, work.target(now)) for work in self._work.values() if work.is_running]
        paced = [pair for pair in targets if pair[1] is not None]
        free = [pair for pair in targets if pair[1] is None]
        if not (self._turns(paced, end) and self._turns(free, end - SPARE_S)):
            return False
        done = self.clock()
        for work, target in targets:
            work.finish_round(target, done)
        self._metrics.round_seconds.observe(done - now)
        return True

    def _turns(self, pairs: list[tuple[Workload, int | None]], end: float) -> bool:
        """Give each bench one slice in turn until all are there or the round is over; false after a job.

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

        others = [self._workers.submit(share) for _ in range(min(len(pairs), PROCESSORS) - 1)]
        share()
        for other in others:
            other.result()
        return not self._run_jobs()

    def _slice(self, work: Workload, target: int | None) -> bool:
        """Advance one bench; an unexpected error stops that bench alone."""
        if not work.is_running:
            return False
        try:
            return work.slice(target)
        except Exception as error:
            log.exception("bench %s failed", work.id)
            work.fail(error)
            return False
