"""A bench as one HTML file, which any browser runs without a server."""

from __future__ import annotations

from typing import Any

from fastapi import Response

from core.own.admission import kept
from scenarios.in_a_file.bench_file import bench_file
from scenarios.in_a_file.exhibit import exhibit
from scenarios.in_a_file.html import BuiltPage
from scenarios.library import get, ids
from scenarios.schema import Scenario
from server.api.deps import ServiceDep, SessionDep
from server.api.files import HTML, file_name
from server.api.page import DIST
from server.api.router import Router
from server.bench.build import read_scenario
from server.bench.description import design_of
from server.errors import not_found
from server.service import Service
from server.version import VERSION

MOST_S = 300.0
"""Processor time of a file: its scenario runs to its end, and each block that no file on this machine has had before is
lowered."""
ANSWERS: dict[int | str, dict[str, Any]] = {200: {"content": {HTML: {}}}}

router = Router(tags=["scenarios"])


@router.get("/scenarios/{scenario_id}/file.html", response_class=Response, responses=ANSWERS)
async def get_scenario_file(scenario_id: str, service: ServiceDep) -> Response:
    """Download a scenario of the library as a live bench in one HTML file, which runs without a server."""
    if scenario_id not in ids():
        raise not_found("scenario", scenario_id, "list them at /api/v1/scenarios", known=ids())
    return await _answer(service, get(scenario_id).document, scenario_id)


@router.get("/benches/{bench_id}/file.html", response_class=Response, responses=ANSWERS)
async def get_bench_file(session: SessionDep, service: ServiceDep) -> Response:
    """Download a bench as it is set now, from tick 0 on, as a live bench in one HTML file."""
    document = await service.engine.call(design_of, session)
    return await _answer(service, document, session.scenario.id)


async def _answer(service: Service, document: dict[str, Any], name: str) -> Response:
    text = await service.computing.call(html_file, document, most_s=MOST_S)
    headers = {"Content-Disposition": f'attachment; filename="{file_name(name, "html")}"'}
    return Response(text, media_type=HTML, headers=headers)


def html_file(document: dict[str, Any]) -> str:
    """Return the file of a scenario, with its published run.

    Raises
    ------
    InputError
        When it cannot be a bench in a file, or the page has not been built.
    """
    with kept():
        scenario: Scenario = read_scenario(document)
    return exhibit(scenario, bench_file(scenario), BuiltPage.of(DIST / "in-a-file"), VERSION).text
