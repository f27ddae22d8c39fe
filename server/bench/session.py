"""One live bench: a board, its history, its events; touched by the engine thread only.

The event loop reads what is safe to read meanwhile: the history (settled ticks), the events (locked) and
`status`, an object that is replaced whole.
"""

from __future__ import annotations

import secrets
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, get_args

import numpy as np

from core.board.board import Board, Checkpoint, Rows
from core.board.condition import Condition
from core.board.history import History
from core.device.geometry import Geometry
from core.errors import InputError
from core.signals import Signal
from scenarios.schema import Scenario
from server.bench.commands import Loop, Pause, Seek, Start, Step, StepPeriod, TimeScale
from server.bench.events import Event, EventLog
from server.bench.pacing import Pacer
from server.bench.portrait import MAX_PENDING, document_of, status_of
from server.bench.recorder import CLOSED, STOPPED, WANTED, Past, Recorder
from server.bench.status import BenchStatus, Snapshot
from server.bench.tape import Tape
from server.errors import ApiError, not_found
from server.metrics import Metrics

RunsBench = Start | Pause | Step | StepPeriod | TimeScale | Seek | Loop
RUN = get_args(RunsBench)
STATUS_S = 0.2
LEAST_LOOP = 100
FORK_TICKS = 20_000
"""Past a fork brings along."""


@dataclass(frozen=True)
class Kept:
    """A snapshot and the moment it holds."""

    snapshot: Snapshot
    checkpoint: Checkpoint


@dataclass(frozen=True)
class Armed:
    """A recording that waits for a condition."""

    recorder: Recorder
    condition: Condition
    past: int
    ticks: int | None


