"""The claims of a live bench: the printed, the expected and the measured figures of its run so far."""

from __future__ import annotations

import asyncio

from pydantic import BaseModel, Field

from scenarios.claims import Claim, Mark, claims, marks
from scenarios.expectation import Verdict, overall
from scenarios.knobs import Knob, knobs
from server.api.bodies import AnswerBody
from server.api.deps import ServiceDep, SessionDep
from server.api.router import Router
from server.bench.measuring import RunSoFar
from server.version import VERSION

router = Router(prefix="/benches/{bench_id}", tags=["claims"])


class BenchClaim(Claim):
    """A claim of a live bench, with the numbers that may be turned for it."""

    knobs: list[Knob]


class ClaimList(AnswerBody):
    """The claims of the scenario of a live bench, judged by the figures of a headless run."""

    bench_id: str
    scenario_id: str
    title: str
    source: str
    claim: str
    seed: int
    version: str
    tick: int = Field(description="Number of ticks that are measured")
    ends_at: int = Field(description="Tick at which a headless run ends; later ticks do not count")
    is_over: bool = Field(description="Whether the run has ended; until then no claim is marked as met or missed")
    reason: str = Field(description="Why no figure is measured; empty otherwise")
    verdict: Verdict | None = Field(description="Verdict on all claims; null until the run has ended")
    claims: list[BenchClaim]


class MarkList(BaseModel):
    """The printed marks of the figure of a bench, to be drawn under its traces; also marks that no claim judges."""

    marks: list[Mark]


@router.get("/printed")
async def list_printed(session: SessionDep) -> MarkList:
    """List the printed marks of the figure, with the ticks at which they are drawn."""
    return MarkList(marks=marks(session.scenario, session.signals))


@router.get("/claims")
async def list_claims(session: SessionDep, service: ServiceDep) -> ClaimList:
    """Measure the claims of a bench over its run since tick 0, with the bits of a headless run."""
    run = await service.engine.call(RunSoFar.of, session)
    figures = await asyncio.to_thread(session.measuring.figures, run)
    scenario, signals = run.scenario, session.signals
    found = claims(scenario, figures.metrics or {}, signals, figures.is_over)
    return ClaimList.of(
        scenario.head,
        figures,
        run,
        bench_id=session.id,
        scenario_id=scenario.id,
        seed=session.board.spec.seed,
        version=VERSION,
        verdict=overall(claim.verdict for claim in found),
        claims=[
            BenchClaim(**dict(claim), knobs=knobs(scenario, entry))
            for claim, entry in zip(found, scenario.head.expect, strict=True)
        ],
    )
