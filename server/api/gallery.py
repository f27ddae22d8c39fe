"""The gallery: every library scenario with its claim and the result of its run."""

from __future__ import annotations

import asyncio
import fnmatch
from functools import cache
from typing import Annotated

from fastapi import Query, Response
from pydantic import BaseModel, Field

from core.board.commands import Inject, Switch
from core.board.spec import Spec
from core.errors import InputError
from core.registry import blocks
from scenarios.expectation import Verdict, overall
from scenarios.library import ids, is_demo, library
from scenarios.report.svg import with_style
from scenarios.schema import Scenario
from server.api.bodies import Body
from server.api.deps import RateLimited, ServiceDep
from server.api.files import SVG
from server.api.router import Router
from server.errors import not_found
from server.runs.figures import Figure, Figures
from server.runs.listing import Run

router = Router(prefix="/gallery", tags=["gallery"])


First = Annotated[list[str], Query(max_length=64, description="Ids of cards in sight: their figures come first")]


class Expected(BaseModel):
    """An expectation, and the measured value."""

    metric: str
    published: str
    published_value: float | None
    expected: str
    expected_words: str = Field(description="The same for readers, with a unit and its prefix")
    verdict: Verdict | None = Field(
        description="The word of the measured value; before a run, the word if the expectation holds"
    )
    fitted: list[str] = Field(description="Fields of the scenario that were chosen so that it agrees")
    reason: str = Field(description="Why nothing is said by comparing it with the open loop")
    note: str
    measured: float | None = None
    open_loop: float | None = Field(None, description="With the open loop in place of the controller")
    pid: float | None = Field(None, description="With the comparator in its place, where the claim is against a PID")
    comparator: str = Field("", description="Name of that PID: the best of its family on the healthy device")
    pid_too: bool = Field(False, description="Whether that PID meets the claim too; until a run, as declared")
    ok: bool | None = Field(None, description="Null until it has been run")


class GalleryCard(BaseModel):
    """A scenario of the library, its figure, and its run if there has been one with this version of the code."""

    id: str
    title: str
    source: str
    summary: str
    claim: str
    verdict: Verdict | None
    demo: bool = Field(description="Made for first visits and lectures")
    topics: list[str] = Field(description="Device, controllers, diagnosers and faults it is about")
    figure: str | None = Field(description="Key of its figure at /gallery/{id}/figure; null until it is made")
    problem: str = Field(description="Why it has no figure, if it cannot be made")
    study: str | None = Field(description="Kind of the study; null for a scenario that runs on a bench")
    run: str | None = Field(description="Its run: trace, report, thumbnail and script are at /runs/{id}/...")
    state: str = Field(description="new until it has been requested, then the state of a run")
    progress: float
    elapsed_s: float | None
    digest: str
    ok: bool | None = Field(description="Whether all expectations hold; null until they have been measured")
    expectations: list[Expected]


class FigureProgress(BaseModel):
    """Number of finished figures."""

    made: int
    total: int
    is_making: bool
    problem: str = Field(description="What went wrong last, in one line")


class Gallery(BaseModel):
    """All cards, in the order of the text."""

    cards: list[GalleryCard]
    figures: FigureProgress


class Chosen(Body):
    """The scenarios to run."""

    only: str = Field("*", max_length=200, description="Ids that match, such as ch5-*")


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
        figures=FigureProgress(
            made=len(figures.made), total=figures.total, is_making=figures.is_making, problem=figures.problem
        ),
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


@cache
def _topics(scenario: Scenario) -> list[str]:
    """Return the topics of a scenario, in the words of the catalogue."""
    controllers, faults = blocks("control"), blocks("faults")
    specs: list[Spec] = [scenario.spec, *scenario.twins.values()]
    topics = [str(scenario.document.get("device", {}).get("id", ""))]
    driving = [name for spec in specs for name in spec.driving.values()]
    commands = [command for event in scenario.events for command in event]
    driving += [command.switch for command in commands if isinstance(command, Switch)]
    topics += [controllers[name].title if name in controllers else name for name in driving]
    for spec in specs:
        found = [*spec.diagnosers.values(), *spec.identifiers.values(), *spec.readouts.values()]
        topics += [section.block.title for section in found]
        topics.append(spec.sensors[spec.measuring].block.title)
    injected = [command.fault for command in commands if isinstance(command, Inject)]
    topics += [faults[name].title if name in faults else name for name in injected]
    return list(dict.fromkeys(topic for topic in topics if topic))


def _card(scenario: Scenario, run: Run | None, figures: Figures) -> GalleryCard:
    """Return the card of a scenario; a run and a figure have measured the same."""
    head = scenario.head
    figure: Figure | None = figures.made.get(scenario.id)
    summary = (run.summary if run is not None else None) or (figure.summary if figure is not None else {})
    measured = summary.get("expectations") or [{}] * len(head.expect)
    rows = [
        Expected(
            metric=entry.metric,
            published=entry.published,
            published_value=entry.published_value,
            expected=entry.text(),
            expected_words=entry.words(),
            verdict=measurement["verdict"] if measurement else entry.promised(),
            fitted=entry.fitted,
            reason=entry.reason,
            note=entry.note,
            measured=measurement.get("measured"),
            open_loop=measurement.get("open_loop"),
            pid=measurement.get("pid"),
            comparator=head.compared_with(entry),
            pid_too=measurement.get("pid_too", entry.pid_too),
            ok=measurement.get("ok"),
        )
        for entry, measurement in zip(head.expect, measured, strict=True)
    ]
    return GalleryCard(
        id=scenario.id,
        title=head.title,
        source=head.source,
        summary=head.summary,
        claim=head.claim,
        verdict=overall(row.verdict for row in rows),
        demo=is_demo(scenario.id),
        topics=_topics(scenario),
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
