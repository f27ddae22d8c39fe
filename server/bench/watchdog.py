"""The watchdog over the engine: it watches from a thread of its own, and acts when the engine shows no activity.

It adds up silence: the time after a round was due in which the threads of the engine neither ran nor waited for a
processor. A look that comes late counts little, because a busy machine delays the looks too. Benches that ran are taken
to safe outputs, once for each silence; such a trip may be false. Without progress for longer, the server has to be
restarted.

Only the engine changes a bench. So the status shows the trip at once, and the outputs go to their safe values by a
command, at the present tick of the bench and before any other tick: the run repeats with the same bits.
"""

from __future__ import annotations

import asyncio
import contextlib
import faulthandler
import logging
import math
import sys
import tempfile
import threading
import time
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path

from core.board.commands import MakeSafe, Trip
from core.errors import InputError
from core.format import format_short
from server.bench.bench import LiveBench
from server.bench.engine import Engine
from server.bench.recording import RecordingControl, Wanted
from server.errors import ApiError
from server.metrics import Metrics
from server.store.keeping import Keeping

log = logging.getLogger(__name__)

LOOK_S = 0.0125
LATE_S = 4 * LOOK_S
"""A look after this time is late: the machine is busy, or was suspended."""
LATE_COUNTS_S = 0.1 * LOOK_S
"""Silence that a late look counts."""
SILENT_S = 0.1
"""Silence after which the engine hangs."""
STUCK_S = 30.0
"""Time without progress, silent or at work, after which the server has to be restarted."""
AT_WORK = ("llvmlite", "importlib", "_frozen_importlib", "_frozen_importlib_external", "pyarrow")
"""Packages in which a thread sleeps while another works for it: it compiles, imports or reads a file."""
KEPT_S = 2.0
"""Wall time before a trip that a recording keeps."""
MOST_KEPT = 8
"""Most such recordings at a time; the other benches have that time in their history as long as they are live."""


class Watchdog:
    """Looks at the engine again and again.

    Parameters
    ----------
    engine : Engine
        The engine.
    safety : Safety
        Takes care of the benches.
    activity : Activity, optional
        Measures the work of the threads of the engine.
    """

    def __init__(self, engine: Engine, safety: Safety, activity: Activity | None = None) -> None:
        self._engine, self._safety, self._activity = engine, safety, activity or Activity()
        self._looked = self._expected = engine.clock()
        self._silent_s = self._idle_s = 0.0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="combbench-watchdog", daemon=True)
        self.barks = False
        """Whether the engine hangs."""
        self.is_stuck = False
        """Whether the server has to be restarted."""

    def start(self) -> None:
        """Look from now on."""
        self._thread.start()

    def stop(self) -> None:
        """Look no longer."""
        self._ended.set()
        self._thread.join(timeout=5.0)

    @property
    def is_alive(self) -> bool:
        """Whether it looks."""
        return self._thread.is_alive()

    def look(self) -> None:
        """Look once."""
        engine, now = self._engine, self._engine.clock()
        passed, self._looked = now - self._looked, now
        counts = passed if passed < LATE_S else LATE_COUNTS_S
        if engine.has_ended:
            self._bark("the engine broke off")
            return self._get_stuck()
        expected = engine.expected
        if expected != self._expected or now <= expected:
            self._expected = expected
            return self._calm()
        worked_s = self._activity.measure(engine.threads)
        self._silent_s = 0.0 if worked_s else self._silent_s + counts
        if worked_s != math.inf:
            self._idle_s += min(worked_s or counts, counts)
        if self._silent_s >= SILENT_S:
            self._bark(f"the engine gave no sign for {format_short(now - expected, 's', 2)}")
        if self._idle_s >= STUCK_S:
            self._bark(f"the engine has made no progress for {format_short(now - expected, 's', 2)}")
            self._get_stuck()

    def _run(self) -> None:
        while not self._ended.wait(LOOK_S):
            try:
                self.look()
            except Exception:
                log.exception("the watchdog could not look at the engine; it is tried again")

    def _calm(self) -> None:
        self._silent_s = self._idle_s = 0.0
        if self.barks:
            self.barks = self.is_stuck = False
            self._safety.recovered()
            log.warning("the engine turns again")

    def _bark(self, why: str) -> None:
        """Take running benches to safe outputs, once for each time that the engine hangs."""
        if self.barks:
            return
        self.barks = True
        running, held = self._engine.running, [work.id for work in self._engine.held]
        if running:
            self._safety.hung(running, held, why)
        log.error("%s; benches that ran: %d; stacks of all threads:\n%s", why, len(running), _stacks())

    def _get_stuck(self) -> None:
        """Say once that the server has to be restarted."""
        if self.is_stuck:
            return
        self.is_stuck = True
        held = [work.id for work in self._engine.held]
        log.critical("the engine hangs for good: restart the server; benches in hand: %s", ", ".join(held) or "none")
        self._safety.stuck(held)


