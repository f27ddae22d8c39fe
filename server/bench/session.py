"""One live bench: a board, its history, its events. Only the engine thread changes it.

The event loop reads three parts at any time: the history (settled ticks), the events (locked) and `status`, an object
that is replaced whole.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any, get_args

from core.board.board import Board
from core.board.commands import MakeSafe
from core.board.document import Document
from core.errors import InputError
from core.format import format_short
from scenarios.schema import Scenario
from server.bench import commands
from server.bench.changes import Changes
from server.bench.events import Event, EventLog
from server.bench.fast_forward import FastForwarding
from server.bench.hiding import BlindView, Hiding
from server.bench.moment import Moment
from server.bench.pacing import Pacer
from server.bench.portrait import bench_of, document_now, status_of
from server.bench.recorder import Recorder
from server.bench.recordings import Recordings
from server.bench.snapshots import Snapshots
from server.bench.status import Bench, Opened
from server.bench.steps import Steps
from server.bench.tick_source import TickSource
from server.bench.timeline import Timeline
from server.bench.watch import Watch
from server.errors import not_found
from server.metrics import Metrics

STATUS_S = 0.2
STUDENT_PAST_TICKS = 2000
"""Ticks of the past that a jump on the bench of a student brings along."""


class Session(Timeline):
    """A live bench.

    Parameters
    ----------
    scenario : Scenario
        The scenario of the bench.
    board : TickSource
        The board built from the scenario; or a recording that is played.
    time_scale : float or None
        Device seconds per wall second; none means as fast as possible.
    history_ticks : int
        Ticks every signal is kept for.
    metrics : Metrics
        Where ticks and overruns are counted.
    clock : callable
        The engine's clock.
    """

    replay_of = ""
    """The recording it plays, if it does."""
    recorded_scale: float | None = None
    """Device seconds per wall second of the recording."""
    opened: Opened | None = None
    """The experiment it was opened from, if it was."""
    keep = False
    """Whether it is never let go."""
    class_id = ""
    """The class whose student has it."""
    most_scale = math.inf
    """The highest time scale allowed."""
    witness: Callable[[Session, Event], None] | None = None
    """Hears of every event."""
    watch: Watch | None = None
    """Looks at the bench for a step of a lab sheet."""

    def __init__(
        self,
        scenario: Scenario,
        board: TickSource,
        time_scale: float | None,
        history_ticks: int,
        metrics: Metrics,
        clock: Callable[[], float],
    ) -> None:
        super().__init__(scenario, board, history_ticks, clock)
        self.id = ""  # given when it is taken in
        self.created = datetime.now(UTC)
        self.pacer = Pacer(board.dt_ms * 1e-3, time_scale)
        self.changes = Changes(self, clock)
        self.snapshots = Snapshots(self)
        self.recordings = Recordings(self)
        self.hiding = Hiding(self)
        self._metrics = metrics
        self.events = EventLog(self._happened)
        self.steps = Steps(self)
        self.fast_forward = FastForwarding(self)
        self._running, self._closed = False, False
        self._ends_at = scenario.samples
        self._counted, self._status_due = (0, 0.0), 0.0
        self.refresh_status()

    @property
    def is_running(self) -> bool:
        """Whether time runs, until a pause or to the end of a step."""
        return self._running or bool(self.steps)

    @property
    def is_started(self) -> bool:
        """Whether time runs until it is paused."""
        return self._running

    def target(self, now: float) -> int | None:
        """Return the tick to reach in this round; the bench stops once at the end of its scenario."""
        if self.steps:
            return None
        target = self.pacer.target(self.board.tick, now)
        if self._ends_at is not None:
            return self._ends_at if target is None else min(target, self._ends_at)
        return target

    def slice(self, target: int | None) -> bool:
        """Advance by one slice; true while there is more to do."""
        if self.steps:
            return self.steps.slice()
        wanted = self.board.chunk if target is None else target - self.board.tick
        if wanted > 0 and not self.fast_forward.advance(wanted):
            return False
        if self._ends_at is not None and self.board.tick >= self._ends_at and self._running:
            self._finish()
        return self._running and (target is None or self.board.tick < target)

    def finish_round(self, target: int | None, now: float) -> None:
        """Account for a round; refresh the status now and then."""
        if self._running:
            self.pacer.record(self.board.tick, target if self.pacer.scale is not None else None, now)
        overruns, given_up = self._counted
        self._metrics.overruns.inc(max(0, self.pacer.overruns - overruns))
        self._metrics.given_up_seconds.inc(max(0.0, self.pacer.given_up_s - given_up))
        self._counted = (self.pacer.overruns, self.pacer.given_up_s)
        if now >= self._status_due:
            self._status_due = now + STATUS_S
            self.refresh_status()

    def fail(self, error: Exception) -> None:
        """Pause after an unexpected error, and note it."""
        self._running = False
        self.steps.end()
        self.note("board", "failed", f"stopped by an internal error: {error}")
        self.refresh_status()

    def belong(self, class_id: str, most_ticks_per_s: float) -> None:
        """Be the bench of a student: one of many, so it stays, is no faster than all can be, and keeps less."""
        self.class_id, self.keep, self.past_ticks = class_id, True, STUDENT_PAST_TICKS
        self.most_scale = most_ticks_per_s * self.dt_ms * 1e-3
        if self.pacer.scale is not None and self.pacer.scale > self.most_scale:
            self.pacer = Pacer(self.dt_ms * 1e-3, self.most_scale)

    def begin(self, start: bool) -> None:
        """Begin, running or paused."""
        self._running = start
        if self._ends_at is not None and self.board.tick >= self._ends_at:
            self._ends_at = None
        self.pacer.anchor(self.board.tick, self._clock())
        self._share_log()
        self.note("board", "opened", "running" if start else f"paused at tick {self.board.tick}")
        self.fast_forward.begin()
        self.refresh_status()

    def execute(self, command: Any, actor: str) -> Event | Future[Event]:
        """Carry out a command at this tick edge; for a step, return a future that holds its event at its end.

        Raises
        ------
        InputError
            If the command cannot be carried out; nothing has changed then.
        """
        self.must_be_open()
        if isinstance(command, get_args(commands.RunsBench)):
            event = self._run_command(command, actor)
            if isinstance(event, Future):  # its end refreshes the status
                return event
        else:
            if len(self.board.pending) >= commands.MAX_PENDING and not isinstance(command, MakeSafe):
                raise InputError(f"{commands.MAX_PENDING} commands wait for their moment already", code="limit")
            event = self.changes.apply(command, actor)
            self.fast_forward.end()
            self._running = self._running and self.board.trip is None
        self.refresh_status()
        return event

    def must_be_open(self) -> None:
        """Raise an error if the bench is gone."""
        if self._closed:
            raise not_found("bench", self.id)

    def reset(self, scenario: Scenario, board: Board, actor: str, before_tick: int | None = None) -> Event:
        """Begin again with a new board of the same signals; given a tick, run at once to shortly before it."""
        if [signal.name for signal in board.signals] != list(self._index):
            text = "these values give the bench other signals"
            raise InputError(text, "values", "make a new bench for them", "conflict")
        before = self.moment(with_past=True)
        self._begin_again(scenario, board)
        self._ends_at = scenario.samples
        self._jumped("the bench was reset")
        event = self.note(actor, "reset", "reset to tick 0")
        self._share_log()
        self.changes.jumped(event, before)
        self._running = self._running or before_tick is not None
        self.fast_forward.begin(before_tick)
        self.refresh_status()
        return event

    def has_signals_of(self, other: Timeline) -> bool:
        """Whether another bench could take the place of this one."""
        return list(other._index) == list(self._index)

    def become(self, other: Session, actor: str, text: str, start: bool) -> Event:
        """Go on as another bench of the same signals that nobody has, with its past and its pace."""
        assert isinstance(other.board, Board)
        before = self.moment(with_past=True)
        self._begin_again(other.scenario, other.board)
        self.history, self.pacer = other.history, other.pacer
        self._ends_at = other.ends_at
        self._jumped(text)
        event = self.note(actor, "reset", text, tick=0)
        self._share_log()
        self.changes.jumped(event, before)
        self._running = start and self.board.trip is None
        self.refresh_status()
        return event

    @property
    def ends_at(self) -> int | None:
        """The end of its scenario, if that is ahead."""
        return self._ends_at if self._ends_at is not None and self.board.tick < self._ends_at else None

    def restore(self, snapshot_id: str, actor: str) -> Event:
        """Go back to a snapshot."""
        kept, before = self.snapshots.get(snapshot_id), self.moment(with_past=True)
        self.go_to(kept.moment)
        text = f"went back to {kept.snapshot.name or kept.snapshot.id}"
        event = self.events.add(self.board.tick, actor, "restored", text, new=kept.moment.last_event)
        self.changes.jumped(event, before)
        self.refresh_status()
        return event

    def moment(self, with_past: bool = False) -> Moment:
        """Return what the bench is now, for a jump that empties the history with the past before it."""
        return replace(super().moment(with_past), last_event=self.events.last)

    def go_to(self, moment: Moment) -> None:
        """Be what the bench was."""
        self._be_again(moment)
        self._share_log()
        samples = self.scenario.samples
        self._ends_at = samples if samples is not None and self.board.tick < samples else None
        self._jumped("the bench was restored")

    def fork(self, snapshot_id: str | None) -> Session:
        """Return a second bench that goes on from this moment or from a snapshot."""
        moment = self.snapshots.get(snapshot_id).moment if snapshot_id else self.moment()
        board = Board.restore(moment.checkpoint)
        twin = Session(moment.scenario, board, self.pacer.scale, self._history_ticks, self._metrics, self._clock)
        twin._ends_at = self._ends_at if self._ends_at is not None and board.tick < self._ends_at else None
        if self._branches.share(moment.branch, board.tick) and (past := self._past(board.tick)) is not None:
            twin.history.append(past)
        twin.note("api", "forked", f"forked from bench {self.id}")
        twin.refresh_status()
        return twin

    def close(self) -> list[Recorder]:
        """Stop for good; return the recordings that were under way."""
        self._running, self._closed = False, True
        self.steps.end()
        return self.recordings.close()

    def _run_command(self, command: commands.RunsBench, actor: str) -> Event | Future[Event]:
        """Carry out a command that runs the bench."""
        document = command.model_dump()
        if isinstance(command, commands.Undo | commands.Redo):
            return self.changes.back(actor) if isinstance(command, commands.Undo) else self.changes.again(actor)
        if isinstance(command, commands.Seek | commands.Loop):
            raise InputError("only a recording that is played can do that", "kind", code="conflict")
        if isinstance(command, commands.TimeScale):
            old, new = self.pacer.scale, command.value
            if new is not None and new > self.most_scale:
                most = format_short(self.most_scale, "s/s")
                raise InputError(f"the benches of a class run at {most} at most", "value", code="limit")
            self.pacer.rescale(new, self.board.tick, self._clock(), self._running)
            text = f"time scale set to {format_short(new, 's/s')}" if new else "time runs as fast as possible"
            return self.events.add(self.board.tick, actor, "time_scale", text, document, old, new)
        if isinstance(command, commands.Pause):
            self._running = False
            self.steps.end()
            return self.note(actor, "pause", "paused", document)
        if self.board.trip is not None:
            text = f"the board has tripped: {self.board.trip.reason}"
            raise InputError(text, hint="reset the trip first", code="tripped")
        if isinstance(command, commands.Start | commands.FastForward):
            skips = isinstance(command, commands.FastForward) and self.fast_forward.skip(
                command.before_tick, self._ends_at
            )
            self.steps.end()
            self._running = True
            self.pacer.anchor(self.board.tick, self._clock())
            return self.note(actor, command.kind, skips or "started", document)
        ended = self.steps.add(command, actor)
        self._running = False
        return ended

    def advance(self, ticks: int) -> int:
        """Run ticks, as many as a slice has; keep them, record them, note what happened; return how many there were."""
        watch = self.watch if self.hiding.blind is None else None  # what holds would tell what is hidden
        rows = self._advance_slice(ticks if watch is None else watch.room(self.board.tick, ticks))
        if rows.count:
            self._metrics.ticks.inc(rows.count)
            self.recordings.take(rows)
            if watch is not None:
                watch.look(self)
        if self.board.trip is not None and self._running and not self._has_due():
            self._running = False
            self.refresh_status()
        return rows.count

    def _share_log(self) -> None:
        """Take over what the board has noted so far, and let it note in the log of the bench from now on."""
        for entry in self.board.log:
            self.events.add(entry.tick, entry.actor, entry.kind, entry.text, entry.command, entry.old, entry.new)
        self.board.log = self.events

    def _happened(self, event: Event) -> None:
        """Count an event, tell of it, and write it into the recordings under way."""
        if not self.hiding.hear(event):
            self._metrics.events.labels(event.kind).inc()
        self.recordings.record(event)
        if self.witness is not None:
            self.witness(self, event)

    def _finish(self) -> None:
        """Pause at the end of the scenario; starting again goes beyond it."""
        self._running, self._ends_at = False, None
        self.note("scenario", "finished", "scenario finished; start again to go on")
        self.refresh_status()

    def _jumped(self, why: str) -> None:
        """Follow a jump in time: recordings end, the clock is anchored anew."""
        self.steps.end()
        self.fast_forward.end()
        self.recordings.close(why)
        if self.watch is not None:
            self.watch.jumped(self.board.tick)
        if self.board.dt_ms * 1e-3 != self.pacer.dt_s:
            self.pacer = Pacer(self.board.dt_ms * 1e-3, self.pacer.scale)
        self._running = self._running and self.board.trip is None
        self.pacer.anchor(self.board.tick, self._clock())

    def note(self, actor: str, kind: str, text: str, command: Document | None = None, tick: int | None = None) -> Event:
        """Add an event of the bench itself, of now unless a tick is given."""
        return self.events.add(self.board.tick if tick is None else tick, actor, kind, text, command)

    @property
    def document(self) -> Document:
        """The document of the bench as it is now."""
        return document_now(self)

    @property
    def scenario_id(self) -> str:
        """Of its scenario, for the names of files."""
        return self.scenario.id

    @property
    def about(self) -> Document:
        """What a file of its trace says of it."""
        return {"scenario": self.scenario.document, "bench": self.id}

    def describe(self, around: dict[str, Any], view3d: str | None) -> Bench:
        """Describe the bench in full."""
        return bench_of(self, around, view3d)

    def refresh_status(self) -> None:
        """Replace the status by that of now."""
        self.status = status_of(self)


Seen = Session | BlindView
"""A bench as somebody sees it."""
