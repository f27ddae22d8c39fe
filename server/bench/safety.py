"""Takes care of benches when the engine hangs: safe outputs, a recording of the last seconds, an end for a stuck one.

Only the engine changes a bench. So the status shows the trip at once, and the outputs go to their safe values by a
command, at the present tick of the bench and before any other tick: the run repeats with the same bits.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import math
from collections.abc import Awaitable, Callable, Sequence

from core.board.commands import MakeSafe, Trip
from core.errors import InputError
from server.bench.engine import Engine, Workload
from server.bench.recording import Records
from server.bench.recordings import Wanted
from server.bench.session import Session
from server.errors import ApiError
from server.metrics import Metrics
from server.store.keeping import Keeping

log = logging.getLogger(__name__)

KEPT_S = 2.0
"""Wall time before a trip that a recording keeps."""
MOST_KEPT = 8
"""Most such recordings at a time; the other benches have that time in their history as long as they are live."""


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
    close_bench : callable
        Closes a bench and its streams.
    """

    def __init__(
        self,
        engine: Engine,
        records: Records,
        keeping: Keeping,
        metrics: Metrics,
        show: Callable[[Sequence[Session]], None],
        close_bench: Callable[[Session], Awaitable[None]],
    ) -> None:
        self._engine, self._records, self._keeping, self._metrics = engine, records, keeping, metrics
        self._show, self._close_bench = show, close_bench
        self._loop: asyncio.AbstractEventLoop | None = None
        self._tasks: set[asyncio.Task[None]] = set()

    def start(self) -> None:
        """Begin, on the event loop that serves the pages."""
        self._loop = asyncio.get_running_loop()

    async def stop(self) -> None:
        """Wait for recordings under way."""
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def hung(self, running: Sequence[Workload], held: Sequence[str], why: str) -> None:
        """Take benches to safe outputs; on the thread of the watchdog."""
        sessions = sorted(_with_outputs(running), key=lambda one: one.id not in held)
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

    def given_up(self, benches: Sequence[Workload]) -> None:
        """Close benches in whose slices the engine hangs; on the thread of the watchdog."""
        for session in benches:
            if isinstance(session, Session):
                self._engine.interrupt(lambda one=session: _shut(one))  # type: ignore[misc]
                self._on_loop(lambda one=session: self._begin(self._end(one)))  # type: ignore[misc]
                log.error("bench %s hangs and is closed", session.id)

    def _on_loop(self, function: Callable[[], None]) -> None:
        """Let the event loop do something."""
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop may be closing
                self._loop.call_soon_threadsafe(function)

    def _begin(self, coming: Awaitable[None]) -> None:
        task = asyncio.ensure_future(coming)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _keep(self, sessions: Sequence[Session], why: str) -> None:
        """Record the last seconds of some benches, except where a fault is hidden, because a file would reveal it."""
        kept = [one for one in sessions if one.hiding.view is None and one.history.end_tick > one.history.first_tick]
        for session in kept[:MOST_KEPT]:
            try:
                wanted = Wanted(name=f"before the trip: {why}"[:100], past_ticks=_ticks(session), ticks=0)
                await self._records.begin(session, wanted, "board", await self._keeping.room())
            except ApiError as error:
                log.warning("the last seconds of bench %s are not kept: %s", session.id, error.body.message)
            except Exception:
                log.exception("the last seconds of bench %s are not kept", session.id)

    async def _end(self, session: Session) -> None:
        """Close a bench once its last seconds are kept."""
        others = self._tasks - {asyncio.current_task()}
        if others:
            await asyncio.wait(others)
        try:
            await self._close_bench(session)
        except Exception:
            log.exception("bench %s could not be closed", session.id)


def show_trip(session: Session, reason: str) -> None:
    """Show in the status of a bench that it has tripped, although the bench itself cannot be changed now."""
    if session.status.trip is None:
        tick = session.board.tick
        trip = Trip(tick=tick, time_ms=tick * session.dt_ms, reason=reason, signal="", value=None)
        session.status = session.status.model_copy(update={"state": "tripped", "trip": trip})


def make_safe(session: Session, reason: str) -> None:
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


def _shut(session: Session) -> None:
    """Refuse all further commands to a bench (urgent)."""
    session.close()
    show_trip(session, "the bench hung and was closed")


def _with_outputs(benches: Sequence[Workload]) -> list[Session]:
    """Return the benches that have outputs: a recording that is played has none."""
    return [bench for bench in benches if isinstance(bench, Session) and not bench.replay_of]


def _reason(session: Session, held: Sequence[str], why: str) -> str:
    """Return why a bench trips, in words."""
    held_up = ""
    if session.id in held:
        held_up = ", in a tick of this bench"
    elif held:
        held_up = f", held up by bench {held[0]}"
    return f"{why}{held_up}; outputs were taken to safe values"


def _ticks(session: Session) -> int:
    """Return the ticks of the last seconds."""
    status = session.status
    scale = max(status.achieved_scale, status.time_scale or 0.0)
    return min(session.history.capacity, max(1, math.ceil(KEPT_S * scale * 1e3 / session.dt_ms)))
