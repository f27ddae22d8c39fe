"""Runs the long computations of campaigns with thousands of points in a process of lower priority.

In a thread of the server they would hold the interpreter's lock against the live benches.
"""

from __future__ import annotations

import asyncio
import multiprocessing
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any, TypeVar

import pyarrow as pa
from pydantic import TypeAdapter

from scenarios.campaign.executor import prepare
from scenarios.campaign.outcome import Outcome
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import PointTally, tally
from scenarios.report.campaign import campaign_report, results_table
from server.runs.worker import NICE
from server.store.database import Database
from server.store.results import Results

FEW_POINTS, FEW_RUNS = 20, 300
"""Campaigns up to this size are handled in this process; they do not slow the live benches."""
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

    async def call(self, size: int, function: Callable[..., T], *arguments: object) -> T:
        """Call a function on a campaign of ``size`` points, in a thread or in the process."""
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
    sweep = Sweep(document)
    longest = sweep.longest(sweep.points)
    return len(set(sweep.contents)) * len(sweep.seeds), longest.document


def contents(document: Document) -> list[str]:
    """Return the hashes of the points of a campaign."""
    return Sweep(document).contents


def points(document: Document, database_url: str) -> bytes:
    """Return the results of a campaign, added up point by point, as JSON."""
    sweep, outcomes = _read(document, database_url)
    return TypeAdapter(list[PointTally]).dump_json(tally(sweep, outcomes))


def table(document: Document, database_url: str) -> pa.Table:
    """Return the results of a campaign, one row for each run."""
    return results_table(*_read(document, database_url))


def report(document: Document, database_url: str) -> str:
    """Return the report of a campaign."""
    sweep, outcomes = _read(document, database_url)
    return campaign_report(sweep, tally(sweep, outcomes))


def _read(document: Document, database_url: str) -> tuple[Sweep, dict[str, Outcome]]:
    sweep = Sweep(document)
    keys = list(dict.fromkeys(key for key, _, _ in sweep.runs()))
    database = Database(database_url)
    try:
        return sweep, {key: Outcome.model_validate_json(text) for key, text in Results(database).outcomes(keys)}
    finally:
        database.close()
