"""The places of the page: addresses by which it opens at the gallery, an experiment, a run, a device, equations."""

from __future__ import annotations

from typing import cast

from fastapi import APIRouter, Request, Response

from core.device.catalogue import devices
from scenarios.library import ids
from server.api.deps import ServiceDep
from server.api.page import Page

router = APIRouter(include_in_schema=False)


@router.get("/class")
@router.get("/design")
@router.get("/gallery")
@router.get("/runs")
@router.get("/scores")
@router.get("/theory")
@router.get("/theory/{words}")
async def show_page(request: Request) -> Response:
    """Show a page as a whole, or the equations that have some words; the page counts these."""
    return _page(request, True)


@router.get("/design/{device_id}")
async def show_device(request: Request, device_id: str) -> Response:
    """Show a device of the catalogue in the designer."""
    return _page(request, any(device.id == device_id for device in devices()))


@router.get("/gallery/{scenario_id}")
async def show_experiment(request: Request, scenario_id: str) -> Response:
    """Show an experiment of the gallery."""
    return _page(request, scenario_id in ids())


@router.get("/runs/{run_ids}")
async def show_runs(request: Request, run_ids: str, service: ServiceDep) -> Response:
    """Show a run, a campaign, or several runs side by side, whose ids are separated by commas."""
    wanted = set(run_ids.split(","))
    requests = service.queue.requests
    known = [*await requests.some("run", [*wanted]), *await requests.some("campaign", [*wanted])]
    return _page(request, wanted == {row.id for row in known})


def _page(request: Request, is_there: bool) -> Response:
    """Return the page, which says so itself where a place has nothing to show."""
    return cast(Page, request.app.state.page).shown(request.scope, 200 if is_there else 404)
