"""The running service: the parts of one application, from start to stop."""

from __future__ import annotations

import asyncio
import contextlib
import importlib.util
import logging
import secrets
from collections.abc import AsyncIterator
from typing import TYPE_CHECKING

from server.bench.benches import Benches
from server.bench.engine import Engine
from server.bench.portrait import bench_of
from server.bench.session import Session
from server.bench.status import Bench
from server.kernels import Kernels
from server.lag import Lateness, probe
from server.metrics import Metrics
from server.runs.figures import Figures
from server.runs.jobs import Jobs
from server.runs.sweeps import Sweeps
from server.security.limits import Buckets
from server.settings import Settings
from server.store.database import Database
from server.store.keeping import Keeping
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
        self.benches = Benches(self.engine, self.recordings, settings, self.metrics)
        self.jobs = Jobs(self.database, settings, self.metrics)
        self.figures = Figures(self.jobs, settings)
        self.keeping = Keeping(self.database, settings)
        self.sweeps = Sweeps(self.database, settings, self.metrics)
        self.commands = Buckets(settings.command_rate_per_s, settings.command_burst)
        self.viewers = _viewers()
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
        await self.jobs.recover()
        await self.sweeps.recover()
        tasks = [asyncio.create_task(self.hub.run()), asyncio.create_task(probe(self.lag))]
        tasks.append(asyncio.create_task(self.keeping.run()))
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
            await self.sweeps.close()
            await self.jobs.close()
            await self.benches.close()
            await asyncio.to_thread(self.engine.stop)
            await asyncio.to_thread(self.database.close)

    def view(self, session: Session) -> Bench:
        """Describe a bench in full."""
        view3d = f"/benches/{session.id}/3d/" if self.viewers is not None else None
        return bench_of(session, self.hub.around(session), view3d)

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
        if self.viewers is not None:
            await self.viewers.drop(session.id)

    async def close_streams(self) -> None:
        """Tell every page that the server stops, and close its stream."""
        self.hub.close_all("the server is stopping")
        await asyncio.sleep(0.1)

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
