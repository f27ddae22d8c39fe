"""The recordings of live benches, from their beginning to a whole file."""

from __future__ import annotations

import asyncio
import contextlib
import json

from core.board.condition import parse_condition
from server.bench.engine import Engine
from server.bench.portrait import document_of
from server.bench.recorder import CLOSED, WANTED, Recorder
from server.bench.recordings import Wanted
from server.bench.session import Session
from server.errors import ApiError
from server.store.recordings import About, Recording, Recordings
from server.store.traces import schema_of
from server.version import VERSION


class Records:
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

    async def begin(self, session: Session, wanted: Wanted, actor: str, room_bytes: int) -> Recording:
        """Begin to record every signal of a bench, now or when a condition holds.

        Parameters
        ----------
        session : Session
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
            "time_scale": session.pacer.scale,
        }
        schema = schema_of(
            {signal.name: signal.unit for signal in session.signals}, json.loads(json.dumps(file_says, default=str))
        )
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
            with contextlib.suppress(RuntimeError):  # the engine may have stopped
                self._engine.submit(session.recordings.forget, recording.id)

        most = min(self._most_ticks, room_bytes // row_bytes)
        recorder = Recorder(recording.id, file, schema, session.dt_ms, most, ended)
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

    async def end(self, session: Session, recording_id: str) -> Recording:
        """End a recording and wait until its file is whole."""
        recorder = await self._engine.call(session.recordings.stop, recording_id)
        await asyncio.to_thread(recorder.join)
        return await self._store.get(recording_id)
