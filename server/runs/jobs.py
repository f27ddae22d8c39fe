"""Headless runs: queued, run in a process of lower priority, kept in the run table.

The run table has the state of every run. Scenario, seeds and version are the key of a run, so a second request gives
the same run. A run that was under way when the server ended begins again at the next start; it is marked aborted if
that happens often.
"""

from __future__ import annotations

import asyncio
import json
import logging
import multiprocessing
import shutil
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any, TypeVar

from sqlalchemy import select, update
from sqlalchemy.orm import Session

from core.errors import InputError
from scenarios.campaign.executor import prepare
from scenarios.key import content_hash, run_key
from scenarios.schema import Scenario
from server.errors import ApiError, body_of, not_found
from server.metrics import Metrics
from server.runs.length import check_length
from server.runs.listing import ACTIVE, Run, RunFilter, remove, rename
from server.runs.worker import CANCEL, NICE, PROGRESS, STEM, Cancelled, work
from server.settings import Settings
from server.store.database import Database
from server.store.models import RunRow, now

log = logging.getLogger(__name__)

MAX_ATTEMPTS = 3
"""Most starts of one run: a run that so often was under way when the server or its worker ended is the likely cause."""
CANCEL_S = 5.0
T = TypeVar("T")


def identify(scenario: Scenario, seeds: list[int]) -> tuple[dict[str, Any], str]:
    """Return the document of a run as it is kept, and its key."""
    document = json.loads(json.dumps(scenario.document, default=str))
    return document, run_key(content_hash(document), *seeds)


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
        self._turn = asyncio.Semaphore(max(1, settings.run_workers))
        self._is_closing = False

    async def start(self, scenario: Scenario, seeds: list[int], label: str = "") -> tuple[Run, bool]:
        """Queue a run, or return the same one if it exists; true when it is new. A name it is given is its name then.

        Raises
        ------
        ApiError
            If too many wait, or the run is too long, or its trace too large.
        """
        settings = self._settings
        if settings.run_workers == 0:
            raise ApiError(409, "runs_disabled", "this server takes no headless runs (run_workers = 0)")
        await asyncio.to_thread(check_length, scenario, len(seeds), settings, "this run", "scenario")
        document, key = identify(scenario, seeds)
        row = RunRow(
            id=key[:32],
            key=key,
            state="queued",
            scenario_id=scenario.id,
            title=scenario.head.title,
            label=label,
            document=document,
            seeds=seeds,
            created=now(),
            attempts=0,
            progress=0.0,
            finished=None,
            summary=None,
            error=None,
        )
        has_room = len(self._tasks) < settings.max_queued_runs

        def settle(session: Session) -> RunRow | None:
            known = session.get(RunRow, row.id)
            if known is not None and (known.state in ACTIVE or known.state == "done"):
                known.label = label or known.label
                return known
            row.label = row.label or (known.label if known is not None else "")
            if has_room:
                session.merge(row)
            return None

        known = await self._database.run(settle)
        if known is not None:
            return self._live(Run.model_validate(known)), False
        if not has_room:
            raise ApiError(429, "too_many_runs", f"{len(self._tasks)} runs wait or run, the limit (max_queued_runs)")
        self._queue(row.id, document, seeds)
        return Run.model_validate(row), True

    def _queue(self, run_id: str, document: dict[str, Any], seeds: list[int]) -> None:
        """Carry a run out in its turn."""
        self._tasks[run_id] = asyncio.create_task(self._carry_out(run_id, document, seeds))

    async def all(self, wanted: RunFilter) -> list[Run]:
        """List the runs that are asked for, newest first."""
        query = wanted.of(RunRow)
        rows = await self._database.run(lambda session: list(session.scalars(query)))
        return [self._live(Run.model_validate(row)) for row in rows]

    async def some(self, run_ids: list[str]) -> dict[str, Run]:
        """Return those of some runs that are known."""
        query = select(RunRow).where(RunRow.id.in_(run_ids))
        rows = await self._database.run(lambda session: list(session.scalars(query)))
        return {row.id: self._live(Run.model_validate(row)) for row in rows}

    async def get(self, run_id: str) -> Run:
        """Return one run, or refuse with 404."""
        row = await self._database.run(lambda session: session.get(RunRow, run_id))
        if row is None:
            raise not_found("run", run_id)
        return self._live(Run.model_validate(row))

    async def rename(self, run_id: str, label: str) -> Run:
        """Give a run a name."""
        await rename(self._database, RunRow, "run", run_id, label)
        return await self.get(run_id)

    async def remove(self, run_ids: list[str] | None) -> int:
        """Remove runs that have ended, all of them if none is named, with their files."""
        return await remove(self._database, RunRow, "run", run_ids, self._folder)

    async def cancel(self, run_id: str) -> Run:
        """End a run that waits or is under way; a study under way goes on to its end, and its result is dropped."""
        run = await self.get(run_id)
        task = self._tasks.get(run_id)
        if task is None:
            raise ApiError(409, "conflict", f"the run is {run.state}; it cannot be cancelled any more")
        if run_id not in self._futures:
            task.cancel()
        else:
            place = self._folder / run_id
            await asyncio.to_thread(place.mkdir, parents=True, exist_ok=True)
            await asyncio.to_thread((place / CANCEL).touch)
        await asyncio.wait([task], timeout=CANCEL_S)
        return await self.get(run_id)

    async def apart(self, function: Callable[..., T], *arguments: object) -> T:
        """Call a function in a worker process, in turn with the runs.

        Raises
        ------
        RuntimeError
            When the worker died.
        """
        async with self._turn:
            pool = self._executor()
            try:
                return await asyncio.wrap_future(pool.submit(function, *arguments))
            except BrokenProcessPool:
                self._pool = None if self._pool is pool else self._pool
                raise RuntimeError("its worker process died") from None

    async def traces(self, run_ids: list[str]) -> tuple[list[Run], list[Path]]:
        """Return runs, and where their traces are if they have any."""
        runs = [await self.get(run_id) for run_id in run_ids]
        return runs, [(self._folder / run.id / STEM).with_suffix(".parquet") for run in runs]

    async def file(self, run_id: str, ending: str) -> tuple[Run, Path]:
        """Return a run that is done, and one of its files."""
        run = await self.get(run_id)
        path = (self._folder / run.id / STEM).with_suffix(ending)
        if run.state != "done" or not path.is_file():
            raise not_found(f"{ending[1:]} file of run", run_id, "a run has its files once it is done")
        return run, path

    async def recover(self) -> None:
        """Begin again the runs that the end of the server interrupted; give up those begun too often."""
        query = select(RunRow).where(RunRow.state.in_(ACTIVE)).order_by(RunRow.created)
        for row in await self._database.run(lambda session: list(session.scalars(query))):
            if row.attempts >= MAX_ATTEMPTS or self._settings.run_workers == 0:
                text = f"the server stopped before this run was done, {row.attempts} times"
                await self._end(row.id, "aborted", error={"code": "aborted", "message": text})
                continue
            log.info("run %s begins again", row.id)
            self._queue(row.id, row.document, row.seeds)

    async def close(self) -> None:
        """End the queue and the processes; unfinished runs begin again at the next start."""
        self._is_closing = True
        for run_id, task in self._tasks.items():
            if run_id not in self._futures:
                task.cancel()
        pool, self._pool = self._pool, None
        if pool is not None:
            for process in list((pool._processes or {}).values()):
                process.terminate()
            await asyncio.to_thread(pool.shutdown, wait=True, cancel_futures=True)
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)

    async def _carry_out(self, run_id: str, document: dict[str, Any], seeds: list[int]) -> None:
        """Wait for a worker, then for the result; write every outcome into the table."""
        state, values = "lost", dict[str, Any]()
        try:
            async with self._turn:
                while state == "lost" and not self._is_closing:
                    state, values = await self._attempt(run_id, document, seeds)
        except asyncio.CancelledError:
            state = "cancelled"
        except Exception as error:
            log.exception("run %s failed", run_id)
            state, values = "failed", {"error": {"code": "internal", "message": str(error)}}
        finally:
            self._futures.pop(run_id, None)
            self._tasks.pop(run_id, None)
        if state == "cancelled":
            await asyncio.to_thread(shutil.rmtree, self._folder / run_id, ignore_errors=True)
        if state == "done" or not self._is_closing:
            await self._end(run_id, state, **values)

    async def _attempt(self, run_id: str, document: dict[str, Any], seeds: list[int]) -> tuple[str, dict[str, Any]]:
        """Run in a worker; return ``lost`` when the worker died and another try makes sense."""
        await self._update(run_id, state="running", attempts=RunRow.attempts + 1)
        place = self._folder / run_id
        await asyncio.to_thread(shutil.rmtree, place, ignore_errors=True)
        pool = self._executor()
        future = self._futures[run_id] = pool.submit(
            work, document, seeds, str(place), self._settings.max_run_mb * 1_000_000
        )
        try:
            summary = await asyncio.wrap_future(future)
        except Cancelled:
            return "cancelled", {}
        except InputError as error:
            return "failed", {"error": body_of(error).model_dump()}
        except BrokenProcessPool:
            self._pool = None if self._pool is pool else self._pool
            row = await self._database.run(lambda session: session.get(RunRow, run_id))
            if row is not None and row.attempts < MAX_ATTEMPTS:
                log.warning("the worker of run %s died; it begins again", run_id)
                return "lost", {}
            text = f"its worker process died {MAX_ATTEMPTS} times"
            return "aborted", {"error": {"code": "aborted", "message": text}}
        except OSError as error:
            log.exception("run %s failed", run_id)
            text = f"the disk failed: {error.strerror or error}"
            return "failed", {"error": {"code": "no_space", "message": text}}
        if (place / CANCEL).exists():
            return "cancelled", {}
        return "done", {"progress": 1.0, "summary": summary}

    async def _end(self, run_id: str, state: str, **values: Any) -> None:
        """Note how a run ended."""
        self._metrics.runs.labels(state).inc()
        await self._update(run_id, state=state, finished=now(), **values)

    async def _update(self, run_id: str, **values: Any) -> None:
        """Change a row."""
        statement = update(RunRow).where(RunRow.id == run_id).values(**values)
        await self._database.run(lambda session: session.execute(statement))

    def _live(self, run: Run) -> Run:
        """Add the progress of a run, which its worker writes."""
        if run.state != "running":
            return run
        try:
            progress = float((self._folder / run.id / PROGRESS).read_text())
        except (OSError, ValueError):
            progress = 0.0
        return run.model_copy(update={"progress": progress})

    def _executor(self) -> ProcessPoolExecutor:
        """Return the pool; its processes are spawned, because forking a process with threads is not safe."""
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(self._settings.run_workers, context, prepare, (NICE,))
        return self._pool
