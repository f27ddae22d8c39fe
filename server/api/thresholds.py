"""Thresholds: where a claim begins to hold over the range of a number."""

from __future__ import annotations

import asyncio
from typing import Self

from fastapi import Response
from pydantic import Field, model_validator

from scenarios.campaign.halving import ThresholdGoal
from server.api.bodies import Body, ScenarioDocument
from server.api.deps import PersonDep, RateLimited, ServiceDep
from server.api.router import Router
from server.bench.build import prepare
from server.runs.thresholds import ThresholdRun

router = Router(prefix="/thresholds", tags=["thresholds"])


class NewThreshold(Body, ThresholdGoal):
    """A scenario, a claim, and the number whose threshold is searched."""

    scenario: str | ScenarioDocument | None = Field(None, description="Library id, TOML text, or document")
    bench: str = Field("", max_length=100, description="Id of a live bench with the scenario, in place of it")

    @model_validator(mode="after")
    def _has_one_scenario(self) -> Self:
        if (self.scenario is None) == (not self.bench):
            raise ValueError("give a scenario or a bench")
        return self


@router.post(
    "",
    status_code=202,
    dependencies=[RateLimited],
    responses={200: {"model": ThresholdRun, "description": "The same search existed already"}},
)
async def find_threshold(
    body: NewThreshold, service: ServiceDep, person: PersonDep, response: Response
) -> ThresholdRun:
    """Search by headless runs where a claim begins to hold; live benches are not disturbed."""
    if body.scenario is None:
        scenario = service.views.whole(body.bench, person).scenario
    else:
        await service.benches.check(body.scenario, {})
        scenario, _ = await asyncio.to_thread(prepare, body.scenario, {}, None, service.units.named_in)
    wanted = ThresholdGoal.model_validate(body.model_dump(include=set(ThresholdGoal.model_fields)))
    await service.keeping.room()
    found, is_new = await service.thresholds.start(scenario, wanted)
    response.status_code = 202 if is_new else 200
    response.headers["Location"] = f"/api/v1/thresholds/{found.id}"
    return found


@router.get("/{threshold_id}")
async def get_threshold(threshold_id: str, service: ServiceDep) -> ThresholdRun:
    """Return the progress of a search, and its result at the end."""
    return await service.thresholds.get(threshold_id)


@router.delete("/{threshold_id}", dependencies=[RateLimited])
async def cancel_threshold(threshold_id: str, service: ServiceDep) -> ThresholdRun:
    """Cancel a search that waits or is under way; the runs that are done stay."""
    return await service.thresholds.cancel(threshold_id)
