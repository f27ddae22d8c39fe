"""The recordings of live benches: active recordings, recordings that wait for a condition, and their files."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Self

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

from core.board.condition import Condition, parse_condition
from core.board.kept import Ticks
from core.board.rows import Rows
from scenarios.report.traces import schema_of
from server.bench.description import document_of
from server.bench.engine import Engine
from server.bench.events import Event
from server.bench.recorder import CLOSED, STOPPED, WANTED, PastSpan, Recorder
from server.errors import ApiError, not_found
from server.progress import WorkProgress
from server.store.recordings import About, Recording, Recordings
from server.version import VERSION

if TYPE_CHECKING:
    from server.bench.bench import LiveBench


def _concerning(events: Sequence[Event], first: int) -> list[Event]:
    """Return the injections that still act at a tick, then the events from that tick on."""
    acting: dict[str, Event] = {}
    since: list[Event] = []
    for event in _of_this_run(events):
        command = event.command or {}
        if event.tick >= first:
            since.append(event)
        elif event.kind == "inject":
            acting[command["fault"]] = event
        elif event.kind == "heal":
            healed = command["heal"]
            acting = {fault: done for fault, done in acting.items() if healed != "all" and fault not in healed}
    return [*acting.values(), *since]


def _of_this_run(events: Sequence[Event]) -> list[Event]:
    """Return the events since the last reset; of the events before a return to a moment, only those of its past."""
    jumps = [at for at, event in enumerate(events) if event.kind in ("reset", "restored")]
    if not jumps:
        return list(events)
    before, since = events[: jumps[-1]], list(events[jumps[-1] :])
    if since[0].kind == "reset":
        return since
    return _of_this_run([event for event in before if event.seq <= since[0].new]) + since


@dataclass(frozen=True)
class Armed:
    """A recording that waits for a condition."""

    recorder: Recorder
    condition: Condition
    past: int
    ticks: int | None


MOST_LAYOUT = 200_000
"""Most characters of a layout as JSON; the page writes far fewer."""


def _fits(layout: dict[str, Any] | None) -> dict[str, Any] | None:
    """Refuse a layout that is too large."""
    if (size := len(json.dumps(layout))) > MOST_LAYOUT:
        raise ValueError(f"has {size} characters as JSON, at most {MOST_LAYOUT}")
    return layout


Layout = Annotated[dict[str, Any] | None, AfterValidator(_fits)]
"""A layout as the page writes it."""


class Wanted(BaseModel):
    """A recording to make: from now or from a condition on, with some of the past."""

    model_config = ConfigDict(extra="forbid", strict=True)

    name: str = Field("recording", min_length=1, max_length=100)
    past_ticks: int = Field(0, ge=0, le=5_000_000, description="Ticks of the past it takes along, as far as kept")
    ticks: int | None = Field(None, ge=0, description="Ends by itself so many ticks after its beginning")
    when: str | None = Field(None, max_length=200, description="Waits for '<signal> > <value>'")
    layout: Layout = Field(None, description="Layout of the page, kept with it")

    @model_validator(mode="after")
    def _has_something(self) -> Self:
        if self.ticks == 0 and self.past_ticks == 0:
            raise ValueError("needs past_ticks or ticks above 0")
        return self


class ActiveRecordings:
    """Begins recordings, passes them the rows of their bench and forgets ended recordings; on the engine thread.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    """

    def __init__(self, bench: LiveBench) -> None:
        self._bench = bench
        self.under_way: dict[str, Recorder] = {}
        self.armed: dict[str, Armed] = {}

    def __len__(self) -> int:
        return len(self.under_way) + len(self.armed)

    def begin(
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
            The condition it waits for.
        """
        bench = self._bench
        if ticks != 0:  # the past of a bench that is gone can be kept still
            bench.must_be_open()
        if condition is not None:
            self.armed[recorder.id] = Armed(recorder, condition, past, ticks)
            bench.note(actor, "recording_armed", f"recording {name} waits for its condition")
            bench.refresh_status()
            return None
        bench.note(actor, "recording_started", f"recording {name} began")
        return self._begin(recorder, bench.board.tick, past, ticks)

    def stop(self, recording_id: str, reason: str = STOPPED) -> Recorder:
        """End a recording here, or a waiting recording."""
        waiting = self.armed.pop(recording_id, None)
        recorder = waiting.recorder if waiting is not None else self.under_way.get(recording_id)
        if recorder is None:
            raise not_found("recording under way", recording_id)
        recorder.stop(reason)
        if recorder.reason in WANTED:
            self._bench.note("board", "recording_stopped", f"a recording ended: {recorder.reason}")
        else:
            self._bench.note("board", "recording_failed", f"a recording broke off: {recorder.reason}")
        self.under_way.pop(recording_id, None)
        self._bench.refresh_status()
        return recorder

    def forget(self, recording_id: str) -> None:
        """Forget a recording that has ended by itself."""
        if recording_id in self.under_way or recording_id in self.armed:
            self.stop(recording_id)

    def close(self, reason: str = CLOSED) -> list[Recorder]:
        """End all; returns them."""
        return [self.stop(key, reason) for key in [*self.under_way, *self.armed]]

    def record(self, event: Event) -> None:
        """Write an event into the recordings under way."""
        for recorder in self.under_way.values():
            recorder.note(event.tick, event.model_dump_json())

    def take(self, ticks: Ticks) -> None:
        """Record some ticks, and begin the recordings whose condition they meet, for which they need rows."""
        if self.under_way:
            self._record(ticks)
        if isinstance(ticks, Rows):
            self._watch(ticks)

    def _begin(self, recorder: Recorder, at: int, past: int, ticks: int | None) -> int:
        """Begin a recording at a tick of the past or at this one."""
        bench = self._bench
        history, columns = bench.history, list(range(len(bench.signals)))
        end = bench.board.tick
        first = min(max(at - past, history.first_tick), end) if history.end_tick == end else end
        after = None if ticks is None else max(0, ticks - (end - at))
        for event in _concerning(bench.events.after(0)[1], first):
            recorder.note(event.tick, event.model_dump_json())
        recorder.begin(PastSpan(lambda start, stop: history.read(columns, start, stop), first, end), after)
        self.under_way[recorder.id] = recorder
        if not recorder.is_open:
            self.stop(recorder.id)
        bench.refresh_status()
        return first

    def _record(self, ticks: Ticks) -> None:
        """Pass ticks to the recordings, and forget recordings that have ended by themselves."""
        samples = ticks.singles(np.arange(len(self._bench.signals)), 0, ticks.count)
        for key, recorder in list(self.under_way.items()):
            recorder.append(ticks.first_tick, samples)
            if not recorder.is_open:
                self.stop(key)

    def _watch(self, rows: Rows) -> None:
        """Begin the armed recordings whose condition holds at some tick of these."""
        for key, waiting in list(self.armed.items()):
            column = self._bench.column_of[waiting.condition.signal]
            values = np.hstack((rows.outputs, rows.taps))[:, column]
            holding = np.flatnonzero(waiting.condition.sign * (values - waiting.condition.threshold) > 0.0)
            if holding.size:
                del self.armed[key]
                at = rows.first_tick + int(holding[0])
                text = f"a recording began: its condition held at tick {at}"
                self._bench.note("board", "recording_started", text)
                self._begin(waiting.recorder, at, waiting.past, waiting.ticks)


