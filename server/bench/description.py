"""Descriptions of a live bench: its status, its full description, its scenario, its experiment."""

from __future__ import annotations

import json
import math
from itertools import islice
from typing import TYPE_CHECKING, Any

from core.board.board import Board
from core.board.document import SUPERVISOR
from core.board.packages import TABLE, carried
from core.board.spec import Section, Spec
from core.board.words import describe
from core.cards import card
from core.device.two_axis import TwoAxis
from core.faults.fault import FaultParams
from scenarios.narrator.words import act_words, reason_words
from scenarios.schema import Scenario
from server.bench.commands import MAX_PENDING
from server.bench.instrument import live_record
from server.bench.status import (
    ActiveFault,
    Bench,
    BenchRecord,
    BenchStatus,
    DiagnoserInfo,
    InstrumentStatus,
    Pending,
    State,
    SupervisorAct,
    SupervisorStatus,
)
from server.errors import ApiError
from server.store.experiment import THIS_VERSION, Experiment

if TYPE_CHECKING:
    from server.bench.bench import LiveBench


def status_of(bench: LiveBench) -> BenchStatus:
    """Return the status, an object that is not changed afterwards."""
    board, pacer = bench.board, bench.time.pacer
    faults: dict[str, Any] = dict(board.faults)
    state: State = "running" if bench.is_running else "paused"
    if board.trip is not None:
        state = "tripped"
    return BenchStatus(
        state=state,
        tick=board.tick,
        first_tick=bench.history.first_tick,
        time_scale=pacer.scale,
        achieved_scale=pacer.achieved if bench.is_started else 0.0,
        fast_forward=bench.time.fast_forward.reason,
        capped=bench.is_started and pacer.capped,
        overruns=pacer.overruns,
        given_up_ms=pacer.given_up_s * 1e3,
        controller=board.spec.active,
        slots=dict(board.spec.driving),
        faults=[
            ActiveFault(
                name=name,
                severity=params.severity,
                profile=params.profile,
                parameters=params.model_dump(exclude=set(FaultParams.model_fields)),
                since_tick=params.start_tick,
            )
            for name, params in faults.items()
        ],
        pending=[
            Pending(
                text=describe(entry.command, board.spec.library),
                actor=entry.actor,
                tick=entry.tick,
                when=entry.command.when,
                command=entry.event(),
            )
            for entry in islice(board.pending, MAX_PENDING)
        ],
        undo=bench.changes.last_done,
        redo=bench.changes.last_undone,
        trip=board.trip,
        supervisor=_supervisor(board) if isinstance(board, Board) and board.spec.supervisors else None,
        instrument=_instrument(bench),
        scores={name: found for name, found in board.scores().items() if found.samples},
        last_event=bench.events.last,
        recording=list(bench.recordings.under_way),
        armed=list(bench.recordings.armed),
        earliest_tick=bench.track and bench.track.first_tick,
        travel=bench.travel and bench.travel.model_copy(),
        origin=bench.origin and bench.origin.model_copy(update={"is_past": bench.is_past}),
    )


def _instrument(bench: LiveBench) -> InstrumentStatus | None:
    """Describe the instrument that a bench plays, as it is now."""
    record = live_record(bench.board)
    if record is None:
        return None
    arrivals, now = record.arrivals, bench.clock()
    return InstrumentStatus(
        source=record.source,
        is_connected=record.is_connected,
        is_growing=record.is_growing,
        ended="" if record.is_growing else record.last_line,
        names=record.names,
        received_khz=arrivals.rate_khz(now),
        lag_ms=arrivals.lag_ms(now),
        latency_p95_ms=arrivals.latency_p95_ms,
        record=record.key,
        samples=record.samples,
        **record.order.counts(),
    )


def _supervisor(board: Board) -> SupervisorStatus:
    """Describe the supervisor of a board as it is now."""
    section = board.spec.supervisors[SUPERVISOR]
    diagnoser, names = getattr(section.params, "diagnoser", ""), set(board.signals.names)
    words = [*board.spec.banks.get(diagnoser, {}), "none fits"]

    def now(port: str) -> float | None:
        return board.value(f"{SUPERVISOR}.{port}") if f"{SUPERVISOR}.{port}" in names else None

    def said(port: str) -> str:
        index = now(port)
        return words[int(index)] if index is not None and 0 <= index < len(words) else ""

    last = board.consequences[-1] if board.consequences else None
    return SupervisorStatus(
        kind=section.block.name,
        diagnoser=diagnoser,
        verdict=said("verdict"),
        acting=said("acting"),
        held_ms=now("held_ms"),
        dead_ms=now("dead_ms"),
        acts=len(board.consequences),
        last_act=last
        and SupervisorAct(
            tick=last.tick,
            text=act_words(last.command.document(), board.spec.library),
            reason=reason_words(last.reason, board.spec.diagnosers),
        ),
    )


