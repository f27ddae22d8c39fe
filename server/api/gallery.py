"""The gallery: every library scenario with its claim and the result of its run."""

from __future__ import annotations

import asyncio
import fnmatch
from typing import Annotated

from fastapi import Query, Response
from pydantic import BaseModel, Field

from core.errors import InputError
from scenarios.expectation import Verdict, overall
from scenarios.library import ids, is_demo, library, topics
from scenarios.report.svg import with_style
from scenarios.schema import Scenario
from server.api.bodies import AnswerBody, Body
from server.api.deps import RateLimited, ServiceDep
from server.api.files import SVG
from server.api.router import Router
from server.errors import not_found
from server.runs.figures import ScenarioFigure, ScenarioFigures
from server.runs.listing import Run

router = Router(prefix="/gallery", tags=["gallery"])

First = Annotated[list[str], Query(max_length=64, description="Ids of the visible cards, whose figures are made first")]


class Expected(AnswerBody):
    """An expectation, and the measured value."""

    metric: str
    published: str
    published_value: float | None
    expected: str
    expected_words: str = Field(description="The expected value in words, with its unit")
    verdict: Verdict | None = Field(description="Verdict on the value; before a run, if the expectation holds")
    fitted: list[str] = Field(description="Fields of the scenario chosen so that the figure agrees with the text")
    reason: str = Field(description="Why there is no comparison with the open loop")
    note: str
    measured: float | None = None
    open_loop: float | None = Field(None, description="Figure with the open loop in place of the controller")
    pid: float | None = Field(None, description="Figure with a PID in its place, where the claim is against a PID")
    comparator: str = Field("", description="Name of this PID, the best of its family on the healthy device")
    pid_too: bool = Field(False, description="Whether this PID meets the claim too; before a run, as declared")
    ok: bool | None = Field(None, description="Whether the expectation holds; null before a run")


class GalleryCard(AnswerBody):
    """A scenario of the library, its figure, and its run if there has been one with this version of the code."""

    id: str
    title: str
    source: str
    summary: str
    claim: str
    verdict: Verdict | None
    demo: bool = Field(description="Whether the scenario is for first visits and lectures")
    topics: list[str] = Field(description="Titles of its device, controllers, diagnosers and faults")
    figure: str | None = Field(description="Key of its figure at /gallery/{id}/figure; null until it is made")
    problem: str = Field(description="Why the figure cannot be made; empty otherwise")
    study: str | None = Field(description="Kind of the study; null for a scenario that runs on a bench")
    run: str | None = Field(description="Id of its run; trace, report, thumbnail and script are at /runs/{id}/...")
    state: str = Field(description="new before the first request, then the state of the run")
    progress: float
    elapsed_s: float | None
    digest: str
    ok: bool | None = Field(description="Whether all expectations hold; null until they have been measured")
    expectations: list[Expected]


class FigureProgress(AnswerBody):
    """Number of finished figures."""

    made: int
    total: int
    is_making: bool
    problem: str = Field(description="Last error, in one line; empty without an error")


class Gallery(BaseModel):
    """All cards, in the order of the text."""

    cards: list[GalleryCard]
    figures: FigureProgress


class Chosen(Body):
    """The scenarios to run."""

    only: str = Field("*", max_length=200, description="Pattern of ids, such as ch5-*")


@router.get("")
async def get_gallery(
    service: ServiceDep,
    first: First = [],  # noqa: B006
) -> Gallery:
    """Show every library scenario: claim, expectations, figure and measured values. Missing figures are made now."""
    figures = service.figures
    await figures.ask(first)
    run_ids = await asyncio.to_thread(lambda: figures.keys)
    runs = await service.jobs.some(list(run_ids.values()))
    return Gallery(
        cards=[_card(scenario, runs.get(run_ids[scenario.id]), figures) for scenario in library()],
        figures=FigureProgress.of(figures, made=len(figures.made)),
    )


@router.get("/{scenario_id}/figure", response_class=Response, responses={200: {"content": {SVG: {}}}})
async def get_figure(scenario_id: str, service: ServiceDep) -> Response:
    """Return the figure of a library scenario, small, with axes and units."""
    if scenario_id not in ids():
        raise not_found("scenario", scenario_id, known=ids())
    figure = service.figures.made.get(scenario_id)
    if figure is None:
        raise not_found("figure of", scenario_id, "figures are made one after the other once the gallery is opened")
    return Response(with_style(figure.svg), media_type=SVG, headers={"Cache-Control": "private, max-age=3600"})


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


def _card(scenario: Scenario, run: Run | None, figures: ScenarioFigures) -> GalleryCard:
    """Return the card of a scenario; a run and a figure have measured the same."""
    head = scenario.head
    figure: ScenarioFigure | None = figures.made.get(scenario.id)
    summary = (run.summary if run is not None else None) or (figure.summary if figure is not None else {})
    measured = summary.get("expectations") or [{}] * len(head.expect)
    rows = [
        Expected.of(
            entry,
            expected=entry.text(),
            expected_words=entry.words(),
            verdict=measurement["verdict"] if measurement else entry.promised(),
            comparator=head.compared_with(entry),
            pid_too=measurement.get("pid_too", entry.pid_too),
            **{name: measurement.get(name) for name in ("measured", "open_loop", "pid", "ok")},
        )
        for entry, measurement in zip(head.expect, measured, strict=True)
    ]
    return GalleryCard.of(
        head,
        id=scenario.id,
        verdict=overall(row.verdict for row in rows),
        demo=is_demo(scenario.id),
        topics=topics(scenario),
        figure=figure.key if figure is not None else None,
        problem=figures.failed.get(scenario.id, ""),
        study=str(head.study["kind"]) if head.study is not None else None,
        run=run.id if run is not None else None,
        state=run.state if run is not None else "new",
        progress=run.progress if run is not None else 0.0,
        elapsed_s=summary.get("elapsed_s"),
        digest=summary.get("digest", ""),
        ok=summary.get("ok"),
        expectations=rows,
    )
