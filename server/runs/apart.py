"""Makes rows of the results of campaigns with thousands of runs in a process of lower priority.

In a thread of the server they would hold the interpreter's lock against the live benches.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, TypeVar

from scenarios.campaign.executor import pool
from scenarios.campaign.parquet import ParquetParts
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.report.campaign import surveyed_report
from server.runs.worker import NICE
from server.store.database import Database
from server.store.results import Results

FEW_RUNS = 300
"""So many runs are handled in this process; they do not slow the live benches."""
IDLE_S = 60.0
"""A process without work for so long is ended; it has a library of its own to load."""

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
        """Call a function on a number of runs of a campaign, in a thread or in the process."""
        function = partial(function, **named)
        if size <= self._few:
            return await asyncio.to_thread(function, *arguments)
        if self._end is not None:
            self._end.cancel()
        if self._pool is None:
            self._pool = pool(1, NICE)
        used = self._pool
        self._waiting += 1
        try:
            return await asyncio.wrap_future(await asyncio.to_thread(used.submit, function, *arguments))
        except BrokenProcessPool:
            self._pool = None if self._pool is used else self._pool
            raise
        finally:
            self._waiting -= 1
            if not self._waiting:
                self._end = asyncio.get_running_loop().call_later(IDLE_S, self.close)

    def close(self) -> None:
        """End the process and its work."""
        ended, self._pool = self._pool, None
        if ended is not None:
            for process in list((ended._processes or {}).values()):
                process.kill()
            ended.shutdown(wait=False, cancel_futures=True)


def keep_up(document: str, folder: Path, database_url: str, *, to_end: bool, begin: bool = False) -> None:
    """Write the results of a campaign that its files lack, or only the first of them."""
    _, parts = campaign(document, folder)
    database = Database(database_url)
    try:
        read = Results(database).outcomes
        parts.begin(read) if begin else parts.keep_up(read, to_end=to_end)
    finally:
        database.close()


@lru_cache(2)
def campaign(document: str, folder: Path) -> tuple[Sweep, ParquetParts]:
    """Return a campaign and its files; which of them are whole stays known."""
    sweep = Sweep(json.loads(document))
    return sweep, ParquetParts(sweep, folder)


def report(document: str, folder: Path, name: str) -> str:
    """Return the report of a campaign, headed by the name it was given."""
    sweep, parts = campaign(document, folder)
    return surveyed_report(sweep, Survey(sweep, parts), name)
