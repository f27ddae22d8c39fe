"""Headless runs: queued, run in a process of lower priority, kept in the run table.

The table is the truth: a run that was under way when the server died is marked aborted at the next start.
"""

from __future__ import annotations

import asyncio
import hashlib
import json
import logging
import multiprocessing
import secrets
import shutil
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict
from sqlalchemy import select, update

from core.errors import InputError
from scenarios.kernel_cache import core_hash
from scenarios.schema import Scenario
from server.errors import ApiError, body_of, not_found
from server.metrics import Metrics
from server.runs.worker import PROGRESS, TRACE, prepare, work
from server.settings import Settings
from server.store.database import Database
from server.store.models import RunRow

log = logging.getLogger(__name__)


class Run(BaseModel):
    """A headless run as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    key: str
    state: str
    scenario_id: str
    title: str
    seeds: list[int]
    created: datetime
    finished: datetime | None
    progress: float
    summary: dict[str, Any] | None
    error: dict[str, Any] | None


class Jobs:
    """Queues runs and keeps their results.

    Parameters
    ----------
    database : Database
        Where the run table is.
    settings : Settings
        Limits, number of processes, folder.
    metrics : Metrics
        Where ended runs are counted.
    """

    def __init__(self, database: Database, settings: Settings, metrics: Metrics) -> None:
        self._database, self._settings, self._metrics = database, settings, metrics
        self._folder = settings.data / "runs"
        self._pool: ProcessPoolExecutor | None = None
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._futures: dict[str, Future[dict[str, Any]]] = {}

    async def start(self, scenario: Scenario, seeds: list[int]) -> Run:
        """Queue a run.

        Raises
        ------
        ApiError
            If too many wait, or the run is too long.
        """
        settings = self._settings
        if settings.run_workers == 0:
            raise ApiError(409, "runs_disabled", "this server takes no headless runs (run_workers = 0)")
        if len(self._tasks) >= settings.max_queued_runs:
            raise ApiError(429, "too_many_runs", f"{len(self._tasks)} runs wait or run, the limit (max_queued_runs)")
        ticks = (scenario.samples or 10_000) * len(seeds)
        if ticks > settings.max_run_ticks:
            text = f"this run has {ticks} ticks, the limit is {settings.max_run_ticks} (max_run_ticks)"
            raise ApiError(422, "too_long", text, "scenario")
        document = json.loads(json.dumps(scenario.document, default=str))
        text = json.dumps([document, seeds, core_hash()], sort_keys=True)
        row = RunRow(
            id=secrets.token_hex(16),
            key=hashlib.sha256(text.encode()).hexdigest(),
            state="queued",
            scenario_id=scenario.id,
            title=scenario.head.title,
            document=document,
            seeds=seeds,
        )
        await self._database.run(lambda session: session.add(row))
        self._tasks[row.id] = asyncio.create_task(self._carry_out(row.id, document, seeds))
        return Run.model_validate(row)

    async def all(self, limit: int = 200) -> list[Run]:
        """List runs, newest first."""
        query = select(RunRow).order_by(RunRow.created.desc()).limit(limit)
        rows = await self._database.run(lambda session: list(session.scalars(query)))
        return [self._live(Run.model_validate(row)) for row in rows]

    async def get(self, run_id: str) -> Run:
        """Return one run, or refuse with 404."""
        row = await self._database.run(lambda session: session.get(RunRow, run_id))
        if row is None:
            raise not_found("run", run_id)
        return self._live(Run.model_validate(row))

    async def cancel(self, run_id: str) -> Run:
        """Take a run that waits out of the queue; one under way is left to end."""
        run = await self.get(run_id)
        future = self._futures.get(run_id)
        if future is None or not future.cancel():
            raise ApiError(409, "conflict", f"the run is {run.state}; only a queued one can be cancelled")
        await asyncio.gather(self._tasks[run_id], return_exceptions=True)
        return await self.get(run_id)

    def trace_path(self, run_id: str) -> Path:
        """Return the trace of a run that is done."""
        path = self._folder / run_id / TRACE
        if not path.is_file():
            raise not_found("trace of run", run_id, "a run has a trace once it is done")
        return path

    async def recover(self) -> None:
        """Mark what a crash interrupted."""
        query = select(RunRow.id).where(RunRow.state.in_(("queued", "running")))
        ids = await self._database.run(lambda session: list(session.scalars(query)))
        for run_id in ids:
            await asyncio.to_thread(shutil.rmtree, self._folder / run_id, ignore_errors=True)
            error = {"code": "aborted", "message": "the server stopped before this run was done"}
            await self._update(run_id, state="aborted", finished=datetime.now(UTC), error=error)
        if ids:
            log.warning("%d runs were interrupted and are marked aborted", len(ids))

    async def close(self) -> None:
        """Let go of the queue and the processes."""
        for future in self._futures.values():
            future.cancel()
        pool, self._pool = self._pool, None
        if pool is not None:
            for process in list((pool._processes or {}).values()):
                process.terminate()
            await asyncio.to_thread(pool.shutdown, wait=True, cancel_futures=True)
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)

    async def _carry_out(self, run_id: str, document: dict[str, Any], seeds: list[int]) -> None:
        """Wait for a worker, then for the result; whatever happens ends up in the table."""
        future = self._executor().submit(work, document, seeds, str(self._folder / run_id))
        self._futures[run_id] = future
        values: dict[str, Any]
        try:
            values = {"state": "done", "progress": 1.0, "summary": await asyncio.wrap_future(future)}
        except asyncio.CancelledError:
            values = {"state": "cancelled"}
        except InputError as error:
            values = {"state": "failed", "error": body_of(error).model_dump()}
        except BrokenProcessPool:
            self._pool = None
            values = {"state": "aborted", "error": {"code": "aborted", "message": "the worker process died"}}
        except Exception as error:
            log.exception("run %s failed", run_id)
            values = {"state": "failed", "error": {"code": "internal", "message": str(error)}}
        finally:
            self._futures.pop(run_id, None)
            self._tasks.pop(run_id, None)
        self._metrics.runs.labels(values["state"]).inc()
        await self._update(run_id, finished=datetime.now(UTC), **values)

    async def _update(self, run_id: str, **values: Any) -> None:
        """Change a row."""
        statement = update(RunRow).where(RunRow.id == run_id).values(**values)
        await self._database.run(lambda session: session.execute(statement))

    def _live(self, run: Run) -> Run:
        """Add what only the running process knows: whether it has begun, and how far it is."""
        future = self._futures.get(run.id)
        if future is None or run.state != "queued" or not future.running():
            return run
        try:
            progress = float((self._folder / run.id / PROGRESS).read_text())
        except (OSError, ValueError):
            progress = 0.0
        return run.model_copy(update={"state": "running", "progress": progress})

    def _executor(self) -> ProcessPoolExecutor:
        """Return the pool; its processes are spawned, because forking a process with threads is not safe."""
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(self._settings.run_workers, context, prepare)
        return self._pool
