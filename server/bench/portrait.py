"""What a live bench looks like from outside: its status, and all that is said of it."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, Any

from core.board.words import describe
from core.faults.fault import FaultParams
from server.bench.status import ActiveFault, Bench, BenchStatus, DiagnoserInfo, Pending, State

if TYPE_CHECKING:
    from server.bench.session import Session

MAX_PENDING = 100
"""Commands that may wait for their moment."""


def status_of(session: Session) -> BenchStatus:
    """Return the status: an object nobody changes afterwards."""
    board, pacer = session.board, session.pacer
    faults: dict[str, Any] = dict(board.faults)
    state: State = "running" if session.is_running else "paused"
    if board.trip is not None:
        state = "tripped"
    return BenchStatus(
        state=state,
        tick=board.tick,
        first_tick=session.history.first_tick,
        time_scale=pacer.scale,
        achieved_scale=pacer.achieved if session.is_started else 0.0,
        capped=session.is_started and pacer.capped,
        overruns=pacer.overruns,
        given_up_ms=pacer.given_up_s * 1e3,
        controller=board.spec.active,
        faults=[
            ActiveFault(
                name=name,
                severity=params.severity,
                profile=params.profile.model_dump(),
                parameters=params.model_dump(exclude=set(FaultParams.model_fields)),
                since_tick=params.start_tick,
            )
            for name, params in faults.items()
        ],
        pending=[
            Pending(
                text=describe(entry.command),
                actor=entry.actor,
                tick=entry.tick,
                when=entry.command.when,
            )
            for entry in islice(board.pending, MAX_PENDING)
        ],
        trip=board.trip,
        scores=board.scores(),
        last_event=session.events.last,
        recording=list(session.recordings.under_way),
        armed=list(session.recordings.armed),
    )


def bench_of(session: Session, around: dict[str, Any], view3d: str | None) -> Bench:
    """Describe a bench in full.

    Parameters
    ----------
    session : Session
        The bench.
    around : dict
        Fields of the status that the bench itself does not know.
    view3d : str or None
        Path of its 3D page.
    """
    spec, last = session.board.spec, session.events.last
    return Bench(
        **{**dict(session.status), **around, "last_event": last},
        id=session.id,
        title=session.scenario.head.title or session.scenario.id,
        scenario_id=session.scenario.id,
        source=session.scenario.head.source,
        created=session.created,
        seed=spec.seed,
        dt_ms=session.dt_ms,
        sample_rate_khz=spec.frame.sample_rate_khz,
        samples=session.scenario.samples,
        drive_period_ticks=session.drive_period_ticks,
        history_ticks=session.history.capacity,
        signals=list(session.signals),
        controllers=list(spec.controllers),
        diagnosers={
            name: DiagnoserInfo(
                kind=section.block.name,
                names=[item.name for item in getattr(section.params, "hypotheses", ())],
            )
            for name, section in session.board.diagnosers.items()
        },
        parameters=document_now(session),
        view3d=view3d,
        replay_of=session.replay_of or None,
        recorded_scale=session.recorded_scale,
    )


def document_of(session: Session) -> dict[str, Any]:
    """Return what happened on a bench as a scenario; run headless it gives the same bits."""
    title = session.scenario.head.title or session.scenario.id
    head = {
        "schema": 1,
        "id": f"{session.scenario.id[:58]}-live",
        "title": f"{title}, as run live"[:200],
        "source": session.scenario.head.source,
    }
    graded = {key: value for key, value in session.scenario.document.items() if key in ("expect", "metrics")}
    document = {**head, **session.board.save(), **graded}
    if session.board.tick == 0:  # nothing has happened yet: what is saved is what would
        document.pop("samples", None)
        if session.scenario.samples is not None:
            document["samples"] = session.scenario.samples
    return document


def document_now(session: Session) -> dict[str, Any]:
    """Return what the bench is made of now, its twins included."""
    board = session.board
    twins = getattr(board, "base", {}).get("twins")
    return {**board.spec.document, **({"twins": twins} if twins else {})}


def design_of(session: Session) -> dict[str, Any]:
    """Return the scenario of a bench as it is set now, from tick 0: live changes, but nothing that happened."""
    return {**session.scenario.document, **document_now(session)}
