"""The queue of all that is computed headless: runs with their seeds, and campaigns.

A row has the request and its end, the table of results the finished work. Work that the end of the server interrupted
continues at the next start with the missing runs, and fails if that happens often.

Everything under way is a campaign, and shares the worker processes batch by batch. Campaigns take their turn one after
the other, with single runs in parallel, as many as there are processes: a run waits for the batches that a campaign has
handed over, and for no more of it.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
import os
import shutil
from abc import ABC, abstractmethod
from collections.abc import Awaitable, Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ClassVar, Generic, TypeVar

from pydantic import BaseModel
from sqlalchemy.exc import DBAPIError

from core.errors import InputError
from scenarios.campaign.campaign import ATTEMPTS, Campaign, Stopped
from scenarios.campaign.executor import Processes
from scenarios.key import code_version
from scenarios.run import DEFAULT_SAMPLES
from scenarios.schema import Scenario
from server.errors import ApiError, body_of
from server.metrics import Metrics
from server.paging import ListPage
from server.progress import Ending, ProgressStreams, WorkProgress
from server.runs.listing import ACTIVE, Kind, Requests, RunFilter, change, fresh
from server.runs.worker import NICE, NotKept
from server.settings import Settings
from server.store.base import now
from server.store.database import Database, reason_of
from server.store.models import RequestRow
from server.store.results import Results

log = logging.getLogger(__name__)

Shown = TypeVar("Shown", bound=BaseModel)
CANCEL_S = 5.0
LONGEST_WAIT_S = 5
"""Between two tries to note how a request ended; the first two follow at once."""


class Requested(ABC, Generic[Shown]):
    """The requests of one kind: how they become campaigns, and how the interface shows them.

    Parameters
    ----------
    queue : Queue
        Carries them out.
    settings : Settings
        Limits.
    """

    kind: ClassVar[Kind]

    def __init__(self, queue: Queue, settings: Settings) -> None:
        self._queue, self._requests, self._settings = queue, queue.requests, settings
        queue.kinds[self.kind] = self

    @abstractmethod
    async def campaign(self, row: RequestRow, on_progress: Callable[[int, int], None]) -> Campaign:
        """Return a request as a campaign."""

    @property
    def has_workers(self) -> bool:
        """Whether there are processes for such requests."""
        return self._settings.run_workers > 0

    def check_enabled(self) -> None:
        """Refuse all requests of a server without processes for them."""
        if not self.has_workers:
            raise ApiError(409, "runs_disabled", "this server takes no headless runs (run_workers = 0)")

    async def enter(self, **values: Any) -> tuple[Shown, bool]:
        """Queue a request, or return the same one if it exists; true when it is new. A name it is given is its name."""
        found, is_new = await self._queue.start(fresh(kind=self.kind, **values))
        return self.shown(found), is_new

    async def ended(self, row: RequestRow, done: int) -> None:
        """Complete the files of an ended request with a number of finished runs."""

    @abstractmethod
    def shown(self, row: RequestRow) -> Shown:
        """Return a request as the interface shows it, with its progress while it is under way."""

    async def all(self, wanted: RunFilter, page: ListPage) -> list[Shown]:
        """List the selected requests, newest first."""
        return [self.shown(row) for row in await self._requests.all(self.kind, wanted, page)]

    async def get(self, row_id: str) -> Shown:
        """Return one, or refuse with 404."""
        return self.shown(await self._requests.get(self.kind, row_id))

    async def look(self, row_id: str) -> WorkProgress | Ending | None:
        """Return how far a request is, or its end; None while the end is written."""
        if (progress := self._queue.progress(row_id)) is not None:
            return progress
        row = await self._requests.get(self.kind, row_id)
        return None if row.state in ACTIVE else Ending(state=row.state, result=self.shown(row))

    async def rename(self, row_id: str, label: str) -> Shown:
        """Give one a name; an empty one takes it away."""
        return self.shown(await self._requests.rename(self.kind, row_id, label))

    async def remove(self, ids: Sequence[str] | None) -> int:
        """Remove some that have ended, all of them if none is named, with their files; results stay."""
        return await self._requests.remove(self.kind, ids)

    async def cancel(self, row_id: str) -> Shown:
        """End a waiting or active request; the same request may come again, and continues from there."""
        await self._queue.cancel(self.kind, row_id)
        return await self.get(row_id)


def check_length(scenario: Scenario, seeds: int, settings: Settings, what: str, field: str) -> None:
    """Refuse a run with so many seeds that it has too many ticks for this server; with its name and the field."""
    ticks = seeds * (scenario.samples or DEFAULT_SAMPLES)
    if ticks > settings.max_run_ticks:
        text = f"{what} has {ticks} ticks, the limit is {settings.max_run_ticks} (max_run_ticks)"
        raise ApiError(422, "too_long", text, field)


class Queue:
    """Carries requests out, each in its turn.

    Parameters
    ----------
    database : Database
        Where requests and results are.
    settings : Settings
        Limits, number of processes, folder.
    metrics : Metrics
        Where ended requests are counted.
    streams : ProgressStreams
        Learn of the end of a request at once.
    """

    def __init__(self, database: Database, settings: Settings, metrics: Metrics, streams: ProgressStreams) -> None:
        self._database, self._settings, self._metrics, self._streams = database, settings, metrics, streams
        workers = max(1, settings.run_workers)
        self.kinds: dict[str, Requested[Any]] = {}
        self.results, self.processes = Results(database), Processes(workers, NICE)
        self.requests = Requests(database, settings.data)
        self._turns = {
            "run": asyncio.Semaphore(workers),
            "campaign": asyncio.Semaphore(1),
            "threshold": asyncio.Semaphore(1),
        }
        self._threads = ThreadPoolExecutor(workers + 3, thread_name_prefix="combbench-campaign")  # figures are made too
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self.campaigns: dict[str, Campaign] = {}
        self._is_closing = False

    async def start(self, row: RequestRow) -> tuple[RequestRow, bool]:
        """Queue a request, or return the same one if it exists; true when it is new. A name it is given is its name.

        Raises
        ------
        ApiError
            If too many wait.
        """
        has_room = len(self._tasks) < self._settings.max_queued_runs
        known = await self.requests.settle(row, has_room)
        if known is not None:
            return known, False
        if not has_room:
            text = f"{len(self._tasks)} runs and campaigns wait or run, the limit (max_queued_runs)"
            raise ApiError(429, "too_many_runs", text)
        self._tasks[row.id] = asyncio.create_task(self._carry_out(row))
        return row, True

    async def cancel(self, kind: Kind, row_id: str) -> None:
        """End a waiting or active request; an active study runs to its end, and its result is dropped.

        Rows in the table of results stay: the same request continues from there.
        """
        row, task = await self.requests.get(kind, row_id), self._tasks.get(row_id)
        if task is None:
            raise ApiError(409, "conflict", f"the {kind} is {row.state}; it cannot be cancelled any more")
        self._cancel(row_id, task)
        await asyncio.wait([task], timeout=CANCEL_S)

    def progress(self, row_id: str) -> WorkProgress | None:
        """Return how far a request is that waits or is under way."""
        if row_id not in self._tasks:
            return None
        campaign = self.campaigns.get(row_id)
        if campaign is None:
            return WorkProgress(state="queued", fraction=0.0, done=0, total=0)
        return WorkProgress(state="running", fraction=campaign.progress, done=campaign.done, total=campaign.total)

    async def warm(self, ready: Callable[[], Awaitable[None]]) -> None:
        """Start the worker processes before the first request, once the kernels are compiled."""
        await ready()
        for _ in range(self._settings.run_workers):
            await asyncio.to_thread(self.processes.submit, os.getpid)

    async def recover(self) -> None:
        """Continue the work that the end of the server interrupted; fail requests that were begun too often."""
        for row in await self.requests.recover():
            text = ""
            if row.version != code_version():
                text = "was begun by another version of the code; start it again"
            elif row.attempts >= ATTEMPTS or not self.kinds[row.kind].has_workers:
                text = f"the server stopped before this {row.kind} was done, {row.attempts} times"
            if text:
                await self._end(row.id, "aborted", error={"code": "aborted", "message": text})
                continue
            log.info("%s %s continues", row.kind, row.id)
            self._tasks[row.id] = asyncio.create_task(self._carry_out(row))

    async def close(self) -> None:
        """End the queue and the processes; unfinished work continues at the next start."""
        self._is_closing = True
        tasks = dict(self._tasks)
        for row_id, task in tasks.items():
            self._cancel(row_id, task)
        self.processes.kill()
        await asyncio.gather(*tasks.values(), return_exceptions=True)
        await asyncio.to_thread(self.processes.shutdown)
        self._threads.shutdown(wait=False)

    def _cancel(self, row_id: str, task: asyncio.Task[None]) -> None:
        campaign = self.campaigns.get(row_id)
        if campaign is not None:
            campaign.cancel()
        else:
            task.cancel()

    async def run(self, campaign: Campaign) -> bool:
        """Carry a campaign out, now; return whether it is complete."""
        try:
            return await asyncio.get_running_loop().run_in_executor(self._threads, campaign.run)
        except asyncio.CancelledError:
            campaign.cancel()
            raise

    async def _carry_out(self, row: RequestRow) -> None:
        """Wait for the turn, then for the end; write every outcome into the table."""
        kind = self.kinds[row.kind]
        state = "done"
        error: dict[str, Any] | None = None
        campaign: Campaign | None = None
        try:
            async with self._turns[row.kind]:
                await self.requests.update(row.id, state="running", attempts=RequestRow.attempts + 1)
                campaign = self.campaigns[row.id] = await kind.campaign(row, self._first_result(row.id))
                if not await self.run(campaign):
                    state = "cancelled"
        except asyncio.CancelledError:
            state = "cancelled"
        except (InputError, ApiError) as refusal:
            state, error = "failed", body_of(refusal).model_dump()
        except Stopped as stopped:
            state, error = "aborted", {"code": "aborted", "message": str(stopped)}
        except NotKept as reason:
            state, error = "failed", {"code": "no_space", "message": f"the disk failed: {reason}"}
        except DBAPIError as failure:
            text = f"the database cannot be used: {reason_of(failure)}"
            state, error = "failed", {"code": "storage", "message": text}
        except Exception as failure:
            log.exception("%s %s failed", row.kind, row.id)
            state, error = "failed", {"code": "internal", "message": str(failure)}
        finally:
            self._tasks.pop(row.id, None)
            self.campaigns.pop(row.id, None)
        if state == "cancelled":  # files of a campaign hold the finished runs, files of a run would be incomplete
            await asyncio.to_thread(shutil.rmtree, self.requests.folders["run"] / row.id, ignore_errors=True)
        if not self._is_closing or state == "done":
            values: dict[str, Any] = {}
            if campaign is not None and campaign.total:
                values = {"done": campaign.done, "runs": campaign.total, "summary": campaign.kept}
            await self._end(row.id, state, error=error, **values)
            self._streams.ring()
            if campaign is not None:
                await kind.ended(row, campaign.done)

    def _first_result(self, row_id: str) -> Callable[[int, int], None]:
        """Return a callback for the first result, in the thread of a campaign: further starts are then harmless."""
        at_start: list[int] = []

        def told(done: int, _total: int) -> None:
            at_start.append(done)
            if len(at_start) == 2:
                self._database.transact(lambda session: change(session, row_id, attempts=0))

        return told

    async def _end(self, row_id: str, state: str, **values: Any) -> None:
        """Note how a request ended, as soon as the database can be written."""
        self._metrics.runs.labels(state).inc()
        ended = now()
        for tries in itertools.count():
            try:
                await self.requests.update(row_id, state=state, finished=ended, **values)
                return
            except DBAPIError as error:
                if self._is_closing:
                    raise  # the next start resumes it
                log.error("the end of %s is not in the database yet: %s", row_id, reason_of(error))
                await asyncio.sleep(min(tries, LONGEST_WAIT_S))