class RecordingControl:
    """Begins and ends the recordings of benches.

    Parameters
    ----------
    engine : Engine
        Advances the benches.
    store : Recordings
        Keeps the recordings.
    most_ticks : int
        Length of the longest recording.
    """

    def __init__(self, engine: Engine, store: Recordings, most_ticks: int) -> None:
        self._engine, self._store, self._most_ticks = engine, store, most_ticks
        self._open: dict[str, Recorder] = {}

    async def begin(self, session: LiveBench, wanted: Wanted, actor: str, room_bytes: int) -> Recording:
        """Begin to record every signal of a bench, now or when a condition holds.

        Parameters
        ----------
        session : LiveBench
            The bench.
        wanted : Wanted
            The recording to make.
        actor : str
            The person or program that asks.
        room_bytes : int
            How large the recording may become.
        """
        if len(session.recordings) >= 2:
            raise ApiError(409, "conflict", "two recordings of this bench are under way already")
        condition = parse_condition(wanted.when, session.column_of) if wanted.when is not None else None
        document = await self._engine.call(document_of, session)
        file_says = {
            "version": VERSION,
            "scenario": document,
            "bench": session.id,
            "time_scale": session.time.pacer.scale,
        }
        schema = schema_of({signal.name: signal.unit for signal in session.signals}, file_says, "float32")
        title = session.scenario.head.title or session.scenario.id
        about = About(
            session.id,
            wanted.name,
            title,
            session.dt_ms,
            document,
            session.board.spec.seed,
            wanted.layout,
            wanted.when or "",
        )
        recording, file = await self._store.open(about, schema)
        row_bytes = 16 + 4 * len(session.signals)
        close = self._store.closer(recording.id)

        def ended(first: int, ticks: int, reason: str) -> None:
            close(first, ticks, reason, reason not in WANTED)
            self._open.pop(recording.id, None)
            with contextlib.suppress(RuntimeError):  # the engine may have stopped
                self._engine.submit(session.recordings.forget, recording.id)

        most = min(self._most_ticks, room_bytes // row_bytes)
        recorder = self._open[recording.id] = Recorder(recording.id, file, schema, session.dt_ms, most, ended)
        try:
            tick = await self._engine.call(
                session.recordings.begin, recorder, wanted.name, actor, wanted.past_ticks, wanted.ticks, condition
            )
        except BaseException:
            recorder.stop(CLOSED)
            raise
        if tick is None:
            return recording
        if not recorder.is_open:
            await asyncio.to_thread(recorder.join)
            return await self._store.get(recording.id)
        return self._store.begin(recording, tick)

    def progress(self, recording_id: str) -> WorkProgress | None:
        """Return how far a recording is; None once its file is whole."""
        recorder = self._open.get(recording_id)
        if recorder is None:
            return None
        state = "recording" if recorder.has_begun else "armed"
        return WorkProgress(
            state=state, fraction=recorder.taken / max(recorder.total, 1), done=recorder.taken, total=recorder.total
        )

    async def end(self, session: LiveBench, recording_id: str) -> Recording:
        """End a recording and wait until its file is whole."""
        recorder = await self._engine.call(session.recordings.stop, recording_id)
        await asyncio.to_thread(recorder.join)
        return await self._store.get(recording_id)
