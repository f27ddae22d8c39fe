"""The captures of a live bench: which stretches its triggers have kept at full rate."""

from __future__ import annotations

from pydantic import BaseModel, Field

from server.api.bodies import AnswerBody
from server.api.deps import SeenDep, ServiceDep
from server.api.router import Router
from server.bench.captures import CaptureSet
from server.stream.wire import CaptureMark

router = Router(prefix="/benches", tags=["trace"])


class TriggerCaptures(AnswerBody):
    """The captures of one trigger, oldest first."""

    signals: list[str]
    trigger: str = Field(description="Name of the signal that triggers")
    edge: str
    level: float
    upper: float | None
    hysteresis: float
    window_ticks: int
    before_ticks: int = Field(description="Ticks of the window before the trigger")
    captures: list[CaptureMark]
    is_short: bool = Field(description="Whether memory limits the number of captures")


class BenchCaptures(BaseModel):
    """The captures of a bench, by trigger; the trigger of the scope that was opened last comes last."""

    triggers: list[TriggerCaptures]


@router.get("/{bench_id}/captures")
async def list_captures(session: SeenDep, service: ServiceDep) -> BenchCaptures:
    """List the captures of a bench; a trace of the signals, start_tick and end_tick of one has every sample of it."""
    await service.hub.capture(session)
    return BenchCaptures(triggers=[_described(kept) for kept in session.captures.sets()])


def _described(kept: CaptureSet) -> TriggerCaptures:
    """Describe the captures of a trigger."""
    marks = [CaptureMark.of(one) for one in kept.captures]
    what = kept.what
    return TriggerCaptures.of(what, kept, window_ticks=what.window, before_ticks=what.before, captures=marks)
