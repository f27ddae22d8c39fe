"""The registry of live benches: it makes, finds, copies and closes them."""

from __future__ import annotations

import asyncio
import math
import secrets
import time
from collections import Counter
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import Future
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from core.board.board import Board
from core.board.document import Document
from core.errors import InputError
from core.format import format_count
from core.kernel import renew
from core.own.admission import kept_with
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.build import Builder, check, is_id, prepare, rebuilt
from server.bench.checkpoints import Kept
from server.bench.commands import Reset, Seek
from server.bench.engine import Engine
from server.bench.events import Event
from server.bench.instrument import tell_end
from server.bench.pacing import usual_scale
from server.bench.recorder import Recorder
from server.bench.status import Opened
from server.bench.travel import Travels, repeat, reset
from server.computing.computing import Computing
from server.errors import ApiError, not_found
from server.metrics import Metrics
from server.settings import Settings
from server.store.earlier import as_written
from server.store.experiment import Experiment
from server.store.recordings import RecordingDetail


class Benches:
    """The registry of live benches; changed on the event loop only.

    Parameters
    ----------
    engine : Engine
        Advances the benches.
    settings : Settings
        Limits.
    metrics : Metrics
        Where benches and commands are counted.
    computing : Computing
        Where a scenario is read before this process reads it.
    witness : callable, optional
        Hears of every event of every bench.
    """

    def __init__(
        self,
        engine: Engine,
        settings: Settings,
        metrics: Metrics,
        computing: Computing,
        witness: Callable[[LiveBench, Event], None] | None = None,
    ) -> None:
        self._engine, self._settings, self._metrics, self._witness = engine, settings, metrics, witness
        self._computing = computing
        self.builder = Builder(settings, metrics, engine.clock)
        self._sessions: dict[str, LiveBench] = {}
        self.travels = Travels(self, engine, settings.max_run_ticks)
        self._coming = 0
        self.not_back: dict[str, str] = {}
        """Benches that could not come back after a restart, each with the reason."""

    def __len__(self) -> int:
        return len(self._sessions)

    def all(self) -> list[LiveBench]:
        """List the benches, oldest first."""
        return list(self._sessions.values())

    def find(self, bench_id: str) -> LiveBench | None:
        """Return a bench, or nothing."""
        return self._sessions.get(bench_id)

    def get(self, bench_id: str) -> LiveBench:
        """Return a bench, or refuse with 404."""
        session = self._sessions.get(bench_id)
        if session is None:
            hint = "list the live ones at /api/v1/benches; a closed idle bench comes back by /reopen"
            raise self.absent(bench_id, hint)
        return session

    def absent(self, bench_id: str, hint: str) -> ApiError:
        """Return the refusal of a bench that is not live, with the reason if it could not come back after a restart."""
        why = self.not_back.get(bench_id)
        return not_found("bench", bench_id, f"it could not come back after a restart: {why}" if why else hint)

    async def check(self, source: str | dict[str, Any], values: dict[str, Any]) -> None:
        """Refuse a scenario that makes no bench, or takes too much, before this process reads it."""
        self._computing.check_budget()
        if values or not is_id(source):
            await self._computing.call(check, source, values, self.builder.units.beside({}))

    async def create(
        self,
        source: str | dict[str, Any],
        values: dict[str, Any],
        seed: int | None,
        paused: bool,
        time_scale: float | None,
        *,
        own_scale: bool = False,
        quiet_lead: bool = False,
        class_id: str = "",
        before: Callable[[LiveBench], None] = lambda _: None,
    ) -> LiveBench:
        """Make a bench from a library id, a TOML text or a document; with ``own_scale`` at the pace of its device.

        With ``quiet_lead`` it begins as fast as possible, to shortly before the first command of the scenario. The
        bench of a student of a class has less room for its history. ``before`` gets the bench before it begins.

        Raises
        ------
        InputError
            If the scenario is not valid.
        ApiError
            If there are too many benches.
        """

        def made() -> LiveBench:
            scenario, board = self._prepared(source, values, seed, self.builder.units.beside)
            scale = usual_scale(board) if own_scale else time_scale
            session = self.builder.around(scenario, board, scale, class_id)
            session.time.fast_forward.leads = quiet_lead
            before(session)
            return session

        return await self.admit(asyncio.to_thread(made), not paused, is_counted=not class_id)

    async def replay(self, recording: RecordingDetail, path: Path, speed: float, paused: bool) -> LiveBench:
        """Make a bench that plays a recording, at a multiple of the pace it was recorded at.

        Raises
        ------
        ApiError
            If there are too many benches, or this version cannot read its scenario.
        """
        return await self.admit(asyncio.to_thread(self.builder.replay, recording, path, speed), not paused)

    async def repeat(self, experiment: Experiment, opened: Opened, bench_id: str | None = None) -> LiveBench:
        """Make a bench with the state of an experiment, running or paused as the original was.

        Parameters
        ----------
        experiment : Experiment
            The experiment to repeat.
        opened : Opened
            The origin of the bench.
        bench_id : str, optional
            The id of the bench it was.

        Raises
        ------
        ApiError
            If there are too many benches, or the experiment cannot be repeated.
        """

        def made() -> LiveBench:
            scenario, board = rebuilt(experiment, self._settings.max_run_ticks)
            session = self.builder.around(scenario, board, experiment.time_scale)
            session.id = bench_id or ""
            same = repeat(session, experiment)
            session.opened = opened.model_copy(update={"same_bits": same})
            return session

        return await self.admit(asyncio.to_thread(made), experiment.running)

    async def revive(self, kept: Kept, before: Callable[[LiveBench, Kept], None]) -> LiveBench:
        """Make a bench that continues from a checkpoint, under the same id; ``before`` is called before it continues.

        Raises
        ------
        InputError
            If this version of the code cannot continue from it.
        """

        def made() -> LiveBench:
            scenario, board = kept.board_of()
            session = self.builder.around(scenario, board, kept.head.time_scale, class_id)
            kept.put_into(session)
            tell_end(session)
            return session

        async def coming() -> LiveBench:
            session = await asyncio.to_thread(made)
            before(session, kept)
            return session

        class_id = kept.head.class_id
        return await self.admit(coming(), kept.head.running, is_counted=not class_id)

    async def admit(
        self, coming: LiveBench | Coroutine[Any, Any, LiveBench], start: bool, *, is_counted: bool = True
    ) -> LiveBench:
        """Take in a bench, also while it is being made, if there is room; classes limit the benches of students."""
        try:
            with self._room() if is_counted else nullcontext():
                return await self._enter(coming if isinstance(coming, LiveBench) else await coming, start)
        finally:
            if not isinstance(coming, LiveBench):
                coming.close()  # without room it was never awaited

    @contextmanager
    def _room(self) -> Iterator[None]:
        """Take the room of one bench until it is live, or refuse."""
        most, minutes = self._settings.max_benches, self._settings.idle_minutes
        if sum(not session.class_id for session in self.all()) + self._coming >= most:
            after = format_count(math.ceil(minutes), "minute")
            wait = f"; a bench without watchers is closed after {after}" if minutes else ""
            text = f"the server is full: {most} of {most} benches are live (max_benches)"
            raise ApiError(409, "too_many_benches", text, hint=f"use a running bench, or close one{wait}")
        self._coming += 1
        try:
            yield
        finally:
            self._coming -= 1

    async def _enter(self, session: LiveBench, start: bool) -> LiveBench:
        session.id = session.id or secrets.token_hex(6)
        session.witness = self._witness
        await self._engine.call(self._open, session, start and session.board.trip is None)
        self._sessions[session.id] = session
        return session

    async def close_bench(self, session: LiveBench) -> None:
        """Stop a bench for good; its recordings are made whole."""
        self._sessions.pop(session.id, None)
        recorders = await self._engine.call(self._shut, session)
        for recorder in recorders:
            await asyncio.to_thread(recorder.join)

    async def close(self) -> None:
        """Stop all benches."""
        for session in self.all():
            await self.close_bench(session)

    async def command(self, session: LiveBench, command: Any, actor: str) -> Event:
        """Carry out a command at the next tick edge, a step to its end.

        Raises
        ------
        InputError
            If the command cannot be carried out; nothing has changed then.
        """
        outcome = await self.begin(session, command, actor)
        return outcome if isinstance(outcome, Event) else await asyncio.wrap_future(outcome)

    async def begin(self, session: LiveBench, command: Any, actor: str) -> Event | Future[Event]:
        """Carry out a command at the next tick edge; for a step, return a future that holds its event at its end."""
        kind = command.kind
        event: Event | Future[Event]
        rules = view.rules if (view := session.view) is not None else None
        if rules is not None:
            rules.check(command)
        try:
            if isinstance(command, Seek) and session.origin is not None:
                event = await self.travels.seek(session, command.tick, actor)
            elif isinstance(command, Reset) and not session.replay_of:
                event = await self._reset(session, command, actor)
            else:
                event = await self._engine.call(session.execute, command, actor)
        except (InputError, ApiError) as error:
            self._metrics.commands.labels(kind, "refused").inc()
            if isinstance(error, InputError):
                raise as_written(error if rules is None else rules.refusal(error), type(command)) from None
            raise
        self._metrics.commands.labels(kind, "done").inc()
        return event

    async def _reset(self, session: LiveBench, command: Reset, actor: str) -> Event:
        """Begin the scenario of a bench again, with other values if some are given."""
        values = {"seed": session.board.spec.seed, **command.values}
        self._computing.check_budget()
        with kept_with(command.values):
            if command.values:
                await self.check(session.scenario.document, values)
            scenario, board = await asyncio.to_thread(self._prepared, session.scenario.document, values)
        return await self._engine.call(reset, session, scenario, board, actor, command.before_tick)

    async def renew(self) -> None:
        """Give all benches the code for this very processor, each at its next tick edge."""
        await asyncio.to_thread(renew)
        for session in self.all():
            if isinstance(session.board, Board):
                await self._engine.call(session.board.renew)

    def count(self) -> None:
        """Bring the gauge of benches up to date."""
        states = Counter(session.status.state for session in self.all())
        for state in ("running", "paused", "tripped"):
            self._metrics.benches.labels(state).set(states[state])

    def _prepared(
        self,
        source: str | dict[str, Any],
        values: dict[str, Any],
        seed: int | None = None,
        units: Callable[[Document], Document] | None = None,
    ) -> tuple[Scenario, Board]:
        """Make the parts of a bench, at the expense of the person whose request is at work; called in a thread."""
        begun = time.thread_time()
        try:
            return prepare(source, values, seed, units)
        finally:
            self._computing.spend(time.thread_time() - begun)

    def _open(self, session: LiveBench, start: bool) -> None:
        """Give a bench to the engine (a job)."""
        self._engine.add(session)
        session.begin(start)

    def _shut(self, session: LiveBench) -> list[Recorder]:
        """Take a bench from the engine (a job)."""
        self._engine.remove(session.id)
        return session.close()
