"""Campaigns: start, watch, cancel, read the results."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Response
from pydantic import BaseModel, Field

from core.nesting import read_toml
from scenarios.campaign.tally import PointTally
from scenarios.report.script import campaign_script
from server.api.bodies import Body, StrictRoute
from server.api.deps import RateLimited, ServiceDep
from server.api.files import HTML, PYTHON, file_name, report_response, table_response
from server.api.runs import Ended, FilterDep, NewLabel, Removed
from server.errors import ApiError
from server.runs import apart
from server.runs.listing import clean_label
from server.runs.sweeps import SweepRun
from server.store.traces import MEDIA_TYPES

router = APIRouter(prefix="/sweeps", tags=["sweeps"], route_class=StrictRoute)


class NewSweep(Body):
    """A campaign to run."""

    sweep: str | dict[str, Any] = Field(description="Campaign as TOML text or as a document")
    label: str = Field("", max_length=1000, description="Name for the campaign, at most 120 characters")


class SweepList(BaseModel):
    """Campaigns, newest first."""

    sweeps: list[SweepRun]


class SweepPoints(BaseModel):
    """Results of a campaign, point by point."""

    sweep: SweepRun
    points: list[PointTally]


@router.post(
    "",
    status_code=202,
    dependencies=[RateLimited],
    responses={200: {"model": SweepRun, "description": "The same campaign is there already"}},
)
async def start_sweep(body: NewSweep, service: ServiceDep, response: Response) -> SweepRun:
    """Start a campaign, or go on with one that was stopped; a second request for a campaign returns the same one."""
    document = body.sweep if isinstance(body.sweep, dict) else await asyncio.to_thread(read_toml, body.sweep, "sweep")
    label = clean_label(body.label)
    await service.keeping.room()
    sweep, is_new = await service.sweeps.start(document, label)
    response.status_code = 202 if is_new else 200
    response.headers["Location"] = f"/api/v1/sweeps/{sweep.id}"
    return sweep


@router.get("")
async def list_sweeps(service: ServiceDep, wanted: FilterDep) -> SweepList:
    """List campaigns, newest first; text, state and scenario choose among them."""
    return SweepList(sweeps=await service.sweeps.all(wanted))


@router.post("/remove", dependencies=[RateLimited])
async def remove_sweeps(body: Ended, service: ServiceDep) -> Removed:
    """Remove campaigns that have ended; all that have ended if none is named."""
    return Removed(removed=await service.sweeps.remove(body.ids))


@router.get("/{sweep_id}")
async def get_sweep(sweep_id: str, service: ServiceDep) -> SweepRun:
    """Return how far a campaign is."""
    return await service.sweeps.get(sweep_id)


@router.patch("/{sweep_id}", dependencies=[RateLimited])
async def rename_sweep(sweep_id: str, body: NewLabel, service: ServiceDep) -> SweepRun:
    """Give a campaign a name."""
    return await service.sweeps.rename(sweep_id, body.label)


@router.delete("/{sweep_id}", dependencies=[RateLimited])
async def cancel_sweep(sweep_id: str, service: ServiceDep) -> SweepRun:
    """Stop a campaign; the runs that are done stay."""
    return await service.sweeps.cancel(sweep_id)


@router.get("/{sweep_id}/points", response_model=SweepPoints)
async def get_sweep_points(sweep_id: str, service: ServiceDep) -> Response:
    """Return figures, confusion, delays and receiver operating characteristics of the runs done so far."""
    points = await service.sweeps.read(sweep_id, apart.points)
    sweep = (await service.sweeps.get(sweep_id)).model_dump_json().encode()
    return Response(b'{"sweep":%b,"points":%b}' % (sweep, points), media_type="application/json")


@router.get(
    "/{sweep_id}/runs",
    response_class=Response,
    responses={200: {"content": {MEDIA_TYPES[kind]: {} for kind in ("csv", "parquet")}}},
)
async def get_sweep_runs(
    sweep_id: str, service: ServiceDep, kind: Annotated[Literal["csv", "parquet"], Query(alias="format")] = "csv"
) -> Response:
    """Download one row for each run that is done: point, seed, digest and every figure."""
    table = await service.sweeps.read(sweep_id, apart.table)
    if not table.num_rows:
        raise ApiError(409, "conflict", "no run of this campaign is done yet")
    return await table_response(service, table, f"{(await service.sweeps.get(sweep_id)).name}-runs", kind)


@router.get("/{sweep_id}/report", response_class=Response, responses={200: {"content": {HTML: {}}}})
async def get_sweep_report(sweep_id: str, service: ServiceDep) -> Response:
    """Download the report, one HTML file that needs nothing else."""
    text = await service.sweeps.read(sweep_id, apart.report)
    return report_response(text, (await service.sweeps.get(sweep_id)).name)


@router.get("/{sweep_id}/script", response_class=Response, responses={200: {"content": {PYTHON: {}}}})
async def get_sweep_script(sweep_id: str, service: ServiceDep) -> Response:
    """Download a Python script that repeats a campaign over REST."""
    document = await service.sweeps.document(sweep_id)
    name = file_name(str(document.get("id", "sweep")), "py")
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(campaign_script(document, name), media_type=PYTHON, headers=headers)
