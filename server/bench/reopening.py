"""Experiments that are opened again: experiments of links, and unused benches that were closed."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable
from typing import Protocol

from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.engine import Engine
from server.bench.experiment import experiment_of
from server.bench.idling import EVERY_S, Idling
from server.bench.status import Opened
from server.clock import Clock
from server.errors import ApiError, not_found
from server.store.experiment import THIS_VERSION
from server.store.links import Content, LinkDetail, Links

log = logging.getLogger(__name__)


class CloseBench(Protocol):
    """Closes a bench and its streams."""

    def __call__(self, session: LiveBench, *, comes_back: bool = False) -> Awaitable[None]:
        """Close a bench; sharing of it ends too unless it comes back."""


class Reopening:
    """Lets benches go, and opens experiments again.

    Parameters
    ----------
    benches : Benches
        The live benches.
    engine : Engine
        Whose thread may read a bench.
    links : Links
        Where experiments are kept.
    idling : Idling
        Finds the unused benches.
    close_bench : callable
        Closes a bench and its streams.
    turn : Semaphore
        Lets one experiment after another be repeated.
    """

    def __init__(
        self,
        benches: Benches,
        engine: Engine,
        links: Links,
        idling: Idling,
        close_bench: CloseBench,
        turn: asyncio.Semaphore,
    ) -> None:
        self._benches, self._engine, self._links = benches, engine, links
        self._idling, self._close_bench, self._turn = idling, close_bench, turn
        self._coming_back = asyncio.Lock()

    async def open_link(self, link: LinkDetail, bench_id: str | None = None) -> LiveBench:
        """Make a bench that repeats the experiment of a link.

        Raises
        ------
        ApiError
            If it leads to none, or it cannot be repeated.
        """
        experiment = link.content.experiment
        if experiment is None:
            raise ApiError(409, "conflict", "the link leads to a layout, not to an experiment")
        opened = Opened(
            link=None if bench_id else link.id,
            note=link.note,
            version=experiment.version,
            version_now=THIS_VERSION,
            same_bits=False,
        )
        async with self._turn:  # a class opens a link all at once
            return await self._benches.repeat(experiment, opened, bench_id)

    async def bring_back(self, bench_id: str) -> LiveBench:
        """Return a bench; a closed idle bench is opened again as it was, under the same id."""
        async with self._coming_back:  # two pages may come back at once
            if found := self._benches.find(bench_id):
                return found
            link = await self._links.let_go(bench_id)
            if link is None:
                raise not_found("bench", bench_id, "it was closed")
            session = await self.open_link(link, bench_id)
            try:
                await self._links.delete(bench_id)
            except BaseException:
                await self._close_bench(session, comes_back=True)
                raise
            return session

    async def run(self, clock: Clock) -> None:
        """Close unused benches, again and again."""
        async for _ in clock.every(EVERY_S):
            await self.let_go()

    async def let_go(self) -> None:
        """Store the experiments of unused benches, and close them."""
        for session in self._idling.due(self._benches.all()):
            try:
                await self._let_go(session)
            except Exception:
                log.exception("bench %s could not be closed", session.id)

    async def _let_go(self, session: LiveBench) -> None:
        """Store the experiment of a bench, and close it unless it is in use again meanwhile."""
        is_kept = False
        if not session.replay_of:  # a recording is kept already
            experiment = await self._engine.call(experiment_of, session)
            title = session.scenario.head.title or session.scenario.id
            try:
                await self._links.keep(Content(experiment=experiment), title[:200], bench_id=session.id)
                is_kept = True
            except ApiError as error:
                log.warning("bench %s is closed for good: %s", session.id, error.body.message)
        if not self._idling.due([session]):
            return await self._links.delete(session.id)
        await self._close_bench(session, comes_back=is_kept)
        log.info("bench %s was closed after a while without users", session.id)
