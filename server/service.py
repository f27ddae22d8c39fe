"""The running service: the parts of one application, from start to stop."""

from __future__ import annotations

import asyncio
import contextlib
import importlib.util
import logging
import secrets
from collections.abc import AsyncIterator, Sequence
from typing import TYPE_CHECKING

from core.compile.code import borrowed
from scenarios.arrow import pa
from scenarios.record_folders import found_by_benches
from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.checkpoints import Checkpoints
from server.bench.engine import Engine
from server.bench.fusing import Fusing
from server.bench.idling import Idling
from server.bench.recording import RecordingControl
from server.bench.watchdog import Safety, Watchdog
from server.classroom.audit import Audit
from server.classroom.blinds import Blinds
from server.classroom.classes import Classes
from server.classroom.driving import Driving, go_without_driver
from server.classroom.game_table import GameTable
from server.classroom.games import Games
from server.classroom.joining import Joining
from server.classroom.lesson import Lesson
from server.classroom.people import People
from server.classroom.sheet_shelf import Shelf
from server.classroom.sheets import Sheets
from server.classroom.student_benches import StudentBenches
from server.classroom.views import Views
from server.classroom.votes import Votes
from server.clock import Clock, ManualClock
from server.computing.computing import Computing
from server.instruments.instruments import Instruments
from server.lag import Lateness, probe
from server.metrics import Metrics
from server.progress import ProgressStreams
from server.runs.figures import ScenarioFigures
from server.runs.jobs import Jobs
from server.runs.kernels import Kernels
from server.runs.queue import Queue
from server.runs.sweeps import Sweeps
from server.runs.thresholds import Thresholds
from server.security.callers import Callers
from server.security.limits import Buckets
from server.security.person import Person
from server.security.public import PublicOrigin
from server.settings import Settings
from server.store.change import Change
from server.store.database import FILE, Database
from server.store.keeping import Keeping
from server.store.links import Links
from server.store.measured_devices import MeasuredDevices
from server.store.measured_records import MeasuredRecords
from server.store.parameter_sets import ParameterSets
from server.store.recordings import Recordings
from server.stream.hub import Hub

if TYPE_CHECKING:
    from server.view3d.viewers import Viewers

log = logging.getLogger(__name__)

FIRST_PAGE_S = 3.0
"""Time before the processes for requests are started; loading takes a second of a processor for each process."""


