"""The trace of a live bench: columns for a picture, or every sample as a file."""

from __future__ import annotations

import asyncio
from typing import Annotated

from fastapi import Query, Response
from pydantic import BaseModel

from core.board.history import Float32Array
from core.errors import InputError
from scenarios.report.traces import schema_of
from server.api.deps import SeenDep, ServiceDep
from server.api.files import FILES, Signals, Tick, table_response
from server.api.router import Router
from server.bench.bench import Seen
from server.errors import ApiError
from server.store.traces import Format, asked, table_of
from server.stream.view import TickSpan
from server.stream.wire import MAX_COLUMNS
from server.version import VERSION

router = Router(prefix="/benches/{bench_id}/trace", tags=["trace"])


class Extremes(BaseModel):
    """Smallest and largest value of every column; null where there is no data."""

    min: list[float | None]
    max: list[float | None]


class Trace(BaseModel):
    """Columns of equal width over a span."""

    start_tick: int
    end_tick: int
    dt_ms: float
    signals: dict[str, Extremes]


@router.get(
    "",
    response_model=Trace,
    responses={200: {"model": Trace, "content": FILES}},
)
async def get_trace(
    session: SeenDep,
    service: ServiceDep,
    signals: Signals = (),
    start_tick: Tick = None,
    end_tick: Tick = None,
    columns: Annotated[int, Query(ge=1, le=MAX_COLUMNS)] = 800,
    kind: Annotated[
        Format | None, Query(alias="format", description="File with every sample; left out: columns")
    ] = None,
) -> Response | Trace:
    """Return a span of the past; the bench keeps running."""
    known = [signal.name for signal in session.signals]
    names = list(asked(signals, set(known))) or known
    indices = session.indices(names)
    history = session.history
    first, head = history.first_tick, history.end_tick
    start = first if start_tick is None else start_tick
    end = head if end_tick is None else end_tick
    if end <= start:
        raise InputError(f"the span from {start} to {end} is empty", "end_tick")
    if kind is None:
        span = TickSpan.between(start, end, columns)
        cut = await asyncio.to_thread(history.columns, indices, span.start, span.end, span.columns)
        session.captures.fold(cut, indices, span.start, span.end)
        return Trace(
            start_tick=span.start,
            end_tick=span.end,
            dt_ms=session.dt_ms,
            signals={
                name: Extremes(min=low.tolist(), max=high.tolist())
                for name, (low, high) in zip(names, cut, strict=True)
            },
        )
    end = min(end, head)
    captured = session.captures.covering(indices, start, end) if start < first else None
    if captured is None:
        start = max(start, first)
    if end <= start:
        text = f"nothing is kept of that span; the history has {first} to {head}"
        raise InputError(text, "start_tick", "captures tells which spans triggers have kept")
    if end - start > service.settings.max_trace_ticks:
        most = service.settings.max_trace_ticks
        raise ApiError(422, "too_long", f"{end - start} ticks; at most {most} at once", "end_tick")
    table = await asyncio.to_thread(_table, session, names, indices, start, end, captured)
    return await table_response(service, table, f"{session.scenario_id}-{start}-{end}", kind)


def _table(
    session: Seen, names: list[str], indices: list[int], start: int, end: int, captured: Float32Array | None
) -> object:
    """Read every sample of a span, unless a capture has them."""
    samples = session.history.read(indices, start, end) if captured is None else captured
    # Ticks that the bench overwrote during the read are missing at the old end.
    first = end - samples.shape[1]
    units = {signal.name: signal.unit for signal in session.signals}
    about = {"version": VERSION, **session.about}
    schema = schema_of({name: units[name] for name in names}, about, "float32")
    return table_of(schema, first, session.dt_ms, samples)
