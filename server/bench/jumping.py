"""Jumps of a bench in time: to its start, to another bench's moment, to a snapshot, to a past moment."""

from __future__ import annotations

from dataclasses import replace

from core.board.board import Board
from core.board.document import Document
from core.errors import InputError
from scenarios.schema import Scenario
from server.bench.changes import Changes
from server.bench.events import Event, EventLog
from server.bench.moment import Moment
from server.bench.narration import Narration
from server.bench.recordings import Recordings
from server.bench.running import Running
from server.bench.snapshots import Snapshots
from server.bench.timeline import Timeline
from server.bench.watch import Watch


class Jumping(Timeline):
    """A bench that jumps in time; its parts, such as its log and its narrator, follow each jump."""

    taken_over = 0
    """Number of the last event that is of the bench whose past it shows."""
    watch: Watch | None = None
    """Looks at the bench for a step of a lab sheet."""
    running: Running
    changes: Changes
    snapshots: Snapshots
    recordings: Recordings
    narration: Narration
    events: EventLog

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
        self.running.is_started = self.running.is_started or before_tick is not None
        self.running.fast_forward.begin(before_tick)
        self.refresh_status()
        return event

    def become(self, other: Jumping, actor: str, text: str, start: bool) -> Event:
        """Continue as another, unpublished bench of the same signals, with its past and its pace."""
        assert isinstance(other.board, Board)
        before = self.moment(with_past=True)
        self._begin_again(other.scenario, other.board)
        self.history, self.track, self.running.pacer = other.history, other.track, other.running.pacer
        self.narration.go_to(other.narration.told())
        self._jumped(text, other.running.ends_at)
        event = self._begun(before, actor, text)
        self.running.is_started = start and self.board.trip is None
        self.refresh_status()
        return event

    def show(self, other: Jumping, actor: str) -> Event:
        """Show another moment of the past from an unpublished bench."""
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

    def look_back(self, actor: str, *, is_before: bool = False) -> Event:
        """Note the visible past moment, or the moment before its commands; later events do not belong to it."""
        tick = self.board.tick
        end = tick if is_before else tick + 1
        led = [event.seq for event in self.events.after(0)[1] if event.seq <= self.taken_over and event.tick < end]
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

    def go_to(self, moment: Moment) -> None:
        """Restore the state of the bench."""
        self._be_again(moment)
        if moment.told is not None:
            self.narration.go_to(moment.told)
        self.events.take_over(self.board)
        self._jumped("the bench was restored", self.scenario.samples)

    def moment(self, with_past: bool = False) -> Moment:
        """Return the present state of the bench, for a jump that empties the history with the past before it."""
        return replace(super().moment(with_past), last_event=self.events.last, told=self.narration.told())

    def _jumped(self, why: str, ends_at: int | None) -> None:
        """Follow a jump in time to a scenario that ends at a tick: recordings end, the clock is anchored anew."""
        self.running.jumped(ends_at)
        self.recordings.close(why)
        self._remember()
        if self.watch is not None:
            self.watch.jumped(self.board.tick)

    def done_otherwise(self) -> None:
        """Note for the past that the board has changed without a command."""
        super().done_otherwise()
        self._remember()

    def _remember(self) -> None:
        """Let the narrator remember this moment if the past has a checkpoint of it."""
        if self.track is not None and self.track.last_tick == self.board.tick:
            self.narration.remember(self.board.tick, self.track.ticks)

    def note(self, actor: str, kind: str, text: str, command: Document | None = None, tick: int | None = None) -> Event:
        """Add an event of the bench itself, of now unless a tick is given."""
        return self.events.add(self.board.tick if tick is None else tick, actor, kind, text, command)

    def refresh_status(self) -> None:
        """Replace the status by the present status."""
        raise NotImplementedError
