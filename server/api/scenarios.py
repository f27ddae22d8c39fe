"""The library of scenarios, and a check for a user's own."""

from __future__ import annotations

from typing import Any

from fastapi import Response
from pydantic import BaseModel, Field

from core.board.document import plant_of
from core.errors import InputError
from scenarios.claims import check_marks
from scenarios.expectation import Verdict
from scenarios.library import get, ids, library
from scenarios.schema import Scenario
from server.api.bodies import AnswerBody, Body, Source
from server.api.deps import ServiceDep
from server.api.router import Router
from server.bench.build import prepare
from server.classroom.blind_class import check as check_hidden
from server.errors import not_found

router = Router(prefix="/scenarios", tags=["scenarios"])


class ScenarioCard(AnswerBody):
    """A scenario of the library in a few words."""

    id: str
    title: str
    source: str
    summary: str
    claim: str
    verdict: Verdict | None = Field(description="Verdict if all expectations hold; it follows from the rows")
    samples: int | None
    plant: str | None = Field(description="Plant of the bench; null for a study")
    study: str | None = Field(description="Kind of the study; null for a scenario that runs on a bench")
    can_hide: bool = Field(description="Whether a fault can be hidden on its bench, for a class to find")


class ScenarioList(BaseModel):
    """The library."""

    scenarios: list[ScenarioCard]


class ScenarioText(AnswerBody):
    """A scenario in full."""

    document: dict[str, Any]
    toml: str
    warnings: list[str] = Field(description="Parts of its claims that are not read or cannot be judged")


class ScenarioSource(Body):
    """A scenario to check."""

    scenario: Source


def card(scenario: Scenario) -> ScenarioCard:
    """Describe a scenario in a few words."""
    head = scenario.head
    return ScenarioCard.of(
        scenario,
        head,
        plant=plant_of(scenario.document).name if head.study is None else None,
        study=str(head.study["kind"]) if head.study is not None else None,
        can_hide=_can_hide(scenario),
    )


def _can_hide(scenario: Scenario) -> bool:
    try:
        check_hidden(scenario)
    except InputError:
        return False
    return True


@router.get("")
def list_scenarios() -> ScenarioList:
    """List the library."""
    return ScenarioList(scenarios=[card(scenario) for scenario in library()])


@router.get("/{scenario_id}")
def get_scenario(scenario_id: str) -> ScenarioText:
    """Return a scenario of the library as a document and as TOML."""
    if scenario_id not in ids():
        raise not_found("scenario", scenario_id, "list them at /api/v1/scenarios", known=ids())
    scenario = get(scenario_id)
    return ScenarioText.of(scenario, toml=scenario.toml())


@router.post("/check", response_model=ScenarioText)
async def check_scenario(body: ScenarioSource, service: ServiceDep) -> Response:
    """Check a scenario without running it; the answer 422 lists its errors."""
    return Response(await service.computing.call(_checked, body.scenario), media_type="application/json")


def _checked(source: str | dict[str, Any]) -> str:
    """Return a scenario that has been checked, as JSON."""
    scenario, board = prepare(source, {}, None, compiled=False)
    check_marks(scenario, board.signals)
    try:
        found = ScenarioText.of(scenario, toml=scenario.toml())
    except (TypeError, ValueError) as error:
        raise InputError(f"cannot be written as TOML: {error}", "scenario") from None
    return found.model_dump_json()
