"""One live bench: a board, its journal, the history of its signals, its events. Only the engine thread changes it.

The event loop reads three parts at any time: the history (settled ticks), the events (locked) and `status`, an object
that is replaced whole.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any, NamedTuple, get_args

from core.board.board import Board
from core.board.document import Document
from core.board.history import History
from core.board.kept import Ticks
from core.board.track import Deed, Track
from core.signals import Signal
from scenarios.schema import Scenario
from server.bench import commands
from server.bench.captures import Captures
from server.bench.description import bench_of, document_now, status_of
from server.bench.events import Event, EventLog
from server.bench.journal import Branches, Journal, Snapshots
from server.bench.measuring import Measuring
from server.bench.narration import Narration
from server.bench.recorder import Recorder
from server.bench.recording import ActiveRecordings
from server.bench.status import Bench, Opened, Origin, Travel
from server.bench.time import DeviceTime
from server.bench.undo import Changes
from server.bench.view import View, Watch
from server.errors import not_found
from server.metrics import Metrics

if TYPE_CHECKING:
    from server.bench.replay import TickSource

SLICE_S = 0.005
"""Longest slice, by the time of a tick; other benches and commands wait for it."""
MOST_SLOWER = 4.0
"""Most by which the estimated time of a tick grows at once: a longer tick has waited for a processor."""


class BenchMemory(NamedTuple):
    """Memory of a bench; the bytes are subtracted from the memory of its history."""

    past_ticks: int
    """Samples before its end that a journal of the bench has."""
    track_bytes: int
    """Keyframes from which the past is computed again."""
    capture_bytes: int
    """Captures of users who see all of the bench, and the same again for users who have a view of it."""


USUAL = BenchMemory(20_000, 8_000_000, 2_500_000)
OF_STUDENT = BenchMemory(2000, 1_500_000, 500_000)


class LiveBench:
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
    memory : Memory
        Memory in addition to the history.
    """

    id = ""
    """Given when it is registered."""
    name = ""
    """Name given by users, in addition to the title of its scenario."""
    replay_of = ""
    """The recording it plays, if it does."""
    recorded_scale: float | None = None
    """Device seconds per wall second of the recording."""
    origin: Origin | None = None
    """The moment of another bench from which it continues."""
    taken_over = 0
    """Number of the last event that is of the bench whose past it shows."""
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
    witness: Callable[[LiveBench, Event], None] | None = None
    """Called with every event."""
    view: View | None = None
    """The part of it that people see for now, if rules hide the rest."""
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
        memory: BenchMemory = USUAL,
    ) -> None:
        self.scenario, self.board, self.memory = scenario, board, memory
        self._history_ticks, self._metrics, self.clock = history_ticks, metrics, clock
        self.created = datetime.now(UTC)
        self._tick_s = SLICE_S / board.chunk
        self.history = self.empty_history()
        self.branches = Branches()
        self.column_of = {signal.name: signal.index for signal in board.signals}
        """Column of each signal in the history."""
        self.track = Track(board, memory.track_bytes) if isinstance(board, Board) else None
        self.captures = Captures(self, memory.capture_bytes)
        self.time: DeviceTime = DeviceTime(self, time_scale, scenario.samples, metrics)
        self.changes, self.snapshots = Changes(self), Snapshots(self)
        self.recordings, self.measuring = ActiveRecordings(self), Measuring()
        self.narration = Narration(board.spec, board.signals)
        self._remember()
        self.events = EventLog(self._happened)
        self._closed = False
        self.refresh_status()

    @property
    def dt_ms(self) -> float:
        """Device time of one tick."""
        return self.board.dt_ms

    @property
    def signals(self) -> Sequence[Signal]:
        """All signals, in the order of the history."""
        signals: Sequence[Signal] = self.board.signals
        return signals

    @property
    def is_running(self) -> bool:
        """Whether time runs, until a pause or to the end of a step."""
        return self.time.is_running

    @property
    def is_started(self) -> bool:
        """Whether time runs until it is paused."""
        return self.time.is_started

    @property
    def is_past(self) -> bool:
        """Whether it shows the moment it was forked at still: nothing was done, and no time has run."""
        origin, track = self.origin, self.track
        if origin is None or track is None:
            return False
        return self.board.tick == origin.tick and not track.has_deeds_since(origin.tick)

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
        """Description in a file of its trace."""
        return {"scenario": self.scenario.document, "bench": self.id}

    def describe(self, around: dict[str, Any], view3d: str | None) -> Bench:
        """Describe the bench in full."""
        return bench_of(self, around, view3d)

    def refresh_status(self) -> None:
        """Replace the status by the present status."""
        self.status = status_of(self)

    def indices(self, names: Sequence[str]) -> list[int]:
        """Return the columns of signals; an unknown name is an `InputError` with suggestions."""
        return [self.board.signals.index(name) for name in names]

    def has_signals_of(self, board: TickSource) -> bool:
        """Whether a board has the signals of this one, and could take its place."""
        return [signal.name for signal in board.signals] == list(self.column_of)

    def begin(self, start: bool) -> None:
        """Begin, running or paused."""
        self.time.begin(start)
        self.events.take_over(self.board)
        self.note("board", "opened", "running" if start else f"paused at tick {self.board.tick}")
        self.time.fast_forward.begin()
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
            event = self.time.carry_out(command, actor)
            if isinstance(event, Future):  # its end refreshes the status
                return event
        else:
            event = self.changes.carry_out(command, actor)
        self.refresh_status()
        return event

    def advance(self, ticks: int) -> int:
        """Run ticks, at most one slice; keep them, record them, note the events; return their number."""
        view = self.view
        watch = self.watch if view is None else None  # a condition would reveal hidden values
        ran = self._advance(ticks if watch is None else watch.room(self.board.tick, ticks))
        self.narration.look(ran)
        self._remember()
        if ran.count:
            self._metrics.ticks.inc(ran.count)
            self.recordings.take(ran)
            if view is not None:
                view.narration.look(ran)
            if watch is not None:
                watch.look(self)
        if self.board.trip is not None and self.is_started and not self._has_due():
            self.time.is_started = False
            self.refresh_status()
        return ran.count

    def _advance(self, ticks: int) -> Ticks:
        """Run ticks, as many as a slice has, and keep them in the history."""
        began = self.clock()
        ran = self._run(min(ticks, max(1, int(SLICE_S / self._tick_s))))
        if ran.count:
            took = max(self.clock() - began, 1e-9)
            self._tick_s = min(took / ran.count, MOST_SLOWER * self._tick_s)
            if self.track is not None and isinstance(self.board, Board):
                self.track.follow(self.board)
        return ran

    def _run(self, ticks: int) -> Ticks:
        """Run ticks into the history; a recording that waits for a condition needs rows, which are not rounded."""
        board = self.board
        if isinstance(board, Board) and board.keeps and not self.recordings.armed:
            return board.advance_into(self.history, ticks)
        rows = board.advance(ticks)
        if rows.count:
            self.history.append(rows)
        return rows

    def journal(self, *, with_past: bool = False, is_lean: bool = False) -> Journal:
        """Return the journal of the bench up to now.

        Parameters
        ----------
        with_past : bool
            With the samples before its end.
        is_lean : bool
            With the fewest keyframes, for a journal that is kept.
        """
        keyframe = self.board.checkpoint()
        assert self.track is not None
        track = self.track.lean() if is_lean else self.track.copy()
        past = self.history_before(self.board.tick) if with_past else None
        branch, last_event = self.branches.current, self.events.last
        return Journal(self.scenario, keyframe, track, self.narration.told(), past, branch, last_event)

    def recalled(self, journal: Journal) -> Journal:
        """Return a journal with all keyframes and samples that the bench still has, if it is in its present past."""
        if self.track is None or not self.branches.share(journal.branch, journal.tick):
            return journal
        return replace(journal, track=self.track.copy(), past=self.history_before(journal.tick))

    def stand(self, journal: Journal, actor: str, kind: str, text: str, board: Board | None = None) -> Event:
        """Stand at the end of a journal: the only way of a bench to a tick that does not follow; return its event.

        The board is restored from the journal, unless there is one at its end that nothing else advances.
        """
        board, tick = board or journal.board(), journal.tick
        is_own = self.branches.share(journal.branch, tick)
        self.scenario, self.board = journal.scenario, board
        self.track = (self.track if is_own and self.track is not None else journal.track).until(board)
        if not (is_own and self.rewind()):
            self.begin_history(journal.past)
        self.branches.begin(journal.branch, tick)
        self.narration.go_to(journal.told, board.spec)
        self.time.jumped(journal.scenario.samples)
        self.recordings.close(f"the bench was {'reset' if kind == 'reset' else 'restored'}")
        self._remember()
        if self.watch is not None:
            self.watch.jumped(tick)
        event = self.events.add(0 if kind == "reset" else tick, actor, kind, text, new=journal.last_event)
        self.events.take_over(board)
        self.refresh_status()
        return event

    def history_before(self, tick: int) -> History | None:
        """Return copies of the last samples before a tick, as far as the history has them."""
        first = max(self.history.first_tick, tick - self.memory.past_ticks)
        if not first < tick <= self.history.end_tick:
            return None
        past = self.empty_history(self.memory.past_ticks)
        past.adopt(self.history, first, tick)
        return past

    def rewind(self) -> bool:
        """End the history at the tick of the board; false if the history does not have this tick."""
        if not self.history.first_tick <= self.board.tick <= self.history.end_tick:
            return False
        self.history.end_tick = self.board.tick
        return True

    def begin_history(self, past: History | None = None) -> None:
        """Begin the history again, with samples of the past if there are any."""
        if past is not None and past.capacity == self.history.capacity:
            self.history = past
        else:
            self.history = self.empty_history()
            if past is not None:
                self.history.adopt(past, past.first_tick, past.end_tick)

    def empty_history(self, ticks: int | None = None) -> History:
        """Return a history with nothing in it."""
        signals = self.board.signals
        return History(signals.outputs, len(signals.taps), self._history_ticks if ticks is None else ticks)

    def done(self, deed: Deed) -> None:
        """Add an action on the board to the journal."""
        if self.track is not None:
            self.track.note(deed)

    def done_otherwise(self) -> None:
        """Add a keyframe to the journal, because the board has changed without a command."""
        if self.track is not None and isinstance(self.board, Board):
            self.track.mark(self.board, is_fixed=True)
        self._remember()

    def _remember(self) -> None:
        """Let the narrator remember this moment if the journal has a keyframe of it."""
        if self.track is not None and self.track.last_tick == self.board.tick:
            self.narration.remember(self.board.tick, self.track.ticks)

    def _has_due(self) -> bool:
        """Whether a command of the scenario is due at this very tick, such as the reset of a trip."""
        due = self.board.pending.next_tick
        return due is not None and due <= self.board.tick

    def note(self, actor: str, kind: str, text: str, command: Document | None = None, tick: int | None = None) -> Event:
        """Add an event of the bench itself, of now unless a tick is given."""
        return self.events.add(self.board.tick if tick is None else tick, actor, kind, text, command)

    def _happened(self, event: Event) -> None:
        """Count an event, report it, and write it into the active recordings."""
        if (view := self.view) is not None:
            view.hear(event)
        else:
            self._metrics.events.labels(event.kind).inc()
        self.narration.hear(event)
        self.recordings.record(event)
        if self.witness is not None:
            self.witness(self, event)

    def fail(self, error: Exception) -> None:
        """Pause after an unexpected error, and note it."""
        self.time.stop()
        self.note("board", "failed", f"stopped by an internal error: {error}")
        self.refresh_status()

    def must_be_open(self) -> None:
        """Raise an error if the bench is gone."""
        if self._closed:
            raise not_found("bench", self.id)

    def close(self) -> list[Recorder]:
        """Stop for good; return the recordings that were under way."""
        self._closed = True
        self.time.stop()
        return self.recordings.close()


Seen = LiveBench | View
"""A bench as a user sees it."""
