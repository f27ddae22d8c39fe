"""Headless runs."""

from __future__ import annotations

import asyncio
from typing import Annotated, Any

from fastapi import APIRouter, Query, Response
from fastapi.responses import FileResponse
from pydantic import BaseModel, Field

from core.errors import InputError
from server.api.bodies import Body, StrictRoute
from server.api.deps import RateLimited, ServiceDep
from server.api.files import FORMAT_RESPONSES, HTML, PYTHON, SVG, CutDep, file_name, report_response, stored_trace
from server.bench.benches import prepare
from server.runs.jobs import Run
from server.store.traces import Format

router = APIRouter(prefix="/runs", tags=["runs"], route_class=StrictRoute)


class NewRun(Body):
    """A scenario to run."""

    scenario: str | dict[str, Any] = Field(description="Library id, TOML text, or document")
    set: dict[str, Any] = Field({}, description="Values by dotted path, written over the scenario")
    seed: int | None = Field(None, ge=0, le=2**53)
    seeds: list[int] | None = Field(
        None, min_length=2, max_length=2, description="First seed and the one behind the last"
    )


class RunList(BaseModel):
    """Runs, newest first."""

    runs: list[Run]


@router.post(
    "",
    status_code=202,
    dependencies=[RateLimited],
    responses={200: {"model": Run, "description": "The same run is there already"}},
)
async def start_run(body: NewRun, service: ServiceDep, response: Response) -> Run:
    """Queue a headless run; it does not disturb the live benches."""
    scenario, _ = await asyncio.to_thread(prepare, body.scenario, body.set, body.seed)
    seeds = [scenario.spec.seed if body.seed is None else body.seed]
    if body.seeds is not None:
        first, end = body.seeds
        most = service.settings.max_run_seeds
        if body.seed is not None:
            raise InputError("give seed or seeds, not both", "seeds")
        if not 0 <= first < end <= 2**53 or end - first > most:
            raise InputError(f"must be [first, end] with 0 <= first < end and at most {most} seeds", "seeds")
        seeds = list(range(first, end))
    await service.keeping.room()
    run, is_new = await service.jobs.start(scenario, seeds)
    response.status_code = 202 if is_new else 200
    response.headers["Location"] = f"/api/v1/runs/{run.id}"
    return run


@router.get("")
async def list_runs(service: ServiceDep) -> RunList:
    """List runs."""
    return RunList(runs=await service.jobs.all())


@router.get("/{run_id}")
async def get_run(run_id: str, service: ServiceDep) -> Run:
    """Return how far a run is, and its summary once it is done."""
    return await service.jobs.get(run_id)


@router.delete("/{run_id}", dependencies=[RateLimited])
async def cancel_run(run_id: str, service: ServiceDep) -> Run:
    """Cancel a run that waits or is under way."""
    return await service.jobs.cancel(run_id)


@router.get("/{run_id}/trace", response_class=Response, responses=FORMAT_RESPONSES)
async def get_run_trace(
    run_id: str, service: ServiceDep, cut: CutDep, kind: Annotated[Format, Query(alias="format")] = "parquet"
) -> Response:
    """Download the trace of a run (of its first seed)."""
    run, path = await service.jobs.file(run_id, ".parquet")
    return await stored_trace(service, path, run.scenario_id, kind, cut)


@router.get("/{run_id}/report", response_class=Response, responses={200: {"content": {HTML: {}}}})
async def get_run_report(run_id: str, service: ServiceDep) -> Response:
    """Download the report of a run, one HTML file that needs nothing else."""
    run, path = await service.jobs.file(run_id, ".html")
    return report_response(await asyncio.to_thread(path.read_text, "utf-8"), run.scenario_id)


@router.get("/{run_id}/thumbnail", response_class=Response, responses={200: {"content": {SVG: {}}}})
async def get_run_thumbnail(run_id: str, service: ServiceDep) -> Response:
    """Return a small drawing of a run."""
    _, path = await service.jobs.file(run_id, ".svg")
    return FileResponse(path, media_type=SVG, headers={"Cache-Control": "private, max-age=3600"})


@router.get("/{run_id}/script", response_class=Response, responses={200: {"content": {PYTHON: {}}}})
async def get_run_script(run_id: str, service: ServiceDep) -> Response:
    """Download a Python script that repeats a run over REST and checks that it gives the same bits."""
    run, path = await service.jobs.file(run_id, ".py")
    return FileResponse(path, media_type=PYTHON, filename=file_name(run.scenario_id, "py"))
