"""The manual clock of a server under test: let time pass.

Mounted only where the setting `clock` is manual.
"""

from __future__ import annotations

from typing import Annotated, Self, cast

from pydantic import BaseModel, Field, model_validator

from server.api.bodies import Body
from server.api.deps import ServiceDep
from server.api.router import Router
from server.bench.bench import LiveBench
from server.bench.engine import PERIOD_S
from server.clock import ManualClock
from server.errors import ApiError
from server.service import Service

router = Router(prefix="/testing", include_in_schema=False)


class Advance(Body):
    """How far."""

    seconds: Annotated[float, Field(gt=0, le=86_400)] | None = Field(None, description="Wall time, s")
    bench: str = Field("", max_length=32, description="The bench whose ticks count")
    ticks: Annotated[int, Field(ge=1, le=20_000_000)] | None = Field(None, description="Ticks of the bench")

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.seconds is None) != bool(self.bench) or (self.ticks is None) == bool(self.bench):
            raise ValueError("give either seconds, or ticks and their bench")
        return self


class Advanced(BaseModel):
    """Where the clock and the benches are."""

    now_s: float
    ticks: dict[str, int]


@router.post("/advance")
async def advance(body: Advance, service: ServiceDep) -> Advanced:
    """Let time pass, and answer once the status of every bench has gone out."""
    clock = cast(ManualClock, service.clock)
    async with clock.turn:
        await service.engine.settle()
        if body.seconds is not None:
            await _advance(service, clock, clock() + body.seconds)
        else:
            session = service.benches.get(body.bench)
            if not session.is_running:
                raise ApiError(409, "conflict", "the bench is paused", "bench")
            goal = session.board.tick + (body.ticks or 0)
            while session.is_running and session.board.tick < goal:
                await _advance(service, clock, min(clock() + PERIOD_S, session.time.pacer.due(goal)))
        benches = service.benches.all()
        await service.engine.call(_refresh, benches)
        service.hub.show_status(benches)
    return Advanced(now_s=clock(), ticks={session.id: session.board.tick for session in benches})


async def _advance(service: Service, clock: ManualClock, until: float) -> None:
    """Advance in rounds of the engine; while no bench runs, from one loop that wakes to the next."""
    while clock() < until:
        round_end = clock() + PERIOD_S if service.engine.running else clock.next_wake_s
        await clock.advance(min(round_end, until))
        await service.engine.settle()


def _refresh(benches: list[LiveBench]) -> None:
    """Renew the status of benches (a job)."""
    for session in benches:
        session.refresh_status()
