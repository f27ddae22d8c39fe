"""One live bench: a board, its history, its events. Only the engine thread changes it.

The event loop reads three parts at any time: the history (settled ticks), the events (locked) and `status`, an object
that is replaced whole.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
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
from server.bench.jumping import Jumping
from server.bench.measuring import Measuring
from server.bench.narration import Narration
from server.bench.pacing import Pacer
from server.bench.portrait import bench_of, document_now, status_of
from server.bench.recorder import Recorder
from server.bench.recordings import Recordings
from server.bench.running import Running
from server.bench.snapshots import Snapshots
from server.bench.status import Bench, Opened, Travel
from server.bench.tick_source import TickSource
from server.errors import not_found
from server.metrics import Metrics

STUDENT_PAST_TICKS = 2000
"""Ticks of the past that a jump on the bench of a student brings along."""
STUDENT_TRACK_BYTES = 1_500_000
"""Memory of the checkpoints of a student's bench."""
STUDENT_CAPTURE_BYTES = 500_000
"""Memory of the captures of a student's bench, and as much while a fault is hidden on it."""


class Session(Jumping):
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

    name = ""
    """Name given by users, in addition to the title of its scenario."""
    replay_of = ""
    """The recording it plays, if it does."""
    recorded_scale: float | None = None
    """Device seconds per wall second of the recording."""
    sought: object = None
    """The moment of the past that was requested last."""
    travel: Travel | None = None
    """The moment of its past that is being computed, if one is."""
    opened: Opened | None = None
    """The experiment it was opened from, if it was."""
    keep = False
    """Never unload."""
    class_id = ""
    """The class whose student has it."""
    witness: Callable[[Session, Event], None] | None = None
    """Called with every event."""

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
        self.recordings, self.hiding, self.measuring = Recordings(self), Hiding(self), Measuring()
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
    def is_hurried(self) -> bool:
        """Whether it advances to a tick as fast as possible, so that no time needs to pass."""
        return self.running.is_hurried

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
        """Apply the limits of a student's bench: never unloaded, limited in pace, with less history."""
        self.class_id, self.keep = class_id, True
        self.past_ticks, self.track_bytes = STUDENT_PAST_TICKS, STUDENT_TRACK_BYTES
        self.captures.most_bytes = STUDENT_CAPTURE_BYTES
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

    def close(self) -> list[Recorder]:
        """Stop for good; return the recordings that were under way."""
        self._closed = True
        self.running.stop()
        return self.recordings.close()

    def advance(self, ticks: int) -> int:
        """Run ticks, at most one slice; keep them, record them, note the events; return their number."""
        watch = self.watch if self.hiding.blind is None else None  # a condition would reveal hidden values
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
        """Count an event, report it, and write it into the active recordings."""
        if not self.hiding.hear(event):
            self._metrics.events.labels(event.kind).inc()
        self.narration.hear(event)
        self.recordings.record(event)
        if self.witness is not None:
            self.witness(self, event)

    @property
    def document(self) -> Document:
        """The document of the bench as it is now."""
        return document_now(self)

    @property
    def scenario_id(self) -> str:
        """Id of its scenario, for the names of files."""
        return self.scenario.id

    @property
    def about(self) -> Document:
        """The words about it in a file of its trace."""
        return {"scenario": self.scenario.document, "bench": self.id}

    def describe(self, around: dict[str, Any], view3d: str | None) -> Bench:
        """Describe the bench in full."""
        return bench_of(self, around, view3d)

    def refresh_status(self) -> None:
        """Replace the status by the present status."""
        self.status = status_of(self)


Seen = Session | BlindView
"""A bench as a user sees it."""
