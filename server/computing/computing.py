"""The one place that computes for requests: processes with limits, and a budget for each student."""

from __future__ import annotations

import asyncio
import math
from collections import deque
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from importlib import import_module
from typing import Any, TypeVar
from weakref import WeakValueDictionary

from core.errors import InputError
from core.own.admission import terms
from scenarios.campaign.executor import Processes, preload
from server.computing.asker import asker
from server.computing.limits import MOST_BYTES, EndedWork, within
from server.errors import ApiError
from server.security.limits import Buckets

NICE = 5
"""Niceness of the processes: benches come before them, headless runs after."""
WORKERS = 2
"""Processes that compute: while one is busy with something long, another is free."""
MOST_S = 4.0
"""Processor time of a request of a student."""
LONGEST_S = 30.0
"""Processor time of a request of the teacher, and of an experiment on a copy of a bench, one at a time."""
PATIENCE = 10.0
"""Times the processor time of a request that it may last: the machine has other work too."""
BUDGET_S, EARNED = 10.0, 0.25
"""Processor time that a student may use at once, and that comes back each second."""
MOST_SPENT_S = 1.0
"""Processor time of a bench that counts: a kernel that is compiled meanwhile is not the student's to pay."""

LOADED = "server.computing.loaded"
T = TypeVar("T")


class Computing:
    """Computes for one student one request at a time, in processes that are replaced when they pass a limit.

    Parameters
    ----------
    clock : callable
        Seconds, of the budgets.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        preload(LOADED)
        self._free = deque(Processes(1, NICE) for _ in range(WORKERS))
        self._all = [*self._free]
        self._room = asyncio.Semaphore(WORKERS)
        self._turns: WeakValueDictionary[str, asyncio.Lock] = WeakValueDictionary()
        self._budgets = Buckets(EARNED, BUDGET_S, clock=clock)

    async def call(self, function: Callable[..., T], *arguments: Any, most_s: float | None = None) -> T:
        """Call a function of a module, for the person whose request is at work; arguments and result are pickled.

        Raises
        ------
        InputError
            As the function, or when that takes too much.
        ApiError
            When a student has used up the budget.
        """
        person = asker()
        if not person:
            return await self._call(person, most_s or LONGEST_S, function, *arguments)
        turn = self._turns.setdefault(person, asyncio.Lock())
        async with turn:
            self.check_budget()
            return await self._call(person, most_s or MOST_S, function, *arguments)

    def check_budget(self) -> None:
        """Refuse a request of a student without budget."""
        if (person := asker()) and not self._budgets.take(person, 0.0):
            text = f"your requests have taken more than {BUDGET_S:g} s of processor time"
            wait = math.ceil(1.0 / EARNED)
            raise ApiError(429, "rate_limited", text, hint=f"wait {wait} s", headers={"Retry-After": str(wait)})

    def spend(self, seconds: float) -> None:
        """Count processor time that the server itself has used for the request at work."""
        if person := asker():
            self._budgets.take(person, min(seconds, MOST_SPENT_S))

    async def warm(self, ready: Callable[[], Any]) -> None:
        """Start the processes before the first request, once the kernels are compiled."""
        await ready()
        for worker in self._all:
            await asyncio.to_thread(worker.submit, load)

    def close(self) -> None:
        """End the processes and their work."""
        for worker in self._all:
            worker.kill()
            worker.shutdown(wait=False)

    async def _call(self, person: str, most_s: float, function: Callable[..., T], *arguments: Any) -> T:
        async with self._room:
            worker = self._free.popleft()
            used_s = most_s
            try:
                done = await _done(worker, most_s, function, *arguments)
                used_s = done.used_s
            finally:
                self._free.append(worker)
                self._budgets.take(person, used_s)
        if done.refusal is not None:
            raise InputError(*done.refusal)
        return done.value  # type: ignore[no-any-return]


async def _done(worker: Processes, most_s: float, function: Callable[..., Any], *arguments: Any) -> EndedWork:
    """Call a function in a process; end the process if the request is cancelled."""
    too_much = InputError(
        f"takes more than {most_s:g} s of processor time or {MOST_BYTES >> 20} MB of memory", code="too_much"
    )
    work = partial(worker.submit, within, most_s, terms(), function, *arguments)
    try:
        future = await asyncio.to_thread(work)
    except BrokenProcessPool:  # the process has ended since the last request
        await _start(worker)
        future = await asyncio.to_thread(work)
    try:
        async with asyncio.timeout(PATIENCE * most_s):
            return await asyncio.wrap_future(future)
    except BrokenProcessPool:
        await _start(worker)
        raise too_much from None
    except TimeoutError:
        raise too_much from None
    finally:
        if not future.done():  # out of patience, or the request is cancelled
            worker.kill()
            await asyncio.wait([asyncio.wrap_future(future)])


async def _start(worker: Processes) -> None:
    """Start a process in place of the ended one: a machine on which none starts is at fault, not the request."""
    try:
        await asyncio.wrap_future(await asyncio.to_thread(worker.submit, load))
    except BrokenProcessPool:
        text = "the process that computes for requests does not start; the log of the server says why"
        raise ApiError(503, "unavailable", text) from None


def load() -> None:
    """Load the code of all computations, in the process that computes, where it is not there from the beginning."""
    import_module(LOADED)
