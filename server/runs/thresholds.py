"""Thresholds of the service: where claims begin to hold, looked for headless, in the queue with everything else."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable

from pydantic import BaseModel, ConfigDict, Field

from core.own.admission import kept
from scenarios.campaign.campaign import Campaign
from scenarios.campaign.halving import Threshold, ThresholdGoal
from scenarios.campaign.threshold import Search
from scenarios.key import content_hash, run_key
from scenarios.schema import Scenario
from server.runs.listing import Failure
from server.runs.queue import Requested, check_length
from server.store.models import RequestRow


class ThresholdRun(BaseModel):
    """A search for a threshold as the API shows it."""

    model_config = ConfigDict(from_attributes=True)

    id: str
    state: str
    scenario_id: str
    progress: float = 0.0
    found: Threshold | None = Field(None, validation_alias="summary", description="Null until it is done")
    error: Failure | None


class Thresholds(Requested[ThresholdRun]):
    """The searches of the queue."""

    kind = "threshold"

    async def start(self, scenario: Scenario, wanted: ThresholdGoal) -> tuple[ThresholdRun, bool]:
        """Queue a search, or return the same one if it exists; true when it is new.

        Raises
        ------
        InputError
            When the scenario has no such claim or number.
        ApiError
            If too many wait, or it is too long.
        """
        self.check_enabled()
        await asyncio.to_thread(Search, scenario, wanted, self._queue.results)
        check_length(scenario, wanted.points, self._settings, "the grid", "points")
        document = json.loads(json.dumps(scenario.document, default=str))
        asked = {"scenario": document, "wanted": wanted.model_dump()}
        key = run_key(content_hash({"threshold": {**asked, "seed": scenario.spec.seed}}))
        return await self.enter(
            key=key,
            name=wanted.path[:64],
            scenario_id=scenario.id,
            title=scenario.head.title,
            document=asked,
            runs=wanted.points,
        )

    async def campaign(self, row: RequestRow, on_progress: Callable[[int, int], None]) -> Campaign:
        """Return a search as it is carried out, on this machine."""
        wanted = ThresholdGoal.model_validate(row.document["wanted"])

        def made() -> Campaign:
            with kept():
                scenario = Scenario.load(row.document["scenario"])
            return Search(
                scenario, wanted, self._queue.results, processes=self._queue.processes, on_progress=on_progress
            )

        return await asyncio.to_thread(made)

    def shown(self, row: RequestRow) -> ThresholdRun:
        """Return a search as the interface shows it, with its progress while it is under way."""
        run, search = ThresholdRun.model_validate(row), self._queue.campaigns.get(row.id)
        done = 1.0 if run.state == "done" else 0.0
        return run.model_copy(update={"progress": search.progress if search is not None else done})
