"""The running service: the parts of one application, from start to stop."""

from __future__ import annotations

import asyncio
import contextlib
import importlib.util
import logging
import secrets
from collections.abc import AsyncIterator
from typing import TYPE_CHECKING

import pyarrow as pa

from server.bench.benches import Benches
from server.bench.engine import Engine
from server.bench.experiment import THIS_VERSION, experiment_of
from server.bench.portrait import bench_of
from server.bench.recording import Records
from server.bench.session import Session
from server.bench.status import Bench, Opened
from server.errors import ApiError, not_found
from server.idling import EVERY_S, Idling
from server.kernels import Kernels
from server.lag import Lateness, probe
from server.metrics import Metrics
from server.runs.figures import Figures
from server.runs.jobs import Jobs
from server.runs.queue import Queue
from server.runs.sweeps import Sweeps
from server.security.limits import Buckets
from server.settings import Settings
from server.store.database import Database
from server.store.keeping import Keeping
from server.store.links import Content, LinkDetail, Links
from server.store.parameter_sets import ParameterSets
from server.store.recordings import Recordings
from server.stream.hub import Hub

if TYPE_CHECKING:
    from server.view3d.viewers import Viewers

log = logging.getLogger(__name__)


class Service:
    """Engine, benches, streams, store and runs of one application.

    Parameters
    ----------
    settings : Settings
        Limits and places.
    """

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.id = secrets.token_hex(8)
        self.metrics = Metrics()
        self.lag = Lateness(self.metrics.loop_lag)
        self.hub = Hub(settings, self.metrics, self._lateness)
        self.engine = Engine(self.metrics, self._after_round)
        self.database = Database(settings.database_url or settings.data / "combbench.sqlite3")
        self.recordings = Recordings(self.database, settings.data / "recordings", settings.disk_reserve_bytes)
        self.parameter_sets = ParameterSets(self.database)
        self.benches = Benches(self.engine, settings, self.metrics)
        self.records = Records(self.engine, self.recordings, settings.max_recording_ticks)
        self.links = Links(self.database, settings.max_links)
        self.idling = Idling(self._present, settings.idle_minutes)
        self.queue = Queue(self.database, settings, self.metrics)
        self.jobs = Jobs(self.queue, settings)
        self.sweeps = Sweeps(self.queue, settings, self.database)
        self.figures = Figures(self.queue, settings)
        self.keeping = Keeping(self.database, settings)
        self.commands = Buckets(settings.command_rate_per_s, settings.command_burst)
        self.viewers = _viewers()
        self._coming_back = asyncio.Lock()
        self.file_turn, self.experiment_turn = asyncio.Semaphore(1), asyncio.Semaphore(1)
        self.kernels = Kernels()
        self.is_ready = False
        self._loop: asyncio.AbstractEventLoop | None = None

    @contextlib.asynccontextmanager
    async def running(self) -> AsyncIterator[None]:
        """Start everything, and stop it in the opposite order."""
        self._loop = asyncio.get_running_loop()
        await asyncio.to_thread(self.database.migrate)
        await self.recordings.recover()
        self.engine.start()
        await self.kernels.start()
        await self.queue.recover()
        tasks = [asyncio.create_task(self.hub.run()), asyncio.create_task(probe(self.lag))]
        tasks.append(asyncio.create_task(self.keeping.run()))
        tasks.append(asyncio.create_task(self._watch_idle()))
        tasks.append(asyncio.create_task(self.queue.warm(self.kernels.compiled)))
        # where pandas is installed, pyarrow loads it with the first array, which takes longer than a recording may wait
        tasks.append(asyncio.create_task(asyncio.to_thread(pa.array, [0.0])))
        self.figures.start(self.kernels.compiled)
        self.is_ready = True
        try:
            yield
        finally:
            self.is_ready = False
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            await self.kernels.stop()
            if self.viewers is not None:
                await self.viewers.close()
            await self.figures.stop()
            await self.queue.close()
            self.sweeps.close()
            await self.benches.close()
            await asyncio.to_thread(self.engine.stop)
            await asyncio.to_thread(self.database.close)

    def view(self, session: Session) -> Bench:
        """Describe a bench in full."""
        view3d = f"/benches/{session.id}/3d/" if self.viewers is not None else None
        bench = bench_of(session, self.hub.around(session), view3d)
        return bench.model_copy(update={"let_go_in_s": self.idling.left_s(session)})

    def views(self) -> list[Bench]:
        """Describe the benches, oldest first; one that cannot be described does not hide the others."""
        descriptions = []
        for session in self.benches.all():
            try:
                descriptions.append(self.view(session))
            except Exception:
                log.exception("bench %s cannot be described", session.id)
        return descriptions

    async def opened(self, session: Session) -> Bench:
        """Describe a bench just made; one that cannot be described is closed again."""
        try:
            return self.view(session)
        except Exception:
            await self.close_bench(session)
            raise

    async def close_bench(self, session: Session) -> None:
        """Close a bench, its streams and its 3D view."""
        await self.benches.close_bench(session)
        self.hub.close_bench(session.id)
        self.idling.forget(session.id)
        if self.viewers is not None:
            await self.viewers.drop(session.id)

    async def open_link(self, link: LinkDetail, bench_id: str | None = None) -> Session:
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
        async with self.experiment_turn:  # a class opens a link all at once
            return await self.benches.repeat(experiment, opened, bench_id)

    async def bring_back(self, bench_id: str) -> Session:
        """Return a bench; one that was let go is opened again as it was, by the same id."""
        async with self._coming_back:  # two pages may come back at once
            if found := self.benches.find(bench_id):
                return found
            link = await self.links.let_go(bench_id)
            if link is None:
                raise not_found("bench", bench_id, "it was closed, or let go too long ago")
            session = await self.open_link(link, bench_id)
            await self.links.delete(bench_id)
            return session

    async def let_go(self) -> None:
        """Keep what was done on the benches that nobody needs any more, and close them."""
        for session in self.idling.due(self.benches.all()):
            try:
                await self._let_go(session)
            except Exception:
                log.exception("bench %s could not be let go", session.id)

    async def _let_go(self, session: Session) -> None:
        """Keep what was done on a bench, and close it unless somebody has come meanwhile."""
        if not session.replay_of:  # a recording is kept already
            experiment = await self.engine.call(experiment_of, session)
            title = session.scenario.head.title or session.scenario.id
            try:
                await self.links.keep(Content(experiment=experiment), title[:200], bench_id=session.id)
            except ApiError as error:
                log.warning("bench %s is let go for good: %s", session.id, error.body.message)
        if not self.idling.due([session]):
            return await self.links.delete(session.id)
        await self.close_bench(session)
        log.info("bench %s was let go: nobody had been there for a while", session.id)

    async def _watch_idle(self) -> None:
        """Let benches go that nobody needs."""
        while True:
            await asyncio.sleep(EVERY_S)
            await self.let_go()

    async def close_streams(self) -> None:
        """Tell every page that the server stops, and close its stream."""
        self.hub.close_all("the server is stopping")
        await asyncio.sleep(0.1)

    def _present(self, bench_id: str) -> int:
        """Count the pages that watch a bench, those with its 3D view alone too."""
        return self.hub.watchers(bench_id) + (self.viewers.watchers(bench_id) if self.viewers is not None else 0)

    def _lateness(self) -> dict[str, float]:
        """Return the lateness of the event loop and of the engine."""
        return {"loop_lag_ms": self.lag.p99_ms(), "wake_late_ms": self.engine.lateness.p99_ms()}

    def _after_round(self) -> None:
        """Let the event loop publish the round of the engine; called on the engine thread."""
        loop = self._loop
        if loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop may be closing
                loop.call_soon_threadsafe(self.hub.publish)


def _viewers() -> Viewers | None:
    """Return the 3D views, if their folder is there."""
    if importlib.util.find_spec("server.view3d") is None:
        return None
    from server.view3d.viewers import Viewers

    return Viewers()
