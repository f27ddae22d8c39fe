"""Campaigns of the service: on this machine or on a cluster, their results read in place."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from datetime import datetime
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field

from scenarios.campaign.campaign import Campaign
from scenarios.campaign.check import check
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.key import code_version, content_hash, run_key
from server.errors import ApiError
from server.runs.listing import Failure
from server.runs.queue import Queue, Requested, check_length
from server.runs.surveys import CampaignStanding, Surveys
from server.settings import Settings
from server.store.database import Database
from server.store.models import RequestRow

T = TypeVar("T")


class SweepRun(BaseModel):
    """A campaign as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    state: str
    name: str
    title: str
    label: str = Field("", description="Name given by a user")
    version: str
    runs: int = Field(description="Different runs, as far as is known: points are compared in their turn")
    done: int = 0
    created: datetime
    finished: datetime | None
    error: Failure | None


class Sweeps(Requested[SweepRun]):
    """The campaigns of the queue, and their results.

    Parameters
    ----------
    queue : Queue
        Carries them out.
    settings : Settings
        Limits, scheduler.
    database : Database
        Where results are read.
    """

    kind = "campaign"

    def __init__(self, queue: Queue, settings: Settings, database: Database) -> None:
        super().__init__(queue, settings)
        self._surveys = Surveys(database, self._requests.folders[self.kind])

    @property
    def has_workers(self) -> bool:
        """Whether there are processes, or a cluster."""
        return super().has_workers or bool(self._settings.scheduler)

    async def start(self, document: dict[str, Any], label: str = "") -> tuple[SweepRun, bool]:
        """Queue a campaign, or return the same one if it exists; true when it is new. A name it is given is its name.

        The campaign is checked now; a point that cannot be carried out gives runs with an error.

        Raises
        ------
        ApiError
            If too many wait, or it has too many runs, or one of them is too long.
        """
        settings = self._settings
        self.check_enabled()
        sweep = await asyncio.to_thread(Sweep, document)
        if len(sweep) > settings.max_sweep_runs:
            text = f"this campaign has {len(sweep)} runs, the limit is {settings.max_sweep_runs} (max_sweep_runs)"
            raise ApiError(422, "too_long", text, "sweep")
        await asyncio.to_thread(lambda: check_length(check(sweep), 1, settings, "a run of this campaign", "sweep"))
        key = run_key(content_hash({"sweep": document}))
        return await self.enter(
            key=key,
            name=sweep.head.id,
            scenario_id=sweep.base.id,
            title=sweep.head.title,
            label=label,
            document=json.loads(json.dumps(document, default=str)),
            runs=len(sweep),
        )

    async def campaign(self, row: RequestRow, on_progress: Callable[[int, int], None]) -> Campaign:
        """Return a campaign as it is carried out: on the cluster if there is one."""
        sweep = await asyncio.to_thread(Sweep, row.document)
        scheduler = self._settings.scheduler
        processes = None if scheduler else self._queue.processes
        follow = self._surveys.follow(CampaignStanding.of(row, 0, True))

        def progress(done: int, total: int) -> None:
            on_progress(done, total)
            follow(done, total)

        return Campaign(sweep, self._queue.results, scheduler=scheduler, processes=processes, on_progress=progress)

    async def ended(self, row: RequestRow, done: int) -> None:
        """Have the files of a campaign written to the end."""
        self._surveys.write(CampaignStanding.of(row, done, False))

    async def document(self, sweep_id: str) -> dict[str, Any]:
        """Return the document that a campaign was requested with."""
        return (await self._requests.get(self.kind, sweep_id)).document

    async def read(self, sweep_id: str, reader: Callable[[Survey], T]) -> T:
        """Call a reader on the results so far."""
        return await self._surveys.read(self._standing(await self._readable(sweep_id)), reader)

    async def surveyed(self, sweep_id: str, reader: Callable[[Survey], T]) -> tuple[SweepRun, T]:
        """Call a reader, and return the campaign too; if the campaign has ended, its results are complete."""
        before, found = await self.get(sweep_id), await self.read(sweep_id, reader)
        sweep = await self.get(sweep_id)
        return sweep, found if sweep.finished == before.finished else await self.read(sweep_id, reader)

    async def report(self, sweep_id: str) -> str:
        """Return the report of the results so far."""
        row = await self._readable(sweep_id)
        return await self._surveys.report(self._standing(row), row.label)

    def _standing(self, row: RequestRow) -> CampaignStanding:
        """Return how far a campaign is."""
        campaign = self._queue.campaigns.get(row.id)
        return (
            CampaignStanding.of(row, row.done, False)
            if campaign is None
            else CampaignStanding.of(row, campaign.done, True)
        )

    async def _readable(self, sweep_id: str) -> RequestRow:
        row = await self._requests.get(self.kind, sweep_id)
        if row.version != code_version():
            text = f"its runs are of version {row.version} of the code, this is {code_version()}"
            raise ApiError(409, "conflict", text)
        return row

    def close(self) -> None:
        """End the process that writes files."""
        self._surveys.close()

    def shown(self, row: RequestRow) -> SweepRun:
        """Return a campaign as the interface shows it, with its progress while it is under way."""
        sweep, campaign = SweepRun.model_validate(row), self._queue.campaigns.get(row.id)
        if campaign is None or not campaign.total:
            return sweep
        return sweep.model_copy(update={"done": campaign.done, "runs": campaign.total})
