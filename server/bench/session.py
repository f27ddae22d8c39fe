"""One live bench: a board, its history, its events. Only the engine thread changes it.

The event loop reads three parts at any time: the history (settled ticks), the events (locked) and `status`, an object
that is replaced whole.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any, get_args

from core.board.board import Board
from core.board.commands import MakeSafe
from core.board.document import Document
from core.board.track import Track
from core.errors import InputError
from scenarios.schema import Scenario
from server.bench import commands
from server.bench.changes import Changes
from server.bench.events import Event, EventLog
from server.bench.hiding import BlindView, Hiding
from server.bench.moment import Moment
from server.bench.narration import Narration
from server.bench.pacing import Pacer
from server.bench.portrait import bench_of, document_now, status_of
from server.bench.recorder import Recorder
from server.bench.recordings import Recordings
from server.bench.running import Running
from server.bench.snapshots import Snapshots
from server.bench.status import Bench, Opened, Travel
from server.bench.tick_source import TickSource
from server.bench.timeline import Timeline
from server.bench.watch import Watch
from server.errors import not_found
from server.metrics import Metrics

STUDENT_PAST_TICKS = 2000
"""Ticks of the past that a jump on the bench of a student brings along."""
STUDENT_TRACK_BYTES = 1_500_000
"""Memory of the checkpoints of a student's bench."""


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

    taken_over = 0
    """Number of the last event that is of the bench whose past it shows."""
    replay_of = ""
    """The recording it plays, if it does."""
    recorded_scale: float | None = None
    """Device seconds per wall second of the recording."""
    travel: Travel | None = None
    """The moment of its past that is being computed, if one is."""
    opened: Opened | None = None
    """The experiment it was opened from, if it was."""
    keep = False
    """Whether it is never let go."""
    class_id = ""
    """The class whose student has it."""
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
        self.running = Running(self, time_scale, scenario.samples, metrics)
        self.changes, self.snapshots = Changes(self, clock), Snapshots(self)
        self.recordings, self.hiding = Recordings(self), Hiding(self)
        self._metrics = metrics
        self.narration = Narration(board.spec, board.signals, board.signals.outputs)
        self._remember()
        self.events = EventLog(self._happened)
        self._closed = False
        self.refresh_status()

    @property
    def is_running(self) -> bool:
        """Whether time runs, until a pause or to the end of a step."""
        return self.running.is_running

    @property
    def is_started(self) -> bool:
        """Whether time runs until it is paused."""
        return self.running.is_started

    @property
    def pacer(self) -> Pacer:
        """The pace of the bench."""
        return self.running.pacer

    def target(self, now: float) -> int | None:
        """Return the tick to reach in this round."""
        return self.running.target(now)

    def slice(self, target: int | None) -> bool:
        """Advance by one slice; true while there is more to do."""
        return self.running.slice(target)

    def finish_round(self, target: int | None, now: float) -> None:
        """Account for a round; refresh the status now and then."""
        self.running.finish_round(target, now)

    def fail(self, error: Exception) -> None:
        """Pause after an unexpected error, and note it."""
        self.running.stop()
        self.note("board", "failed", f"stopped by an internal error: {error}")
        self.refresh_status()

    def belong(self, class_id: str, most_ticks_per_s: float) -> None:
        """Be the bench of a student, one of many: never let go, limited in pace, with less history."""
        self.class_id, self.keep = class_id, True
        self.past_ticks, self.track_bytes = STUDENT_PAST_TICKS, STUDENT_TRACK_BYTES
        if isinstance(self.board, Board):
            self.track = Track(self.board, self.track_bytes)
            self._remember()
        self.running.limit(most_ticks_per_s * self.dt_ms * 1e-3)

    def begin(self, start: bool) -> None:
        """Begin, running or paused."""
        self.running.begin(start)
        self.events.take_over(self.board)
        self.note("board", "opened", "running" if start else f"paused at tick {self.board.tick}")
        self.running.fast_forward.begin()
        self.refresh_status()

    def execute(self, command: Any, actor: str) -> Event | Future[Event]:
        """Carry out a command at this tick edge; for a step, return a future that holds its event at its end.

        Raises
        ------
        InputError
            If the command cannot be carried out; nothing has changed then.
        """
        self.must_be_open()
        if isinstance(command, get_args(commands.RunsTime)):
            event = self.running.carry_out(command, actor)
            if isinstance(event, Future):  # its end refreshes the status
                return event
        elif isinstance(command, commands.Undo | commands.Redo):
            event = self.changes.back(actor) if isinstance(command, commands.Undo) else self.changes.again(actor)
        else:
            if len(self.board.pending) >= commands.MAX_PENDING and not isinstance(command, MakeSafe):
                raise InputError(f"{commands.MAX_PENDING} commands wait for their moment already", code="limit")
            event = self.changes.apply(command, actor)
            self.narration.tell()
            self.running.fast_forward.end()
            self.running.stop_if_tripped()
        self.refresh_status()
        return event

    def must_be_open(self) -> None:
        """Raise an error if the bench is gone."""
        if self._closed:
            raise not_found("bench", self.id)

    def reset(self, scenario: Scenario, board: Board, actor: str, before_tick: int | None = None) -> Event:
        """Begin again with a new board of the same signals; given a tick, run at once to shortly before it."""
        if not self.has_signals_of(board):
            text = "these values give the bench other signals"
            raise InputError(text, "values", "make a new bench for them", "conflict")
        before = self.moment(with_past=True)
        self._begin_again(scenario, board)
        self.narration.begin(board.spec)
        self._jumped("the bench was reset", scenario.samples)
        event = self._begun(before, actor, "reset to tick 0")
        self.running.is_started = self.is_started or before_tick is not None
        self.running.fast_forward.begin(before_tick)
        self.refresh_status()
        return event

    def become(self, other: Session, actor: str, text: str, start: bool) -> Event:
        """Go on as another bench of the same signals that nobody has, with its past and its pace."""
        assert isinstance(other.board, Board)
        before = self.moment(with_past=True)
        self._begin_again(other.scenario, other.board)
        self.history, self.track, self.running.pacer = other.history, other.track, other.pacer
        self.narration.go_to(other.narration.told())
        self._jumped(text, other.running.ends_at)
        event = self._begun(before, actor, text)
        self.running.is_started = start and self.board.trip is None
        self.refresh_status()
        return event

    def show(self, other: Session, actor: str) -> Event:
        """Show another moment of the past, a bench that nobody has."""
        if not self.is_past:
            raise InputError("it has gone on from its past", "kind", "fork the bench at a tick", "conflict")
        assert isinstance(other.board, Board)
        self._begin_again(other.scenario, other.board)
        self.history, self.track, self.origin = other.history, other.track, other.origin
        self.narration.go_to(other.narration.told())
        self._jumped("another moment is shown", other.scenario.samples)
        other.board.log = self.events
        event = self.look_back(actor)
        self.refresh_status()
        return event

    def look_back(self, actor: str) -> Event:
        """Note which moment of the past it shows; what came after it is not of its past."""
        tick = self.board.tick
        led = [event.seq for event in self.events.after(0)[1] if event.seq <= self.taken_over and event.tick <= tick]
        return self.events.add(tick, actor, "restored", f"shows tick {tick} as it was", new=max(led, default=0))

    def _begun(self, before: Moment, actor: str, text: str) -> Event:
        """Note at tick 0 that another board has begun, and take its log over."""
        event = self.note(actor, "reset", text, tick=0)
        self.events.take_over(self.board)
        self.changes.jumped(event, before)
        return event

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
        return replace(super().moment(with_past), last_event=self.events.last, told=self.narration.told())

    def go_to(self, moment: Moment) -> None:
        """Be what the bench was."""
        self._be_again(moment)
        if moment.told is not None:
            self.narration.go_to(moment.told)
        self.events.take_over(self.board)
        self._jumped("the bench was restored", self.scenario.samples)

    def close(self) -> list[Recorder]:
        """Stop for good; return the recordings that were under way."""
        self._closed = True
        self.running.stop()
        return self.recordings.close()

    def advance(self, ticks: int) -> int:
        """Run ticks, as many as a slice has; keep them, record them, note what happened; return how many there were."""
        watch = self.watch if self.hiding.blind is None else None  # what holds would tell what is hidden
        rows = self._advance_slice(ticks if watch is None else watch.room(self.board.tick, ticks))
        self.narration.look(rows)
        self._remember()
        if rows.count:
            self._metrics.ticks.inc(rows.count)
            self.recordings.take(rows)
            self.hiding.look(rows)
            if watch is not None:
                watch.look(self)
        if self.board.trip is not None and self.is_started and not self._has_due():
            self.running.is_started = False
            self.refresh_status()
        return rows.count

    def _happened(self, event: Event) -> None:
        """Count an event, tell of it, and write it into the recordings under way."""
        if not self.hiding.hear(event):
            self._metrics.events.labels(event.kind).inc()
        self.narration.hear(event)
        self.recordings.record(event)
        if self.witness is not None:
            self.witness(self, event)

    def _jumped(self, why: str, ends_at: int | None) -> None:
        """Follow a jump in time to a scenario that ends at a tick: recordings end, the clock is anchored anew."""
        self.running.jumped(ends_at)
        self.recordings.close(why)
        self._remember()
        if self.watch is not None:
            self.watch.jumped(self.board.tick)

    def done_otherwise(self) -> None:
        """Note for the past that the board has become another in a way that no command says."""
        super().done_otherwise()
        self._remember()

    def _remember(self) -> None:
        """Let the narrator remember this moment if the past has a checkpoint of it."""
        if self.track is not None and self.track.last_tick == self.board.tick:
            self.narration.remember(self.board.tick, self.track.ticks)

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
        """The words about it in a file of its trace."""
        return {"scenario": self.scenario.document, "bench": self.id}

    def describe(self, around: dict[str, Any], view3d: str | None) -> Bench:
        """Describe the bench in full."""
        return bench_of(self, around, view3d)

    def refresh_status(self) -> None:
        """Replace the status by that of now."""
        self.status = status_of(self)


Seen = Session | BlindView
"""A bench as somebody sees it."""
