"""Headless runs."""

from __future__ import annotations

import asyncio
from typing import Annotated

from fastapi import Query, Response
from fastapi.responses import FileResponse
from pydantic import BaseModel, Field

from core.board.spec import MOST_SEED
from core.errors import InputError
from scenarios.seeds import parse_seeds
from server.api.bodies import Body, Source, Values
from server.api.deps import RateLimited, ServiceDep
from server.api.files import FORMAT_RESPONSES, HTML, PYTHON, SVG, CutDep, file_name, report_response, stored_trace
from server.api.paging import RequestPage
from server.api.router import Router
from server.bench.build import prepare
from server.runs.compare import MOST, RunComparison, RunTraces, compare_runs, traces
from server.runs.listing import Run, RunFilter, clean_label
from server.store.traces import Format

router = Router(prefix="/runs", tags=["runs"])

FilterDep = Annotated[RunFilter, Query()]
Ids = Annotated[list[str], Query(min_length=2, max_length=MOST, description="Ids of runs; the first is the reference")]


class NewRun(Body):
    """A scenario to run."""

    scenario: Source
    set: Values = Field({})
    seed: int | None = Field(None, ge=0, le=2**53, description="Null: the seed of the scenario")
    label: str = Field("", max_length=1000, description="Name for the run, at most 120 characters")
    all: bool = Field(
        False,
        description="Also run controllers that never drive, and keep all signals, even of sensors that are never "
        "in use; no figure and no digest depends on it",
    )
    seeds: str | Annotated[list[int], Field(min_length=2, max_length=2)] | None = Field(
        None,
        max_length=100,
        description='"A:B", both included; earlier scripts send a list of the first seed and the seed after the last',
    )


class NewLabel(Body):
    """A name for a run or a campaign."""

    label: str = Field(max_length=1000, description="Name of at most 120 characters; empty removes the name")


class Ended(Body):
    """Runs or campaigns that have ended."""

    ids: list[str] | None = Field(None, min_length=1, max_length=1000, description="Null: all that have ended")


class Removed(BaseModel):
    """The number of removed runs or campaigns."""

    removed: int


class RunList(BaseModel):
    """Runs, newest first."""

    runs: list[Run]


@router.post(
    "",
    status_code=202,
    dependencies=[RateLimited],
    responses={200: {"model": Run, "description": "The same run existed already"}},
)
async def start_run(body: NewRun, service: ServiceDep, response: Response) -> Run:
    """Queue a headless run; it does not disturb the live benches."""
    await service.benches.check(body.scenario, body.set)
    scenario, _ = await asyncio.to_thread(prepare, body.scenario, body.set, body.seed, service.units.named_in)
    seeds = [scenario.spec.seed if body.seed is None else body.seed]
    if body.seeds is not None:
        if body.seed is not None:
            raise InputError("give seed or seeds, not both", "seeds")
        seeds = _seeds(body.seeds, service.settings.max_run_seeds)
    label = clean_label(body.label)
    await service.keeping.room()
    run, is_new = await service.jobs.start(scenario, seeds, label, everything=body.all)
    response.status_code = 202 if is_new else 200
    response.headers["Location"] = f"/api/v1/runs/{run.id}"
    return run


def _seeds(asked: str | list[int], most: int) -> list[int]:
    """Return the requested seeds."""
    if isinstance(asked, str):
        seeds = parse_seeds(asked, "seeds")
    else:
        first, end = asked
        if not 0 <= first < end <= MOST_SEED:
            raise InputError('must be "A:B", or a list [first, end] with 0 <= first < end', "seeds")
        seeds = range(first, end)
    if len(seeds) > most:
        raise InputError(f"has {len(seeds)} seeds, at most {most} (max_run_seeds)", "seeds")
    return list(seeds)


@router.get("")
async def list_runs(service: ServiceDep, wanted: FilterDep, page: RequestPage) -> RunList:
    """List runs, newest first; text, state and scenario choose among them."""
    return RunList(runs=await service.jobs.all(wanted, page))


@router.post("/remove", dependencies=[RateLimited])
async def remove_runs(body: Ended, service: ServiceDep) -> Removed:
    """Remove runs that have ended, and their files; all that have ended if none is named."""
    return Removed(removed=await service.jobs.remove(body.ids))


@router.get("/compare")
async def compare_finished_runs(service: ServiceDep, ids: Ids) -> RunComparison:
    """Compare finished runs: their figures, the differences from the first run, and their common signals."""
    runs, paths = await service.jobs.traces(ids)
    return await asyncio.to_thread(compare_runs, runs, paths)


@router.get("/compare/trace")
async def compare_traces(
    service: ServiceDep, ids: Ids, signal: str, columns: Annotated[int, Query(ge=10, le=4000)] = 400
) -> RunTraces:
    """Return one signal of several finished runs, for one plot."""
    runs, paths = await service.jobs.traces(ids)
    async with service.file_turn:
        return await asyncio.to_thread(traces, runs, paths, signal, columns)


@router.get("/{run_id}")
async def get_run(run_id: str, service: ServiceDep) -> Run:
    """Return the progress of a run, and its summary once it is done."""
    return await service.jobs.get(run_id)


@router.patch("/{run_id}", dependencies=[RateLimited])
async def rename_run(run_id: str, body: NewLabel, service: ServiceDep) -> Run:
    """Give a run a name."""
    return await service.jobs.rename(run_id, body.label)


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


@router.get("/{run_id}/scenario", response_class=Response, responses={200: {"content": {"text/plain": {}}}})
async def get_run_scenario(run_id: str, service: ServiceDep) -> Response:
    """Return the scenario of a run in TOML; a bench made of it has the same bits."""
    scenario = await service.jobs.scenario(run_id)
    name = f'attachment; filename="{scenario.id}.toml"'
    return Response(scenario.toml(), media_type="text/plain", headers={"Content-Disposition": name})


@router.get("/{run_id}/script", response_class=Response, responses={200: {"content": {PYTHON: {}}}})
async def get_run_script(run_id: str, service: ServiceDep) -> Response:
    """Download a Python script that repeats a run over REST and checks that it gives the same bits."""
    run, path = await service.jobs.file(run_id, ".py")
    return FileResponse(path, media_type=PYTHON, filename=file_name(run.scenario_id, "py"))
