"""The gallery: every library scenario with its claim and the result of its run."""

from __future__ import annotations

import asyncio
import fnmatch
from functools import cache

from fastapi import APIRouter
from pydantic import BaseModel, Field

from core.errors import InputError
from scenarios.library import library
from scenarios.schema import Scenario, Verdict
from server.api.bodies import Body, StrictRoute
from server.api.deps import RateLimited, ServiceDep
from server.runs.jobs import Run, identify

router = APIRouter(prefix="/gallery", tags=["gallery"], route_class=StrictRoute)


class Expected(BaseModel):
    """An expectation, and the measured value."""

    metric: str
    published: str
    expected: str
    verdict: Verdict | None
    note: str
    measured: float | None = None
    ok: bool | None = Field(None, description="Null until it has been run")


class GalleryCard(BaseModel):
    """A scenario of the library and its run, if there has been one with this version of the code."""

    id: str
    title: str
    source: str
    summary: str
    claim: str
    verdict: Verdict | None
    study: str | None = Field(description="Kind of the study; null for a scenario that runs on a bench")
    run: str | None = Field(description="Its run: trace, report, thumbnail and script are at /runs/{id}/...")
    state: str = Field(description="new until it has been asked for, then as that of a run")
    progress: float
    elapsed_s: float | None
    digest: str
    ok: bool | None = Field(description="Whether all expectations hold; null until it has been run")
    expectations: list[Expected]


class Gallery(BaseModel):
    """All cards, in the order of the text."""

    cards: list[GalleryCard]


class Chosen(Body):
    """The scenarios to run."""

    only: str = Field("*", max_length=200, description="Ids that match, such as ch5-*")


@router.get("")
async def get_gallery(service: ServiceDep) -> Gallery:
    """Show every library scenario: claim, expectations, and the result of its run."""
    ids = await asyncio.to_thread(_run_ids)
    runs = await service.jobs.some(list(ids.values()))
    return Gallery(cards=[_card(scenario, runs.get(ids[scenario.id])) for scenario in library()])


@router.post("/run", status_code=202, dependencies=[RateLimited])
async def run_gallery(body: Chosen, service: ServiceDep) -> Gallery:
    """Run the library, or a part of it; a scenario that has been run with this version is not run again."""
    chosen = [scenario for scenario in library() if fnmatch.fnmatchcase(scenario.id, body.only)]
    if not chosen:
        raise InputError(f"no scenario matches {body.only!r}", "only")
    await service.keeping.room()
    for scenario in chosen:
        await service.jobs.start(scenario, [scenario.spec.seed])
    return await get_gallery(service)


@cache
def _run_ids() -> dict[str, str]:
    """Return the id of the run of each library scenario."""
    return {scenario.id: identify(scenario, [scenario.spec.seed])[1][:32] for scenario in library()}


def _card(scenario: Scenario, run: Run | None) -> GalleryCard:
    """Return the card of a scenario and its run."""
    head = scenario.head
    summary = (run.summary if run is not None else None) or {}
    measured = summary.get("expectations") or [{}] * len(head.expect)
    return GalleryCard(
        id=scenario.id,
        title=head.title,
        source=head.source,
        summary=head.summary,
        claim=head.claim,
        verdict=head.verdict,
        study=str(head.study["kind"]) if head.study is not None else None,
        run=run.id if run is not None else None,
        state=run.state if run is not None else "new",
        progress=run.progress if run is not None else 0.0,
        elapsed_s=summary.get("elapsed_s"),
        digest=summary.get("digest", ""),
        ok=summary.get("ok"),
        expectations=[
            Expected(
                metric=entry.metric,
                published=entry.published,
                expected=entry.text(),
                verdict=entry.verdict or head.verdict,
                note=entry.note,
                measured=measurement.get("measured"),
                ok=measurement.get("ok"),
            )
            for entry, measurement in zip(head.expect, measured, strict=True)
        ],
    )
