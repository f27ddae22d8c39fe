"""The captures of a live bench: which stretches its triggers have kept at full rate."""

from __future__ import annotations

from pydantic import BaseModel, Field

from server.api.deps import SeenDep, ServiceDep
from server.api.router import Router
from server.bench.captures import CaptureSet
from server.stream.wire import CaptureMark

router = Router(prefix="/benches", tags=["trace"])


class TriggerCaptures(BaseModel):
    """The captures of one trigger, oldest first."""

    signals: list[str]
    trigger: str = Field(description="The signal that triggers")
    edge: str
    level: float
    upper: float | None
    hysteresis: float
    window_ticks: int
    before_ticks: int = Field(description="Ticks of the window before the trigger")
    captures: list[CaptureMark]
    is_short: bool = Field(description="Memory leaves room for no more of them")

    @classmethod
    def of(cls, kept: CaptureSet) -> TriggerCaptures:
        """Describe the captures of a trigger."""
        what = kept.what
        return cls(
            signals=list(what.signals),
            trigger=what.trigger,
            edge=what.edge,
            level=what.level,
            upper=what.upper,
            hysteresis=what.hysteresis,
            window_ticks=what.window,
            before_ticks=what.before,
            captures=[CaptureMark.of(one) for one in kept.captures],
            is_short=kept.is_short,
        )


class BenchCaptures(BaseModel):
    """The captures of a bench, by trigger; the trigger of the scope that was opened last comes last."""

    triggers: list[TriggerCaptures]


@router.get("/{bench_id}/captures")
async def list_captures(session: SeenDep, service: ServiceDep) -> BenchCaptures:
    """List the captures of a bench; a trace of the signals, start_tick and end_tick of one has every sample of it."""
    await service.hub.capture(session)
    return BenchCaptures(triggers=[TriggerCaptures.of(kept) for kept in session.captures.sets()])
