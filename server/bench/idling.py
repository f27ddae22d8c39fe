"""Unused benches: each is stored as its experiment and closed; it comes back by its id, as a link opens a new one."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable

from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.description import experiment_of
from server.bench.engine import Engine
from server.bench.status import Opened
from server.clock import Clock
from server.errors import ApiError
from server.store.experiment import THIS_VERSION
from server.store.links import Content, LinkDetail, Links

log = logging.getLogger(__name__)

EVERY_S = 5.0
"""Between two looks at the benches."""


class Idling:
    """Closes benches that are unused for a while, and opens experiments again.

    Parameters
    ----------
    benches : Benches
        The live benches.
    engine : Engine
        Whose thread may read a bench.
    links : Links
        Where experiments are kept.
    watchers : callable
        Counts the pages that watch a bench.
    idle_minutes : float
        How long an unused bench stays; 0 is without limit.
    close_bench : callable
        Closes a bench and its streams; given ``comes_back``, the sharing of it goes on.
    turn : Semaphore
        Lets one experiment after another be repeated.
    """

    def __init__(
        self,
        benches: Benches,
        engine: Engine,
        links: Links,
        watchers: Callable[[str], int],
        idle_minutes: float,
        close_bench: Callable[..., Awaitable[None]],
        turn: asyncio.Semaphore,
    ) -> None:
        self._benches, self._engine, self._links = benches, engine, links
        self._watchers, self._patience_s, self.clock = watchers, 60.0 * idle_minutes, engine.clock
        self._close_bench, self._turn = close_bench, turn
        self._seen: dict[str, float] = {}
        self._coming_back = asyncio.Lock()

    def saw(self, bench_id: str) -> None:
        """Note that a bench is in use now."""
        self._seen[bench_id] = self.clock()

    def forget(self, bench_id: str) -> None:
        """Forget a bench that is gone."""
        self._seen.pop(bench_id, None)

    def left_s(self, session: LiveBench) -> float | None:
        """Return how long an unused bench still stays; None if it is needed."""
        if not self._patience_s or self._is_needed(session):
            return None
        seen = self._seen.setdefault(session.id, self.clock())
        return max(0.0, seen + self._patience_s - self.clock())

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
                raise self._benches.absent(bench_id, "it was closed")
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
        for session in [one for one in self._benches.all() if self._may_go(one)]:
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
        if not self._may_go(session):
            return await self._links.delete(session.id)
        await self._close_bench(session, comes_back=is_kept)
        log.info("bench %s was closed after a while without users", session.id)

    def _may_go(self, session: LiveBench) -> bool:
        """Say whether a bench has been unused for long enough; a bench that is needed is in use now."""
        if self._is_needed(session):
            self.saw(session.id)
        return self.left_s(session) == 0.0

    def _is_needed(self, session: LiveBench) -> bool:
        """Say whether a bench has a watcher, is to be kept, has a view for now, or has something to come or to lose.

        Waiting commands of a paused bench are kept with it; on a running bench their moment comes. Moments that were
        kept of a bench would be lost.
        """
        recordings = session.recordings
        return (
            session.keep
            or session.view is not None
            or self._watchers(session.id) > 0
            or bool(recordings.under_way or recordings.armed or session.snapshots.all())
            or (session.is_running and len(session.board.pending) > 0)
            or bool(session.time.steps)
        )
