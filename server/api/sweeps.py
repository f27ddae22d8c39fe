"""Campaigns: start, watch, cancel, read the results."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any, BinaryIO, Literal

from fastapi import Query, Response
from pydantic import BaseModel, Field

from core.nesting import read_toml
from scenarios.campaign.parquet import write_runs
from scenarios.campaign.survey import Distribution, Survey
from scenarios.campaign.tally import PointTally
from scenarios.narrator.words import diagnosis_words
from scenarios.report.campaign_picture import CampaignPicture, surveyed_picture
from scenarios.report.script import campaign_script
from server.api.bodies import Body, CampaignDocument
from server.api.deps import RateLimited, ServiceDep
from server.api.files import HTML, PYTHON, file_name, report_response, written_response
from server.api.paging import Number, RequestPage, pages
from server.api.router import Router
from server.api.runs import Ended, FilterDep, NewLabel, Removed
from server.errors import ApiError
from server.paging import ListPage
from server.runs.listing import clean_label
from server.runs.sweeps import SweepRun
from server.store.traces import MEDIA_TYPES

MOST_POINTS = 20_000
"""Points of an answer."""
SO_FAR = "-so-far"
"""End of the name of a file with the runs of a campaign under way."""
RUNS = {
    "X-Runs": {"description": "Runs that the file has", "schema": {"type": "integer"}},
    "X-State": {
        "description": "State of the campaign; until it has ended, more runs come",
        "schema": {"type": "string"},
    },
}

router = Router(prefix="/sweeps", tags=["sweeps"])


class NewSweep(Body):
    """A campaign to run."""

    sweep: str | CampaignDocument = Field(description="Campaign as TOML text or as a document")
    label: str = Field("", max_length=1000, description="Name for the campaign, at most 120 characters")


class SweepList(BaseModel):
    """Campaigns, newest first."""

    sweeps: list[SweepRun]


class SweepPoints(BaseModel):
    """Results of a campaign, point by point."""

    sweep: SweepRun
    points: list[PointTally]
    found: int = Field(description="Number of points with runs, on all pages")
    runs: int = Field(description="Runs in these results; `sweep.done` may be larger until the campaign ends")
    figures: list[str] = Field(description="Names of the figures of a run")
    quantities: list[str] = Field(description="Quantities to count runs over: numeric axes, the seed and figures")
    words: dict[str, str] = Field(description="Titles of diagnosers and hypotheses in words, by their names")


@router.post(
    "",
    status_code=202,
    dependencies=[RateLimited],
    responses={200: {"model": SweepRun, "description": "The same campaign existed already"}},
)
async def start_sweep(body: NewSweep, service: ServiceDep, response: Response) -> SweepRun:
    """Start a campaign, or continue a stopped campaign; a second request for a campaign returns the same one."""
    document = body.sweep if isinstance(body.sweep, dict) else await asyncio.to_thread(read_toml, body.sweep, "sweep")
    label = clean_label(body.label)
    await service.keeping.room()
    sweep, is_new = await service.sweeps.start(document, label)
    response.status_code = 202 if is_new else 200
    response.headers["Location"] = f"/api/v1/sweeps/{sweep.id}"
    return sweep


@router.get("")
async def list_sweeps(service: ServiceDep, wanted: FilterDep, page: RequestPage) -> SweepList:
    """List campaigns, newest first; text, state and scenario choose among them."""
    return SweepList(sweeps=await service.sweeps.all(wanted, page))


@router.post("/remove", dependencies=[RateLimited])
async def remove_sweeps(body: Ended, service: ServiceDep) -> Removed:
    """Remove campaigns that have ended; all that have ended if none is named."""
    return Removed(removed=await service.sweeps.remove(body.ids))


@router.get("/{sweep_id}")
async def get_sweep(sweep_id: str, service: ServiceDep) -> SweepRun:
    """Return the progress of a campaign."""
    return await service.sweeps.get(sweep_id)


@router.patch("/{sweep_id}", dependencies=[RateLimited])
async def rename_sweep(sweep_id: str, body: NewLabel, service: ServiceDep) -> SweepRun:
    """Give a campaign a name."""
    return await service.sweeps.rename(sweep_id, body.label)


@router.delete("/{sweep_id}", dependencies=[RateLimited])
async def cancel_sweep(sweep_id: str, service: ServiceDep) -> SweepRun:
    """Stop a campaign; the runs that are done stay."""
    return await service.sweeps.cancel(sweep_id)


@router.get("/{sweep_id}/points")
async def get_sweep_points(
    sweep_id: str,
    service: ServiceDep,
    page: Annotated[ListPage, pages(Number, usual=MOST_POINTS, most=MOST_POINTS)],
    offset: Annotated[int, Query(ge=0, description="Number of points to skip")] = 0,
    sort: Annotated[str, Query(max_length=200, description="Order: an axis, a figure, runs, ok or tripped")] = "",
    descending: bool = False,
) -> SweepPoints:
    """Return figures, confusion, delays and receiver operating characteristics of the runs done so far.

    Points without runs are listed only where neither a page nor an order is asked for.
    """

    def read(survey: Survey) -> dict[str, Any]:
        order = survey.order(sort, descending=descending)
        first = offset + (survey.place_after(order, page.after[0]) if page.after else 0)
        is_page = page.limit != MOST_POINTS or page.after or sort or offset
        rows = order[first : first + (page.limit or MOST_POINTS) + 1].tolist() if is_page else range(survey.points)
        chosen = page.rows(rows, lambda number: (number,))
        about = {"found": len(order), "quantities": survey.quantities, "figures": survey.figures}
        about["words"] = diagnosis_words(survey.sweep.base.spec.diagnosers)
        return {"points": survey.page(chosen), "runs": survey.runs(), **about}

    sweep, found = await service.sweeps.surveyed(sweep_id, read)
    return SweepPoints(sweep=sweep, **found)


@router.get("/{sweep_id}/distribution")
async def get_sweep_distribution(
    sweep_id: str,
    service: ServiceDep,
    x: Annotated[str, Query(max_length=200, description="A numeric axis, the seed, or a figure")],
    y: Annotated[str, Query(max_length=200, description="A second quantity; empty for a histogram")] = "",
) -> Distribution:
    """Count the runs done so far over one quantity or two; few runs are listed as well."""
    return await service.sweeps.read(sweep_id, lambda survey: survey.distribution(x, y))


@router.get("/{sweep_id}/picture")
async def get_sweep_picture(
    sweep_id: str,
    service: ServiceDep,
    figure: Annotated[str, Query(max_length=200, description="A figure; empty: the figure that varies most")] = "",
    across: Annotated[str, Query(max_length=200, description="The varied number on the horizontal axis")] = "",
) -> CampaignPicture:
    """Return a figure over the varied quantities, and its drawing: rows, lines, a map, or a ranking with dots."""
    return await service.sweeps.read(sweep_id, lambda survey: surveyed_picture(survey, figure, across))


@router.get(
    "/{sweep_id}/runs",
    response_class=Response,
    responses={200: {"headers": RUNS, "content": {"text/csv": {}, MEDIA_TYPES["parquet"]: {}}}},
)
async def get_sweep_runs(
    sweep_id: str, service: ServiceDep, kind: Annotated[Literal["csv", "parquet"], Query(alias="format")] = "csv"
) -> Response:
    """Download one row for each run: point, seed, digest and every figure.

    While the campaign is under way, the file has the runs of its beginning, and its name ends in *so-far*.
    """
    sweep, parts = await service.sweeps.surveyed(sweep_id, lambda survey: survey.parts if survey.runs() else None)
    if parts is None:
        raise ApiError(409, "conflict", "no run of this campaign is done yet")
    runs = 0

    def put(file: BinaryIO) -> None:
        nonlocal runs
        runs = write_runs(parts, file, kind=kind)

    name = f"{sweep.name}-runs{SO_FAR if sweep.finished is None else ''}"
    response = await written_response(service, put, name, kind)
    response.headers.update({"X-Runs": str(runs), "X-State": sweep.state})
    return response


@router.get("/{sweep_id}/report", response_class=Response, responses={200: {"content": {HTML: {}}}})
async def get_sweep_report(sweep_id: str, service: ServiceDep) -> Response:
    """Download the report, one HTML file that needs nothing else."""
    text = await service.sweeps.report(sweep_id)
    return report_response(text, (await service.sweeps.get(sweep_id)).name)


@router.get("/{sweep_id}/script", response_class=Response, responses={200: {"content": {PYTHON: {}}}})
async def get_sweep_script(sweep_id: str, service: ServiceDep) -> Response:
    """Download a Python script that repeats a campaign over REST."""
    document = await service.sweeps.document(sweep_id)
    name = file_name(str(document.get("id", "sweep")), "py")
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(campaign_script(document, name), media_type=PYTHON, headers=headers)