class Service:
    """Engine, benches, streams, store and runs of one application.

    Parameters
    ----------
    settings : Settings
        Limits and places.
    """

    def __init__(self, settings: Settings) -> None:
        self.settings, self.public = settings, PublicOrigin.parse(settings.public_origin)
        self.id = secrets.token_hex(8)
        self.metrics = Metrics()
        self.lag = Lateness(self.metrics.loop_lag)
        self.clock = ManualClock() if settings.clock == "manual" else Clock()
        self.hub = Hub(settings, self.metrics, self._lag, self.clock)
        self.engine = Engine(self.metrics, self._after_round, self.clock)
        self.database = Database(settings.database_url or settings.data / FILE)
        self.recordings = Recordings(self.database, settings.data / "recordings", settings.disk_reserve_bytes)
        self.measured_records = MeasuredRecords(self.database, settings.data / "records")
        self.measured_devices = MeasuredDevices(self.database)
        self.parameter_sets = ParameterSets(self.database)
        self.people, self.audit = People(self.database), Audit(self.database)
        self.computing = Computing(self.clock)
        self.benches = Benches(self.engine, settings, self.metrics, self.computing, self.audit.witness)
        self.units = self.benches.builder.units
        self.driving = Driving(self.people, self.hub, self._note, self._go_without_driver, self.clock)
        self.hub.company = self.driving.company
        self.lesson = Lesson(self.database, self.people, self.audit, self.hub)
        self.checkpoints = Checkpoints(settings.data / "benches", self.engine, self._kept)
        self.student_benches = StudentBenches(
            self.database, self.people, self.benches, self.swap, self.close_benches, self.checkpoints
        )
        self.blinds, self.votes = Blinds(self.database, self.engine, self._turn_pages), Votes(self.database)
        game_table = GameTable(self.database)
        self.classes = Classes(
            self.database,
            self.people,
            self.student_benches,
            self.audit,
            self.lesson,
            self.blinds,
            self.votes,
            game_table,
            settings.max_students,
        )
        self.records = RecordingControl(self.engine, self.recordings, settings.max_recording_ticks)
        self.links = Links(self.database, settings.max_links)
        self.progress = ProgressStreams(self.clock)
        self.queue = Queue(self.database, settings, self.metrics, self.progress)
        self.jobs, self.thresholds = Jobs(self.queue, settings), Thresholds(self.queue, settings)
        self.sweeps = Sweeps(self.queue, settings, self.database)
        self.figures = ScenarioFigures(self.queue, settings)
        self.games = Games(
            game_table,
            self.classes,
            self.benches,
            self.engine,
            self.queue.processes,
            settings.run_workers,
            self._turn_pages,
            self.swap,
        )
        self.keeping = Keeping(self.database, settings)
        self.safety = Safety(
            self.engine,
            self.records,
            self.keeping,
            self.metrics,
            self.hub.show_status,
            self.hub.renew,
            self.checkpoints.record_hang,
        )
        self.watchdog = Watchdog(self.engine, self.safety)
        self.commands = Buckets(settings.command_rate_per_s, settings.command_burst, clock=self.clock)
        self.callers = Callers(settings.trusted_proxies)
        self.joining = Joining(self.classes, self.clock)
        self.sheets = Sheets(
            self.database,
            Shelf(self.database),
            self.classes,
            self.people,
            self.benches,
            self.engine,
            self.swap,
            self.blinds,
        )
        self.viewers = _viewers()
        self.file_turn, self.experiment_turn = asyncio.Semaphore(1), asyncio.Semaphore(1)
        self.idling = Idling(
            self.benches,
            self.engine,
            self.links,
            self._present,
            settings.idle_minutes,
            self.close_bench,
            self.experiment_turn,
        )
        self.views = Views(self.benches, self.people, self.hub, self.idling, self.viewers is not None, self.close_bench)
        self.kernels = Kernels()
        self.instruments = Instruments(settings, self.benches, self.engine)
        self.fusing = Fusing(self.benches, self.engine, self.computing)
        self.is_ready = False
        self._loop: asyncio.AbstractEventLoop | None = None

    @contextlib.asynccontextmanager
    async def running(self) -> AsyncIterator[None]:
        """Start everything, and stop it in the opposite order."""
        with found_by_benches(self.measured_records.folder):
            async with self._running():
                yield

    @contextlib.asynccontextmanager
    async def _running(self) -> AsyncIterator[None]:
        self._loop = asyncio.get_running_loop()
        await asyncio.to_thread(self.database.migrate)
        await self.recordings.recover()
        await self.measured_records.recover()
        await self.people.recover()
        await self.lesson.recover()
        await self.blinds.recover()
        await self.sheets.recover()
        self.engine.start()
        self.safety.start()
        self.watchdog.start()
        await self.kernels.start()
        await self._bring_back_seen()
        await self.queue.recover()
        await self.instruments.start()
        tasks = [asyncio.create_task(self.hub.run()), asyncio.create_task(probe(self.lag))]
        tasks.append(asyncio.create_task(self.keeping.run(self.clock)))
        lasting = (self.audit, self.checkpoints, self.classes, self.driving, self.idling, self.progress, self.sheets)
        tasks += [asyncio.create_task(part.run(self.clock)) for part in (*lasting, self.instruments)]
        tasks.append(asyncio.create_task(self.queue.warm(self._calm)))
        tasks.append(asyncio.create_task(self.computing.warm(self._calm)))
        # pyarrow, and pandas where it is installed, load with the first array: for longer than a recording may wait
        tasks.append(asyncio.create_task(asyncio.to_thread(lambda: pa.array([0.0]))))
        self.figures.start(self.kernels.compiled)
        tasks.append(asyncio.create_task(self._use_own_code()))
        tasks.append(asyncio.create_task(self.fusing.run(self.clock, self._calm)))
        self.is_ready = True
        try:
            yield
        finally:
            self.is_ready = False
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            await self.instruments.close()
            await self.kernels.stop()
            if self.viewers is not None:
                await self.viewers.close()
            await self.figures.stop()
            self.computing.close()
            await self.queue.close()
            self.sweeps.close()
            if not self.watchdog.is_stuck:  # an engine that hangs does no job
                await self.checkpoints.write()
                await self.benches.close()
            await self.safety.stop(at_once=self.watchdog.is_stuck)
            await self.audit.write()
            await asyncio.to_thread(self.watchdog.stop)
            await asyncio.to_thread(self.engine.stop)
            await asyncio.to_thread(self.database.close)

    async def _use_own_code(self) -> None:
        """Take code for this very processor once all of it is compiled, where code for its level has served so far."""
        await self.kernels.compiled()
        if borrowed:
            await self.benches.renew()

    async def close_bench(self, session: LiveBench, *, comes_back: bool = False) -> None:
        """Close a bench, its streams and its 3D view; unless it comes back, links to watch it end too."""
        await self.database.keep(*self._leaving(session, comes_back))
        await self._shut(session, comes_back)

    async def close_benches(self, sessions: Sequence[LiveBench], *changes: Change) -> None:
        """Close benches for good as something else changes: all of it, or nothing where it cannot be kept."""
        await self.database.keep(*(change for one in sessions for change in self._leaving(one)), *changes)
        for session in sessions:
            await self._shut(session)

    async def swap(self, made: LiveBench, before: Sequence[LiveBench], *changes: Change) -> None:
        """Let a bench that was just made take the place of others; where that cannot be kept, it is gone again."""
        try:
            await self.database.keep(*(change for one in before for change in self._leaving(one)), *changes)
        except BaseException:
            await self._shut(made)
            raise
        for session in before:
            await self._shut(session)

    def _leaving(self, session: LiveBench, comes_back: bool = False) -> list[Change]:
        """Return the changes as a bench closes."""
        changes = self.blinds.closing(session)
        if not comes_back:
            watchers = self.people.watchers(session.id)
            changes += [*self.lesson.forgetting(session.id), *map(self.people.removal, watchers)]
        return changes

    async def _shut(self, session: LiveBench, comes_back: bool = False) -> None:
        """Stop a bench for good, with its streams and its 3D view."""
        await self.benches.close_bench(session)
        if not comes_back:
            self.driving.forget(session.id)
        self.hub.close_bench(session.id)
        self.idling.forget(session.id)
        await self.checkpoints.forget(session.id)
        if self.viewers is not None:
            await self.viewers.drop(session.id)

    async def _turn_pages(self, session: LiveBench) -> None:
        """Let the pages of a bench come back to its present view."""
        self.hub.turn_bench(session.id)
        if self.viewers is not None:
            await self.viewers.drop(session.id)

    def _kept(self) -> list[LiveBench]:
        """List the benches that survive a crash: all but recordings that are played."""
        return [one for one in self.benches.all() if not one.replay_of]

    async def _bring_back_seen(self) -> None:
        """Bring shown or lent benches back before the first request; end the sharing of deleted benches."""
        self.driving.recover()
        for bench_id in self.people.seen_by_students():
            if not await self.student_benches.bring_back(bench_id):
                self.driving.forget(bench_id)
                await self.lesson.forget(bench_id)

    async def come_back(self, person: Person, bench_id: str) -> None:
        """Revive the bench of a request, or the bench of the student who sends it, before all benches are back."""
        wanted = bench_id or self.people.bench_of(person)
        if wanted and self.benches.find(wanted) is None and self.student_benches.may_come(wanted):
            await self.student_benches.bring_back(wanted)

    async def close_streams(self) -> None:
        """Tell every page that the server stops, and close its stream."""
        self.hub.close_all("the server is stopping")
        self.progress.close()
        await asyncio.sleep(0.1)

    async def _calm(self) -> None:
        """Wait until all kernels are compiled, and until the first page has had the processors for its bench."""
        await self.kernels.compiled()
        async with contextlib.aclosing(self.clock.every(FIRST_PAGE_S)) as beats:
            await anext(beats)

    def _present(self, bench_id: str) -> int:
        """Count the pages that watch a bench, those with its 3D view alone too."""
        return self.hub.watchers(bench_id) + (self.viewers.watchers(bench_id) if self.viewers is not None else 0)

    def _note(self, bench_id: str, person: Person, text: str) -> None:
        """Keep an action of a user about driving or watching a bench."""
        bench = self.benches.find(bench_id)
        if bench is not None:
            name = "a link to watch" if person.role == "watcher" else person.name
            class_id = person.class_id or bench.class_id
            self.audit.add(name, "driving", text, class_id, bench_id, bench.status.tick)

    def _go_without_driver(self, bench_id: str, why: str) -> None:
        """Make a bench act as its scenario defines for a lost driver."""
        bench = self.benches.find(bench_id)
        if bench is not None:
            self.engine.submit(go_without_driver, bench, why)

    def _lag(self) -> dict[str, float | bool]:
        """Return the lateness of the event loop and of the engine, and whether the engine hangs for good."""
        return {
            "is_stuck": self.watchdog.is_stuck,
            "loop_lag_ms": self.lag.p99_ms(),
            "wake_late_ms": self.engine.lateness.p99_ms(),
        }

    def _after_round(self) -> None:
        """Let the event loop publish the round of the engine; called on the engine thread."""
        loop = self._loop
        if loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop may be closing
                loop.call_soon_threadsafe(self.hub.publish)


def _viewers() -> Viewers | None:
    """Return the 3D views, if their folder exists."""
    if importlib.util.find_spec("server.view3d") is None:
        return None
    from server.view3d.viewers import Viewers

    return Viewers()
