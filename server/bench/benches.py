"""All live benches: made, found, copied, closed."""

from __future__ import annotations

import asyncio
from collections import Counter
from typing import Any

from core.board.board import Board
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.commands import DEFAULT_SCALE, MAX_SCALE, Reset
from server.bench.engine import Engine
from server.bench.events import Event
from server.bench.recorder import Recorder
from server.bench.session import Session
from server.errors import ApiError, not_found
from server.metrics import Metrics
from server.settings import Settings
from server.store.recordings import Recording, Recordings
from server.store.traces import schema_of
from server.version import VERSION


class Benches:
    """The registry of live benches; changed on the event loop only.

    Parameters
    ----------
    engine : Engine
        Advances them.
    recordings : Recordings
        Keeps what they record.
    settings : Settings
        Limits.
    metrics : Metrics
        Where they are counted.
    """

    def __init__(self, engine: Engine, recordings: Recordings, settings: Settings, metrics: Metrics) -> None:
        self._engine, self._recordings = engine, recordings
        self._settings, self._metrics = settings, metrics
        self._sessions: dict[str, Session] = {}
        self._coming = 0

    def __len__(self) -> int:
        return len(self._sessions)

    def all(self) -> list[Session]:
        """List the benches, oldest first."""
        return list(self._sessions.values())

    def find(self, bench_id: str) -> Session | None:
        """Return a bench, or nothing."""
        return self._sessions.get(bench_id)

    def get(self, bench_id: str) -> Session:
        """Return a bench, or refuse with 404."""
        session = self._sessions.get(bench_id)
        if session is None:
            raise not_found("bench", bench_id, "list the live ones at /api/v1/benches")
        return session

    async def create(
        self,
        source: str | dict[str, Any],
        values: dict[str, Any],
        seed: int | None,
        paused: bool,
        time_scale: float | None,
        *,
        own_scale: bool = False,
    ) -> Session:
        """Make a bench from a library id, a TOML text or a document; at the pace of its device if that is wanted.

        Raises
        ------
        InputError
            If the scenario is not valid.
        ApiError
            If there are too many benches.
        """
        self._check_room()
        self._coming += 1
        try:
            scenario, board = await asyncio.to_thread(prepare, source, values, seed)
            if own_scale:
                time_scale = usual_scale(board)
            session = Session(
                scenario, board, time_scale, self._settings.history_ticks, self._metrics, self._engine.clock
            )
            await self._engine.call(self._open, session, not paused)
        finally:
            self._coming -= 1
        self._sessions[session.id] = session
        return session

    async def fork(self, session: Session, snapshot_id: str | None) -> Session:
        """Make a second bench that goes on from a moment of another."""
        self._check_room()
        self._coming += 1
        try:
            twin = await self._engine.call(session.fork, snapshot_id)
            await self._engine.call(self._open, twin, session.is_running)
        finally:
            self._coming -= 1
        self._sessions[twin.id] = twin
        return twin

    async def close_bench(self, session: Session) -> None:
        """Stop a bench for good; its recordings are made whole."""
        self._sessions.pop(session.id, None)
        recorders = await self._engine.call(self._shut, session)
        for recorder in recorders:
            await asyncio.to_thread(recorder.join)

    async def close(self) -> None:
        """Stop all benches."""
        for session in self.all():
            await self.close_bench(session)

    async def command(self, session: Session, command: Any, actor: str) -> Event:
        """Carry out a command at the next tick edge.

        Raises
        ------
        InputError
            If it cannot be; nothing has changed then.
        """
        kind = command.kind
        try:
            if isinstance(command, Reset):
                seed = session.board.spec.seed
                values = {"seed": seed, **command.values}
                scenario, board = await asyncio.to_thread(prepare, session.scenario.document, values, None)
                event = await self._engine.call(session.reset, scenario, board, actor)
            else:
                event = await self._engine.call(session.execute, command, actor)
        except (InputError, ApiError):
            self._metrics.commands.labels(kind, "refused").inc()
            raise
        self._metrics.commands.labels(kind, "done").inc()
        return event

    async def record(self, session: Session, name: str, actor: str) -> Recording:
        """Begin to record every signal of a bench."""
        if len(session.recorders) >= 2:
            raise ApiError(409, "conflict", "two recordings of this bench are under way already")
        about = {"version": VERSION, "scenario": session.scenario.id, "bench": session.id}
        schema = schema_of({signal.name: signal.unit for signal in session.signals}, about)
        title = session.scenario.head.title or session.scenario.id
        recording, file = await self._recordings.open(session.id, name, title, session.dt_ms, schema)
        recorder = Recorder(
            recording.id,
            file,
            schema,
            session.dt_ms,
            self._settings.max_recording_ticks,
            self._recordings.closer(recording.id),
        )
        try:
            tick = await self._engine.call(session.record, recorder, name, actor)
        except BaseException:
            recorder.stop("the bench was closed")
            raise
        return await self._recordings.begin(recording.id, tick)

    async def stop_recording(self, session: Session, recording_id: str) -> Recording:
        """End a recording and wait until its file is whole."""
        recorder = await self._engine.call(session.stop_recording, recording_id)
        await asyncio.to_thread(recorder.join)
        return await self._recordings.get(recording_id)

    def count(self) -> None:
        """Bring the gauge of benches up to date."""
        states = Counter(session.status.state for session in self.all())
        for state in ("running", "paused", "tripped"):
            self._metrics.benches.labels(state).set(states[state])

    def _check_room(self) -> None:
        """Refuse one bench too many."""
        if len(self) + self._coming >= self._settings.max_benches:
            raise ApiError(
                409,
                "too_many_benches",
                f"{self._settings.max_benches} benches are live, the limit (max_benches)",
                hint="close one first",
            )

    def _open(self, session: Session, start: bool) -> None:
        """Give a bench to the engine (a job)."""
        self._engine.add(session)
        session.begin(start)

    def _shut(self, session: Session) -> list[Recorder]:
        """Take a bench from the engine (a job)."""
        self._engine.remove(session.id)
        return session.close()


def prepare(source: str | dict[str, Any], values: dict[str, Any], seed: int | None) -> tuple[Scenario, Board]:
    """Read a scenario, write values over it, wire its board."""
    scenario = with_values(read_scenario(source), values)
    return scenario, build(scenario, seed)


def read_scenario(source: str | dict[str, Any]) -> Scenario:
    """Read a scenario: a document, a library id, or a TOML text (which has an equals sign)."""
    if isinstance(source, dict):
        return Scenario.load(source)
    if "=" in source or "\n" in source:
        return Scenario.load(source)
    return get(source)


def usual_scale(board: Board) -> float:
    """Return the time scale that suits a device: that of a resonator, or near real time for a plant in seconds."""
    return min(MAX_SCALE, DEFAULT_SCALE * max(1.0, board.spec.device.oscillator().time_unit_ms))