class Session:
    """A live bench.

    Parameters
    ----------
    scenario : Scenario
        What it was made from.
    board : Board or Tape
        Built from it; or a recording that is played.
    time_scale : float or None
        Device seconds per wall second; none: as fast as possible.
    history_ticks : int
        Ticks every signal is kept for.
    metrics : Metrics
        Where ticks and overruns are counted.
    clock : callable
        The engine's clock.
    """

    def __init__(
        self,
        scenario: Scenario,
        board: Board | Tape,
        time_scale: float | None,
        history_ticks: int,
        metrics: Metrics,
        clock: Callable[[], float],
    ) -> None:
        self.id = secrets.token_hex(6)
        self.scenario = scenario
        self.board: Board | Tape = board
        self.created = datetime.now(UTC)
        self.events = EventLog()
        self.pacer = Pacer(board.dt_ms * 1e-3, time_scale)
        self.snapshots: dict[str, Kept] = {}
        self.recorders: dict[str, Recorder] = {}
        self.armed: dict[str, Armed] = {}
        self._history_ticks, self._metrics, self._clock = history_ticks, metrics, clock
        self._running = False
        self._closed = False
        self._logged = 0
        self._ends_at = board.end if isinstance(board, Tape) else scenario.samples
        self.replay_of = ""
        self.recorded_scale: float | None = None
        self.loop: tuple[int, int] | None = None
        self._counted = (0, 0.0)
        self._status_due = 0.0
        self.history = History(len(board.signals), history_ticks)
        self._index = {signal.name: signal.index for signal in board.signals}
        self.status = self._look()

    # ---- what the engine asks

    @property
    def is_running(self) -> bool:
        """Whether time runs."""
        return self._running

    def target(self, now: float) -> int | None:
        """Return the tick to reach in this round; the end of the scenario is not passed unasked."""
        target = self.pacer.target(self.board.tick, now)
        if self._ends_at is not None:
            return self._ends_at if target is None else min(target, self._ends_at)
        return target

    def slice(self, target: int | None) -> bool:
        """Advance by one slice; true while there is more to do."""
        wanted = self.board.chunk if target is None else min(self.board.chunk, target - self.board.tick)
        if wanted > 0:
            self._advance(wanted)
        if self._ends_at is not None and self.board.tick >= self._ends_at and self._running:
            self._finish()
        return self._running and (target is None or self.board.tick < target)

    def finish_round(self, target: int | None, now: float) -> None:
        """Account for a round; renew the status now and then."""
        self.pacer.record(self.board.tick, target if self.pacer.scale is not None else None, now)
        overruns, given_up = self._counted
        if self.pacer.overruns > overruns:
            self._metrics.overruns.inc(self.pacer.overruns - overruns)
        if self.pacer.given_up_s > given_up:
            self._metrics.given_up_seconds.inc(self.pacer.given_up_s - given_up)
        self._counted = (self.pacer.overruns, self.pacer.given_up_s)
        if now >= self._status_due:
            self._status_due = now + STATUS_S
            self.status = self._look()

    def fail(self, error: Exception) -> None:
        """Pause after an error nobody expected, and say so."""
        self._running = False
        self._note("board", "failed", f"stopped by an internal error: {error}")
        self.status = self._look()

    # ---- what people do; all run as jobs of the engine

    def begin(self, start: bool) -> None:
        """Come to life, running or paused."""
        self._running = start
        self.pacer.anchor(self.board.tick, self._clock())
        self._sync_log()
        self._note("board", "opened", "running" if start else "paused at the first tick")
        self.status = self._look()

    def execute(self, command: Any, actor: str) -> Event:
        """Carry out a command at this tick edge.

        Raises
        ------
        InputError
            If it cannot be; nothing has changed then.
        """
        if self._closed:
            raise not_found("bench", self.id)
        if isinstance(command, RUN):
            event = self._run_command(command, actor)
        else:
            if len(self.board.pending) >= MAX_PENDING:
                raise InputError(f"{MAX_PENDING} commands wait for their moment already", code="limit")
            self._sync_log()
            self.board.apply(command, actor)
            if self.board.trip is not None:
                self._running = False
            event = self._sync_log()[-1]
        self.status = self._look()
        return event

    def reset(self, scenario: Scenario, board: Board, actor: str) -> Event:
        """Begin again with a new board of the same signals."""
        names = [signal.name for signal in board.signals]
        if names != list(self._index):
            raise InputError(
                "these values give the bench other signals", "values", "make a new bench for them", "conflict"
            )
        if board.dt_ms != self.board.dt_ms:
            self.pacer = Pacer(board.dt_ms * 1e-3, self.pacer.scale)
        self.scenario, self.board, self._logged = scenario, board, 0
        self._ends_at = scenario.samples
        self.history = History(len(names), self._history_ticks)
        event = self._jumped(actor, "reset", "reset to tick 0")
        self._sync_log()
        return event

    def take_snapshot(self, name: str, actor: str, most: int) -> Snapshot:
        """Keep this moment."""
        if len(self.snapshots) >= most:
            raise ApiError(409, "too_many_snapshots", f"{most} snapshots are kept, the limit (max_snapshots)")
        snapshot = Snapshot(id=secrets.token_hex(6), tick=self.board.tick, name=name, created=datetime.now(UTC))
        self.snapshots[snapshot.id] = Kept(snapshot, self.board.checkpoint())
        self._note(actor, "snapshot_taken", f"kept this moment as {name or snapshot.id}")
        return snapshot

    def restore(self, snapshot_id: str, actor: str) -> Event:
        """Go back to a moment."""
        kept = self.snapshot(snapshot_id)
        self.board = Board.restore(kept.checkpoint)
        self._logged = self.board.log.last
        if self.history.first_tick <= kept.snapshot.tick <= self.history.end_tick:
            self.history.end_tick = kept.snapshot.tick
        else:
            self.history = History(len(self._index), self._history_ticks)
        samples = self.scenario.samples
        self._ends_at = samples if samples is not None and self.board.tick < samples else None
        return self._jumped(actor, "restored", f"went back to {kept.snapshot.name or kept.snapshot.id}")

    def forget_snapshot(self, snapshot_id: str) -> None:
        """Forget a kept moment."""
        del self.snapshots[self.snapshot(snapshot_id).snapshot.id]

    def fork(self, snapshot_id: str | None) -> Session:
        """Return a second bench that goes on from this moment or a kept one."""
        checkpoint = self.snapshot(snapshot_id).checkpoint if snapshot_id else self.board.checkpoint()
        board = Board.restore(checkpoint)
        twin = Session(self.scenario, board, self.pacer.scale, self._history_ticks, self._metrics, self._clock)
        twin._logged = board.log.last
        twin._ends_at = self._ends_at if self._ends_at is not None and board.tick < self._ends_at else None
        first = max(self.history.first_tick, board.tick - FORK_TICKS)
        if first < board.tick <= self.history.end_tick:
            past = self.history.read(list(range(len(self._index))), first, board.tick).T
            outputs, taps = np.split(past, [self.board.signals.outputs], axis=1)
            twin.history.append(
                Rows(
                    first, len(past), np.ascontiguousarray(outputs, np.float64), np.ascontiguousarray(taps, np.float64)
                )
            )
        twin._note("api", "forked", f"forked from bench {self.id}")
        twin.status = twin._look()
        return twin

    def snapshot(self, snapshot_id: str) -> Kept:
        """Return a kept moment."""
        if snapshot_id not in self.snapshots:
            raise not_found("snapshot", snapshot_id)
        return self.snapshots[snapshot_id]

    def record(
        self, recorder: Recorder, name: str, actor: str, past: int, ticks: int | None, condition: Condition | None
    ) -> int | None:
        """Begin a recording here with some of the past, or arm it; returns its first tick once that is known.

        Parameters
        ----------
        past : int
            Ticks before the beginning that it takes along, as far as the history has them.
        ticks : int or None
            Ticks behind the beginning after which it ends by itself.
        condition : Condition or None
            What it waits for.
        """
        if self._closed:
            raise not_found("bench", self.id)
        if condition is not None:
            self.armed[recorder.id] = Armed(recorder, condition, past, ticks)
            self._note(actor, "recording_armed", f"recording {name} waits for its condition")
            self.status = self._look()
            return None
        self._note(actor, "recording_started", f"recording {name} began")
        return self._begin_recording(recorder, self.board.tick, past, ticks)

    def _begin_recording(self, recorder: Recorder, at: int, past: int, ticks: int | None) -> int:
        """Let a recording begin at a tick that has been or is now."""
        history, columns = self.history, list(range(len(self._index)))
        end = self.board.tick
        first = min(max(at - past, history.first_tick), end) if history.end_tick == end else end
        after = None if ticks is None else max(0, ticks - (end - at))
        recorder.begin(Past(lambda start, stop: history.read(columns, start, stop), first, end), after)
        self.recorders[recorder.id] = recorder
        if not recorder.is_open:
            self.stop_recording(recorder.id)
        self.status = self._look()
        return first

    def stop_recording(self, recording_id: str, reason: str = STOPPED) -> Recorder:
        """End a recording here, or one that waits."""
        waiting = self.armed.pop(recording_id, None)
        recorder = waiting.recorder if waiting is not None else self.recorders.get(recording_id)
        if recorder is None:
            raise not_found("recording under way", recording_id)
        recorder.stop(reason)
        if recorder.reason in WANTED:
            self._note("board", "recording_stopped", f"a recording ended: {recorder.reason}")
        else:
            self._note("board", "recording_failed", f"a recording broke off: {recorder.reason}")
        self.recorders.pop(recording_id, None)
        self.status = self._look()
        return recorder

    def forget_recording(self, recording_id: str) -> None:
        """Let go of a recording that has ended by itself."""
        if recording_id in self.recorders or recording_id in self.armed:
            self.stop_recording(recording_id)

    def close(self) -> list[Recorder]:
        """Stop for good; returns the recordings that were under way."""
        self._running, self._closed = False, True
        return [self.stop_recording(key, CLOSED) for key in [*self.recorders, *self.armed]]

    # ---- what the event loop reads

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
    def geometry(self) -> Geometry | None:
        """The drawing of the device, if it has one."""
        return self.board.spec.device.geometry

    @property
    def drive_period_ticks(self) -> float | None:
        """Period of the reference in ticks, if it has one."""
        frequency = getattr(self.board.spec.reference.params, "frequency_hz", None)
        return 1e3 / (float(frequency) * self.dt_ms) if isinstance(frequency, int | float) and frequency else None

    @property
    def column_of(self) -> dict[str, int]:
        """Column of each signal by name."""
        return self._index

    def indices(self, names: Sequence[str]) -> list[int]:
        """Return the columns of signals; an unknown name is an `InputError` with suggestions."""
        return [self.board.signals.index(name) for name in names]

    def document(self) -> dict[str, Any]:
        """Return what happened as a scenario; run headless it gives the same bits (a job)."""
        return document_of(self)

    # ---- inside

    def _run_command(self, command: RunsBench, actor: str) -> Event:
        """Carry out a command that runs the bench."""
        document = command.model_dump()
        if isinstance(command, Seek | Loop):
            return self._play(command, actor)
        if isinstance(command, TimeScale):
            old = self.pacer.scale
            self.pacer.rescale(command.value, self.board.tick, self._clock(), self._running)
            text = "time runs as fast as possible"
            if command.value is not None:
                text = f"time scale set to {command.value * 1e3:g} ms/s"
            return self._note(actor, "time_scale", text, document, old, command.value)
        if isinstance(command, Pause):
            self._running = False
            return self._note(actor, "pause", "paused", document)
        if self.board.trip is not None:
            raise InputError(
                f"the board has tripped: {self.board.trip.reason}",
                hint="reset the trip first",
                code="tripped",
            )
        if isinstance(command, Start):
            if isinstance(self.board, Tape) and self.board.tick >= self.board.end:
                self.board.seek(self.board.first)
                self._rewound()
            self._running = True
            self.pacer.anchor(self.board.tick, self._clock())
            return self._note(actor, "start", "started", document)
        self._running = False
        ticks = command.ticks if isinstance(command, Step) else self._period()
        goal = self.board.tick + ticks
        event = self._note(actor, command.kind, f"stepped {ticks} tick{'s' if ticks > 1 else ''}", document)
        while self.board.tick < goal and self.board.trip is None:
            if not self._advance(min(self.board.chunk, goal - self.board.tick)):
                break
        return event

    def _play(self, command: Seek | Loop, actor: str) -> Event:
        """Carry out a command to a bench that plays a recording."""
        tape = self.board
        if not isinstance(tape, Tape):
            raise InputError("only a recording that is played can do that", "kind", code="conflict")
        if isinstance(command, Seek):
            tape.seek(command.tick)
            self._rewound()
            return self._note(actor, "seek", f"went to tick {command.tick}", command.model_dump())
        if command.start_tick is None and command.end_tick is None:
            self.loop, self._ends_at = None, tape.end
            return self._note(actor, "loop", "plays to the end", command.model_dump())
        start = tape.first if command.start_tick is None else command.start_tick
        end = tape.end if command.end_tick is None else command.end_tick
        if not tape.first <= start < end <= tape.end or end - start < LEAST_LOOP:
            text = f"must lie in {tape.first} to {tape.end} and have at least {LEAST_LOOP} ticks"
            raise InputError(text, "end_tick")
        self.loop, self._ends_at = (start, end), end
        if not start <= tape.tick < end:
            tape.seek(start)
            self._rewound()
        return self._note(actor, "loop", f"plays ticks {start} to {end} again and again", command.model_dump())

    def _rewound(self) -> None:
        """Let history and clock follow a jump of the tick."""
        tick = self.board.tick
        if self.history.first_tick <= tick <= self.history.end_tick:
            self.history.end_tick = tick
        else:
            self.history = History(len(self._index), self._history_ticks)
        if self._ends_at is None and isinstance(self.board, Tape):
            self._ends_at = self.board.end
        self.pacer.anchor(tick, self._clock())

    def _period(self) -> int:
        """Return the drive period as a number of ticks one may step."""
        period = self.drive_period_ticks
        if period is None:
            raise InputError("the reference has no period", "kind", "step a number of ticks", "conflict")
        return max(1, min(100_000, round(period)))

    def _advance(self, ticks: int) -> int:
        """Run ticks; keep them, record them, note what happened; return how many there were."""
        rows = self.board.advance(ticks)
        if rows.count:
            self.history.append(rows)
            self._metrics.ticks.inc(rows.count)
            if self.recorders:
                self._record(rows)
            if self.armed:
                self._watch(rows)
        if self.board.log.last > self._logged:
            self._sync_log()
        if self.board.trip is not None and self._running and not self._has_due():
            self._running = False
            self.status = self._look()
        return rows.count

    def _has_due(self) -> bool:
        """Whether a command of the scenario is due at this very tick, such as the reset of a trip."""
        return any(entry.tick is not None and entry.tick <= self.board.tick for entry in self.board.pending)

    def _record(self, rows: Rows) -> None:
        """Hand copies to the recordings; one that has ended by itself is let go."""
        samples = np.hstack((rows.outputs, rows.taps)).astype(np.float32).T
        for key, recorder in list(self.recorders.items()):
            recorder.append(rows.first_tick, samples)
            if not recorder.is_open:
                self.stop_recording(key)

    def _watch(self, rows: Rows) -> None:
        """Begin the armed recordings whose condition holds at some tick of these."""
        for key, waiting in list(self.armed.items()):
            column = self._index[waiting.condition.signal]
            values = np.hstack((rows.outputs, rows.taps))[:, column]
            found = np.flatnonzero(waiting.condition.sign * (values - waiting.condition.threshold) > 0.0)
            if found.size:
                del self.armed[key]
                at = rows.first_tick + int(found[0])
                self._note("board", "recording_started", f"a recording began: its condition held at tick {at}")
                self._begin_recording(waiting.recorder, at, waiting.past, waiting.ticks)

    def _finish(self) -> None:
        """Pause at the end of the scenario; starting again goes beyond it. A loop begins anew."""
        if self.loop is not None and isinstance(self.board, Tape):
            self.board.seek(self.loop[0])
            self._rewound()
            return
        self._running, self._ends_at = False, None
        self._note("scenario", "finished", "scenario finished; start again to go on")
        self.status = self._look()

    def _jumped(self, actor: str, kind: str, text: str) -> Event:
        """Note that time has jumped: recordings end, the clock is anchored anew."""
        for key in [*self.recorders, *self.armed]:
            self.stop_recording(key, f"the bench was {kind}")
        if self.board.trip is not None:
            self._running = False
        self.pacer.anchor(self.board.tick, self._clock())
        event = self._note(actor, kind, text)
        self.status = self._look()
        return event

    def _note(
        self,
        actor: str,
        kind: str,
        text: str,
        command: dict[str, Any] | None = None,
        old: Any = None,
        new: Any = None,
    ) -> Event:
        """Add an event of the bench itself."""
        self._metrics.events.labels(kind).inc()
        return self._tell(self.events.add(self.board.tick, actor, kind, text, command, old, new))

    def _tell(self, event: Event) -> Event:
        """Let the recordings under way have an event."""
        for recorder in self.recorders.values():
            recorder.note(event.model_dump_json())
        return event

    def _sync_log(self) -> list[Event]:
        """Take over what the board has logged since the last time."""
        added = []
        for entry in self.board.log.after(self._logged):
            self._metrics.events.labels(entry.kind).inc()
            event = self.events.add(
                entry.tick, entry.actor, entry.kind, entry.text, entry.command, entry.old, entry.new
            )
            added.append(self._tell(event))
        self._logged = self.board.log.last
        return added

    def _look(self) -> BenchStatus:
        """Look at the board: an object nobody changes afterwards."""
        return status_of(self)