def _played(spec: Spec) -> BenchRecord | None:
    """Describe the record that a bench plays."""
    if spec.record is None:
        return None
    plant: Any = spec.plant.params
    labels = list(spec.record.hypotheses) if spec.record.has_labels else []
    return BenchRecord(key=plant.record, samples=spec.record.samples, labels=labels)


def bench_of(bench: LiveBench, around: dict[str, Any], view3d: str | None) -> Bench:
    """Describe a bench in full.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    around : dict
        Fields of the status that the bench itself does not know.
    view3d : str or None
        Path of its 3D page.
    """
    spec, last = bench.board.spec, bench.events.last
    return Bench(
        **{**dict(bench.status), **around, "last_event": last},
        id=bench.id,
        title=bench.scenario.head.title or bench.scenario.id,
        name=bench.name,
        scenario_id=bench.scenario.id,
        source=bench.scenario.head.source,
        created=bench.created,
        seed=spec.seed,
        dt_ms=bench.dt_ms,
        sample_rate_khz=spec.frame.sample_rate_khz,
        samples=bench.scenario.samples,
        drive_period_ticks=period_of(bench),
        history_ticks=bench.history.capacity,
        axes=list(spec.axes),
        signals=list(bench.signals),
        controllers=list(spec.controllers),
        diagnosers={
            name: DiagnoserInfo(
                kind=section.block.name,
                names=[item.name for item in getattr(section.params, "hypotheses", ())],
                factors=factors_of(section),
            )
            for name, section in bench.board.diagnosers.items()
        },
        units=[card(one.block) for one in spec.library.units],
        parameters=document_now(bench),
        view3d=view3d,
        replay_of=bench.replay_of or None,
        record=None if bench.replay_of else _played(spec),
        recorded_scale=bench.recorded_scale,
        opened=bench.opened,
        keep=bench.keep,
    )


def period_of(bench: LiveBench) -> float | None:
    """Return the period of the reference in ticks, if it has one; of the driven axis where the plant has axes."""
    spec = bench.board.spec
    if isinstance(spec.nominal, TwoAxis):
        return 2.0 * math.pi / (spec.nominal.drive_frequency * bench.dt_ms)
    frequency = getattr(spec.reference.params, "frequency_hz", None)
    return 1e3 / (float(frequency) * bench.dt_ms) if isinstance(frequency, int | float) and frequency else None


def factors_of(section: Section) -> list[dict[str, float]]:
    """Return how each hypothesis of a diagnoser differs from the nominal device."""
    hypotheses = getattr(section.params, "hypotheses", ())
    return [item.model_dump(exclude_defaults=True, exclude={"name"}) for item in hypotheses]


def document_of(bench: LiveBench) -> dict[str, Any]:
    """Return the history of a bench as a scenario; run headless it gives the same bits."""
    title = bench.scenario.head.title or bench.scenario.id
    head = {
        "schema": 1,
        "id": f"{bench.scenario.id[:58]}-live",
        "title": f"{title}, as run live"[:200],
        "source": bench.scenario.head.source,
    }
    graded = {key: value for key, value in bench.scenario.document.items() if key in ("expect", "metrics")}
    document = {**head, **bench.board.save(), **graded}
    if bench.board.tick == 0:  # the bench has not begun: the scenario keeps its own length
        document.pop("samples", None)
        if bench.scenario.samples is not None:
            document["samples"] = bench.scenario.samples
    return document


def document_now(bench: LiveBench) -> dict[str, Any]:
    """Return the document of the bench as it is now, its twins included."""
    board = bench.board
    twins = board.base.get("twins")
    return {**board.spec.document, **({"twins": twins} if twins else {})}


def design_of(bench: LiveBench) -> dict[str, Any]:
    """Return the scenario of a bench as it is set now, from tick 0: with live changes, without events."""
    return {**bench.scenario.document, **document_now(bench)}


def experiment_of(bench: LiveBench) -> Experiment:
    """Return the experiment of a bench (a job of the engine).

    Raises
    ------
    ApiError
        For a recording that is played: it is kept already.
    """
    if bench.replay_of:
        raise ApiError(409, "conflict", "a recording that is played is no experiment", hint="share the bench it is of")
    board = bench.board
    document = {**bench.scenario.document, **board.base}
    events = board.save()["events"]
    if named := carried({**document, "events": events}).get(TABLE):  # commands may name other packages
        document[TABLE] = named
    plain = json.loads(json.dumps({"scenario": document, "events": events}, default=str))
    return Experiment(
        **plain,
        tick=board.tick,
        digest=board.digest(),
        version=THIS_VERSION,
        running=bench.is_started,
        time_scale=bench.time.pacer.scale,
    )


def beginning_of(scenario: Scenario, board: Board, time_scale: float | None) -> Experiment:
    """Return the experiment that a scenario is before anything has been done."""
    return Experiment(
        scenario=json.loads(json.dumps(scenario.document, default=str)),
        events=board.save()["events"],
        tick=0,
        digest=board.digest(),
        version=THIS_VERSION,
        running=True,
        time_scale=time_scale,
    )
