"""Runs the long computations of campaigns with thousands of points in a process of lower priority.

In a thread of the server they would hold the interpreter's lock against the live benches.
"""

from __future__ import annotations

import asyncio
import json
import multiprocessing
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, TypeVar

from scenarios.campaign.executor import prepare
from scenarios.campaign.parts import Parts
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.report.campaign import surveyed_report
from server.runs.worker import NICE
from server.store.database import Database
from server.store.results import Results

FEW_POINTS, FEW_RUNS = 20, 300
"""So many points or runs are handled in this process; they do not slow the live benches."""
IDLE_S = 60.0
"""A process without work for so long is ended; starting one takes seconds."""

T = TypeVar("T")
Document = dict[str, Any]


class Apart:
    """A process that is started when there is work for it.

    Parameters
    ----------
    few : int
        Campaigns up to this size are handled in a thread.
    """

    def __init__(self, few: int) -> None:
        self._few = few
        self._pool: ProcessPoolExecutor | None = None
        self._waiting = 0
        self._end: asyncio.TimerHandle | None = None

    async def call(self, size: int, function: Callable[..., T], *arguments: object, **named: object) -> T:
        """Call a function on so many points or runs of a campaign, in a thread or in the process."""
        function = partial(function, **named)
        if size <= self._few:
            return await asyncio.to_thread(function, *arguments)
        if self._end is not None:
            self._end.cancel()
        if self._pool is None:  # spawned, because forking a process with threads is not safe
            self._pool = ProcessPoolExecutor(1, multiprocessing.get_context("spawn"), prepare, (NICE,))
        pool = self._pool
        self._waiting += 1
        try:
            return await asyncio.wrap_future(pool.submit(function, *arguments))
        except BrokenProcessPool:
            self._pool = None if self._pool is pool else self._pool
            raise
        finally:
            self._waiting -= 1
            if not self._waiting:
                self._end = asyncio.get_running_loop().call_later(IDLE_S, self.close)

    def close(self) -> None:
        """End the process and its work."""
        pool, self._pool = self._pool, None
        if pool is not None:
            for process in list((pool._processes or {}).values()):
                process.kill()
            pool.shutdown(wait=False, cancel_futures=True)


def examine(document: Document) -> tuple[int, Document]:
    """Check every point of a campaign; return the number of different runs, and the longest scenario."""
    sweep = _swept(json.dumps(document, default=str))
    longest = sweep.longest(sweep.points)
    return len(set(sweep.contents)) * len(sweep.seeds), longest.document


def contents(document: Document) -> list[str]:
    """Return the hashes of the points of a campaign."""
    return list(_swept(json.dumps(document, default=str)).contents)


def keep_up(document: str, folder: Path, database_url: str, *, to_end: bool) -> None:
    """Write the results of a campaign that its files lack."""
    _, parts = campaign(document, folder)
    database = Database(database_url)
    try:
        parts.keep_up(Results(database).outcomes, to_end=to_end)
    finally:
        database.close()


@lru_cache(2)
def campaign(document: str, folder: Path) -> tuple[Sweep, Parts]:
    """Return a campaign and its files; which of them are whole stays known."""
    sweep = _swept(document)
    return sweep, Parts(sweep, folder)


@lru_cache(2)
def _swept(document: str) -> Sweep:
    """Return a campaign; the hashes of its points stay known."""
    return Sweep(json.loads(document))


def report(document: str, folder: Path) -> str:
    """Return the report of a campaign."""
    sweep, parts = campaign(document, folder)
    return surveyed_report(sweep, Survey(sweep, parts))
