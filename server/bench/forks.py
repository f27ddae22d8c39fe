"""Forks: second benches that continue from a moment of another, or begin with its settings."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from dataclasses import replace
from functools import partial
from typing import Any, Protocol, TypeVar

from core.board.board import Board
from core.errors import InputError
from server.bench.engine import Engine
from server.bench.events import Event
from server.bench.experiment import experiment_of, rebuilt, repeat
from server.bench.maker import Maker
from server.bench.past import Past
from server.bench.portrait import design_of
from server.bench.running import STATUS_S
from server.bench.session import Session
from server.bench.status import Travel

T = TypeVar("T")


class Registry(Protocol):
    """The part of the registry of benches that forks need."""

    maker: Maker

    def find(self, bench_id: str) -> Session | None:
        """Return a bench, or nothing."""

    async def admit(self, coming: Coroutine[Any, Any, Session], start: bool) -> Session:
        """Take in a bench that is being made, if there is room."""

    async def create(
        self, source: dict[str, Any], values: dict[str, Any], seed: int | None, paused: bool, time_scale: float | None
    ) -> Session:
        """Make a bench from a document."""


class Forks:
    """Makes benches from others.

    Parameters
    ----------
    benches : Registry
        The live benches.
    engine : Engine
        Whose thread may read a bench.
    most_ticks : int
        The longest experiment that is repeated.
    """

    def __init__(self, benches: Registry, engine: Engine, most_ticks: int) -> None:
        self._benches, self._engine, self._most_ticks = benches, engine, most_ticks

    async def now(self, session: Session, snapshot_id: str | None, *, paused: bool = False) -> Session:
        """Make a bench that continues from this moment of another, or from a snapshot."""
        coming = self._engine.call(forked, session, snapshot_id, self._benches.maker)
        return await self._benches.admit(coming, session.is_started and not paused)

    async def at(
        self, session: Session, tick: int, window_ticks: int, *, is_before: bool = False, paused: bool = False
    ) -> Session:
        """Make a bench that continues from a tick of the past of another, computed again.

        Raises
        ------
        InputError
            For a tick that is not kept.
        """
        past = await self._engine.call(partial(Past.take, session, tick, window_ticks, is_before=is_before))
        coming = self._computed(past, session, lambda made: made)
        return await self._benches.admit(coming, session.is_started and not paused)

    async def seek(self, session: Session, tick: int, actor: str) -> Event:
        """Show another tick of the past on a bench that shows a past tick; a computation for another tick is cancelled.

        Raises
        ------
        InputError
            For a tick that is not kept, when the bench has gone on, and when another tick is sought meanwhile.
        """
        assert session.origin is not None
        of = self._benches.find(session.origin.bench) or session
        past = await self._engine.call(Past.take, of, tick, session.origin.window_ticks)
        past = replace(past, origin=session.origin.model_copy(update={"tick": tick}))
        session.sought = past
        return await self._computed(
            past, session, lambda other: session.show(other, actor), lambda: session.sought is past
        )

    async def _computed(
        self,
        past: Past,
        asked: Session,
        then: Callable[[Session], T],
        is_wanted: Callable[[], bool] = lambda: True,
    ) -> T:
        """Compute a moment of the past while it is wanted, and give it to ``then`` (in a job of the engine).

        The bench of the request shows the progress. All steps after the computing are one job: pages get a picture
        after a job, and after several they would wait for the next one.
        """
        travel = asked.travel = Travel(tick=past.origin.tick, share=0.0)

        def go(share: float) -> None:
            if not is_wanted():
                raise InputError("another moment is sought by now", "tick", code="conflict")
            travel.share = share

        def end() -> None:
            if asked.travel is travel:
                asked.travel = None
                asked.refresh_status()

        def settle(made: Session) -> T:
            end()
            if not past.is_true():
                raise InputError("the bench itself has gone to another moment meanwhile", "tick", code="conflict")
            return then(made)

        computing = asyncio.create_task(asyncio.to_thread(past.session, self._benches.maker, go))
        try:
            while not (await asyncio.wait([computing], timeout=STATUS_S))[0]:
                await self._engine.call(asked.refresh_status)
            return await self._engine.call(settle, await computing)
        except BaseException:
            await self._engine.call(end)
            raise

    async def variant(self, session: Session, values: dict[str, Any]) -> Session:
        """Make a bench that begins as another is set now, with values written over it.

        Raises
        ------
        InputError
            If the values do not fit.
        ApiError
            If there are too many benches.
        """
        document = await self._engine.call(design_of, session)
        paused, scale = not session.is_started, session.pacer.scale
        return await self._benches.create(document, values, session.board.spec.seed, paused, scale)

    async def repeated(self, session: Session, values: dict[str, Any]) -> Session:
        """Make a bench with the commands of another, with values written over its scenario; it is paused there.

        Raises
        ------
        InputError
            If the values do not fit the scenario or the commands.
        ApiError
            If there are too many benches, or the other has run for too long.
        """
        experiment = await self._engine.call(experiment_of, session)

        def made() -> Session:
            scenario, board = rebuilt(experiment, self._most_ticks, values)
            other = self._benches.maker.around(scenario, board, experiment.time_scale)
            repeat(other, experiment)
            return other

        return await self._benches.admit(asyncio.to_thread(made), start=False)


def forked(session: Session, snapshot_id: str | None, maker: Maker) -> Session:
    """Return a bench with the present state of another, or with the state of a snapshot (a job)."""
    moment = session.snapshots.get(snapshot_id).moment if snapshot_id else session.moment()
    board = Board.restore(moment.checkpoint)
    twin = maker.around(moment.scenario, board, session.pacer.scale)
    twin.running.ends_at = session.running.ends_at
    if (track := session.track_to(moment)) is not None:
        twin.track = track.until(board)
        if board.tick <= session.history.end_tick:
            twin.history.adopt(session.history, board.tick - session.past_ticks, board.tick)
    if moment.told is not None:
        twin.narration.go_to(moment.told)
    twin.note("api", "forked", f"forked from bench {session.id}")
    twin.refresh_status()
    return twin