class Activity:
    """Measures the work of threads by their clocks."""

    def __init__(self) -> None:
        self._clocks: dict[int, float] = {}

    def measure(self, threads: Sequence[threading.Thread]) -> float:
        """Return the processor time of threads since the last look, s.

        It is infinite where a thread waits for a compilation, a processor or a disk: on two processors that a browser
        fills, the engine has waited for more than 100 ms. Where a system has no clock of a thread, its threads are at
        work.
        """
        if not hasattr(time, "pthread_getcpuclockid") or _wait_for_others([thread.ident or 0 for thread in threads]):
            return math.inf
        before, self._clocks = self._clocks, {}
        for thread in threads:
            if (number := thread.ident) is not None and thread.is_alive():
                self._clocks[number] = time.clock_gettime(time.pthread_getcpuclockid(number))
        worked_s = sum(now - before.get(number, now) for number, now in self._clocks.items())
        return math.inf if worked_s == 0.0 and any(map(_is_ready, threads)) else worked_s


def _is_ready(thread: threading.Thread) -> bool:
    """Whether a thread waits for a processor or a disk, as far as the system tells."""
    try:
        stat = Path(f"/proc/self/task/{thread.native_id}/stat").read_text()
    except OSError:  # another system, or it has just ended
        return False
    return stat.rpartition(") ")[2][:1] in ("R", "D")


def _wait_for_others(numbers: Sequence[int]) -> bool:
    """Whether one of these threads is inside a package whose other threads work for it."""
    frames = sys._current_frames()
    for number in numbers:
        frame = frames.get(number)
        while frame is not None:
            if str(frame.f_globals.get("__name__", "")).partition(".")[0] in AT_WORK:
                return True
            frame = frame.f_back
    return False


def _stacks() -> str:
    """Return the stacks of all threads."""
    with tempfile.TemporaryFile() as file:
        faulthandler.dump_traceback(file, all_threads=True)
        file.seek(0)
        return file.read().decode(errors="replace")


