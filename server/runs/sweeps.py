"""Campaigns of the service: one after the other, in processes of lower priority or on a cluster.

The rows of campaigns say what was requested, the run table says what is done. A campaign that the end of the server
interrupted goes on at the next start with the missing runs.
"""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Callable
from datetime import UTC, datetime
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy import select, update
from sqlalchemy.exc import DBAPIError
from sqlalchemy.orm import defer

from core.errors import InputError
from scenarios.campaign.campaign import Campaign, Stopped
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.key import code_version, content_hash, run_key
from scenarios.schema import Scenario
from server.errors import ApiError, body_of, not_found
from server.metrics import Metrics
from server.runs.apart import FEW_POINTS, Apart, contents, examine
from server.runs.length import check_length
from server.runs.listing import ACTIVE, RunFilter, remove, rename
from server.runs.surveys import Surveys
from server.runs.worker import NICE
from server.settings import Settings
from server.store.database import Database, reason_of
from server.store.models import SweepRow
from server.store.results import Results

log = logging.getLogger(__name__)

T = TypeVar("T")


class SweepRun(BaseModel):
    """A campaign as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    state: str
    name: str
    title: str
    label: str = Field("", description="Name that somebody gave it")
    version: str
    runs: int = Field(description="Different runs; until all points have been checked, at most")
    done: int = 0
    created: datetime
    finished: datetime | None
    error: dict[str, Any] | None


class Sweeps:
    """Queues campaigns and keeps their results.

    Parameters
    ----------
    database : Database
        Where campaigns and results are.
    settings : Settings
        Limits, number of processes, scheduler.
    metrics : Metrics
        Where ended campaigns are counted.
    """

    def __init__(self, database: Database, settings: Settings, metrics: Metrics) -> None:
        self._database, self._settings, self._metrics = database, settings, metrics
        self._results = Results(database)
        self._turn = asyncio.Semaphore(1)
        self._expanding = Apart(FEW_POINTS)
        self._surveys = Surveys(database, settings.data / "sweeps")
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._campaigns: dict[str, Campaign] = {}
        self._is_closing = False

    async def start(self, document: dict[str, Any], label: str = "") -> tuple[SweepRun, bool]:
        """Queue a campaign, or return the same one if it exists; true when it is new. A name it is given is its name.

        Of a campaign with many points only some are checked now. The others are checked while it waits; if one of them
        is wrong, the campaign fails.

        Raises
        ------
        ApiError
            If too many wait, or it has too many runs.
        """
        settings = self._settings
        if settings.run_workers == 0 and not settings.scheduler:
            raise ApiError(409, "runs_disabled", "this server takes no headless runs (run_workers = 0)")
        sweep = await asyncio.to_thread(Sweep, document)
        if len(sweep) > settings.max_sweep_runs:
            text = f"this campaign has {len(sweep)} runs, the limit is {settings.max_sweep_runs} (max_sweep_runs)"
            raise ApiError(422, "too_long", text, "sweep")
        some = sweep.points[:FEW_POINTS]
        await self._check(await asyncio.to_thread(sweep.longest, some))
        is_checked = len(some) == len(sweep.points)
        sweep_id = run_key(content_hash({"sweep": document}))[:32]
        known = await self._row(sweep_id)
        if known is not None and known.state in (*ACTIVE, "done"):
            if label:
                await self._update(sweep_id, label=label)
            return await self.get(sweep_id), False
        if len(self._tasks) >= settings.max_queued_runs:
            raise ApiError(
                429, "too_many_runs", f"{len(self._tasks)} campaigns wait or run, the limit (max_queued_runs)"
            )
        values: dict[str, Any] = {
            "id": sweep_id,
            "state": "queued",
            "name": sweep.head.id,
            "title": sweep.head.title,
            "label": label or (known.label if known is not None else ""),
            "document": json.loads(json.dumps(document, default=str)),
            "version": code_version(),
            "runs": len(set(sweep.contents)) * len(sweep.seeds) if is_checked else len(sweep),
            "finished": None,
            "error": None,
        }
        await self._database.run(lambda session: session.merge(SweepRow(**values)))
        self._queue(sweep_id, document, len(sweep.points), is_checked)
        return await self.get(sweep_id), True

    async def _check(self, longest: Scenario) -> None:
        """Refuse a campaign whose longest run is too long."""
        await asyncio.to_thread(check_length, longest, 1, self._settings, "a run of this campaign", "sweep")

    def _queue(self, sweep_id: str, document: dict[str, Any], points: int, is_checked: bool) -> None:
        """Carry a campaign out in its turn."""
        self._tasks[sweep_id] = asyncio.create_task(self._carry_out(sweep_id, document, points, is_checked))

    async def all(self, wanted: RunFilter) -> list[SweepRun]:
        """List the campaigns that are asked for, newest first."""
        query = wanted.of(SweepRow).options(defer(SweepRow.document))
        rows = await self._database.run(lambda session: list(session.scalars(query)))
        return [self._live(SweepRun.model_validate(row)) for row in rows]

    async def get(self, sweep_id: str) -> SweepRun:
        """Return one campaign, or refuse with 404."""
        return self._live(SweepRun.model_validate(await self._known(sweep_id)))

    async def rename(self, sweep_id: str, label: str) -> SweepRun:
        """Give a campaign a name."""
        await rename(self._database, SweepRow, "campaign", sweep_id, label)
        return await self.get(sweep_id)

    async def remove(self, sweep_ids: list[str] | None) -> int:
        """Remove campaigns that have ended, all if none is named; results stay, for campaigns share them."""
        return await remove(self._database, SweepRow, "campaign", sweep_ids, self._surveys.folder)

    async def cancel(self, sweep_id: str) -> SweepRun:
        """Stop a campaign after the runs in hand; its results stay, and the same campaign can go on from there."""
        sweep = await self.get(sweep_id)
        task = self._tasks.get(sweep_id)
        if task is None:
            raise ApiError(409, "conflict", f"the campaign is {sweep.state}; it cannot be cancelled any more")
        campaign = self._campaigns.get(sweep_id)
        if campaign is not None:
            campaign.cancel()
        else:
            task.cancel()
        await asyncio.wait([task], timeout=10.0)
        return await self.get(sweep_id)

    async def document(self, sweep_id: str) -> dict[str, Any]:
        """Return the document that a campaign was requested with."""
        return (await self._known(sweep_id)).document

    async def read(self, sweep_id: str, reader: Callable[[Survey], T]) -> T:
        """Call a reader on the results so far."""
        row = await self._readable(sweep_id)
        return await self._surveys.read(sweep_id, row.document, *self._progress(row), reader)

    async def report(self, sweep_id: str) -> str:
        """Return the report of the results so far."""
        row = await self._readable(sweep_id)
        return await self._surveys.report(sweep_id, row.document, *self._progress(row))

    def _progress(self, row: SweepRow) -> tuple[int, bool]:
        """Return how many runs are done, and whether there may be more soon."""
        campaign = self._campaigns.get(row.id)
        return (row.done, False) if campaign is None else (campaign.done, True)

    async def _readable(self, sweep_id: str) -> SweepRow:
        row = await self._known(sweep_id)
        if row.version != code_version():
            text = f"its runs are of version {row.version} of the code, this is {code_version()}"
            raise ApiError(409, "conflict", text)
        return row

    async def recover(self) -> None:
        """Go on with the campaigns that the end of the server interrupted."""
        query = select(SweepRow).where(SweepRow.state.in_(ACTIVE)).order_by(SweepRow.created)
        for row in await self._database.run(lambda session: list(session.scalars(query))):
            try:
                if row.version != code_version():
                    raise InputError("was begun by another version of the code; start it again", "sweep")
                points = len((await asyncio.to_thread(Sweep, row.document)).points)
            except InputError as error:
                await self._end(row.id, "aborted", body_of(error).model_dump())
                continue
            self._queue(row.id, row.document, points, points <= FEW_POINTS or row.state == "running")
            log.info("campaign %s goes on", row.id)

    async def close(self) -> None:
        """Stop the campaign under way; it goes on at the next start."""
        self._is_closing = True
        for sweep_id, task in list(self._tasks.items()):
            campaign = self._campaigns.get(sweep_id)
            if campaign is not None:
                campaign.abandon()
            else:
                task.cancel()
        self._expanding.close()
        self._surveys.close()
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)

    async def _carry_out(self, sweep_id: str, document: dict[str, Any], points: int, is_checked: bool) -> None:
        """Check the remaining points, wait for the turn, then for the end."""
        state, error = "done", None
        campaign: Campaign | None = None
        try:
            if not is_checked:
                runs, longest = await self._expanding.call(points, examine, document)
                await self._check(await asyncio.to_thread(Scenario.load, longest))
                await self._update(sweep_id, runs=runs)
            async with self._turn:
                await self._update(sweep_id, state="running")
                sweep = await asyncio.to_thread(Sweep, document)
                sweep.contents = await self._expanding.call(points, contents, document)
                settings = self._settings
                campaign = Campaign(
                    sweep,
                    self._results,
                    workers=settings.run_workers,
                    scheduler=settings.scheduler,
                    niceness=NICE,
                    on_progress=self._surveys.follow(sweep_id, document),
                )
                self._campaigns[sweep_id] = campaign
                if not await asyncio.to_thread(campaign.run):
                    state = "cancelled"
        except asyncio.CancelledError:
            state = "cancelled"
        except (InputError, ApiError) as refusal:
            state, error = "failed", body_of(refusal).model_dump()
        except Stopped as stopped:
            state, error = "aborted", {"code": "aborted", "message": str(stopped)}
        except DBAPIError as failure:
            text = f"the database cannot be used: {reason_of(failure)}"
            state, error = "failed", {"code": "storage", "message": text}
        except Exception as failure:
            log.exception("campaign %s failed", sweep_id)
            state, error = "failed", {"code": "internal", "message": str(failure)}
        finally:
            self._tasks.pop(sweep_id, None)
            self._campaigns.pop(sweep_id, None)
        if not self._is_closing or state == "done":
            done = {"done": campaign.done} if campaign is not None else {}
            await self._end(sweep_id, state, error, **done)
            if campaign is not None:
                self._surveys.write(sweep_id, document, campaign.done, False)

    async def _end(self, sweep_id: str, state: str, error: dict[str, Any] | None, **values: Any) -> None:
        self._metrics.runs.labels(state).inc()
        await self._update(sweep_id, state=state, error=error, finished=datetime.now(UTC), **values)

    def _live(self, sweep: SweepRun) -> SweepRun:
        """Add the progress of a campaign under way."""
        campaign = self._campaigns.get(sweep.id)
        return sweep if campaign is None else sweep.model_copy(update={"done": campaign.done})

    async def _row(self, sweep_id: str) -> SweepRow | None:
        return await self._database.run(lambda session: session.get(SweepRow, sweep_id))

    async def _known(self, sweep_id: str) -> SweepRow:
        row = await self._row(sweep_id)
        if row is None:
            raise not_found("campaign", sweep_id)
        return row

    async def _update(self, sweep_id: str, **values: Any) -> None:
        statement = update(SweepRow).where(SweepRow.id == sweep_id).values(**values)
        await self._database.run(lambda session: session.execute(statement))