class Safety:
    """Takes benches to safe outputs that ran when the engine hung.

    Parameters
    ----------
    engine : Engine
        Whose thread changes a bench.
    records : Records
        Records the last seconds.
    keeping : Keeping
        Knows the room for recordings.
    metrics : Metrics
        Where it is counted.
    show : callable
        Sends the status of some benches to their pages; called on the event loop.
    renew : callable
        Renews the status of every bench; called on the event loop.
    record : callable
        Records a bench that is not brought back after a restart.
    """

    def __init__(
        self,
        engine: Engine,
        records: RecordingControl,
        keeping: Keeping,
        metrics: Metrics,
        show: Callable[[Sequence[LiveBench]], None],
        renew: Callable[[], None],
        record: Callable[[str], None],
    ) -> None:
        self._engine, self._records, self._keeping, self._metrics = engine, records, keeping, metrics
        self._show, self._renew, self._record = show, renew, record
        self._loop: asyncio.AbstractEventLoop | None = None
        self._tasks: set[asyncio.Task[None]] = set()

    def start(self) -> None:
        """Begin, on the event loop that serves the pages."""
        self._loop = asyncio.get_running_loop()

    async def stop(self, *, at_once: bool) -> None:
        """Wait for recordings under way, or give them up because the engine does no job."""
        for task in self._tasks if at_once else ():
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def hung(self, running: Sequence[LiveBench], held: Sequence[str], why: str) -> None:
        """Take benches to safe outputs; on the thread of the watchdog."""
        with_outputs = [bench for bench in running if not bench.replay_of]
        sessions = sorted(with_outputs, key=lambda one: one.id not in held)
        reasons = {session: _reason(session, held, why) for session in sessions}
        for session, reason in reasons.items():
            show_trip(session, reason)

        def make_all_safe() -> None:
            for session, reason in reasons.items():
                make_safe(session, reason)

        if sessions:
            self._engine.interrupt(make_all_safe)
            self._metrics.watchdog_trips.inc()
            self._on_loop(lambda: self._show(sessions))
            self._on_loop(lambda: self._begin(self._keep(sessions, why)))

    def stuck(self, held: Sequence[str]) -> None:
        """Record the benches in whose slices the engine hangs for good; on the thread of the watchdog."""
        self._on_loop(self._renew)
        for bench_id in held:
            self._record(bench_id)

    def recovered(self) -> None:
        """Show that the engine turns again; on the thread of the watchdog."""
        self._on_loop(self._renew)

    def _on_loop(self, function: Callable[[], None]) -> None:
        """Let the event loop do something."""
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop may be closing
                self._loop.call_soon_threadsafe(function)

    def _begin(self, coming: Awaitable[None]) -> None:
        task = asyncio.ensure_future(coming)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _keep(self, sessions: Sequence[LiveBench], why: str) -> None:
        """Record the last seconds of some benches, except where a view hides a part: a file would reveal it."""
        kept = [one for one in sessions if one.view is None and one.history.end_tick > one.history.first_tick]
        for session in kept[:MOST_KEPT]:
            try:
                wanted = Wanted(name=f"before the trip: {why}"[:100], past_ticks=_ticks(session), ticks=0)
                await self._records.begin(session, wanted, "board", await self._keeping.room())
            except ApiError as error:
                log.warning("the last seconds of bench %s are not kept: %s", session.id, error.body.message)
            except Exception:
                log.exception("the last seconds of bench %s are not kept", session.id)


def show_trip(session: LiveBench, reason: str) -> None:
    """Show in the status of a bench that it has tripped, although the bench itself cannot be changed now."""
    if session.status.trip is None:
        tick = session.board.tick
        trip = Trip(tick=tick, time_ms=tick * session.dt_ms, reason=reason, signal="", value=None)
        session.status = session.status.model_copy(update={"state": "tripped", "trip": trip})


def make_safe(session: LiveBench, reason: str) -> None:
    """Take the outputs of a bench to their safe values at its present tick (urgent)."""
    try:
        if session.board.trip is None:
            session.execute(MakeSafe(make_safe=reason), "board")
        else:
            session.refresh_status()
    except (ApiError, InputError) as error:
        log.warning("bench %s is not taken to safe outputs: %s", session.id, error)
    except Exception as error:
        log.exception("bench %s could not be taken to safe outputs", session.id)
        session.fail(error)


def _reason(session: LiveBench, held: Sequence[str], why: str) -> str:
    """Return why a bench trips, in words."""
    held_up = ""
    if session.id in held:
        held_up = ", in a tick of this bench"
    elif held:
        held_up = f", held up by bench {held[0]}"
    return f"{why}{held_up}; outputs were taken to safe values"


def _ticks(session: LiveBench) -> int:
    """Return the ticks of the last seconds."""
    status = session.status
    scale = max(status.achieved_scale, status.time_scale or 0.0)
    return min(session.history.capacity, max(1, math.ceil(KEPT_S * scale * 1e3 / session.dt_ms)))
