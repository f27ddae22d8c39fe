"""All open streams, room by room: the hub counts them, sets their pace, offers them news, and closes stalled ones."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable, Iterator, Sequence
from itertools import chain, count
from typing import Any

from server.bench.bench import Seen
from server.bench.status import Company
from server.errors import ApiError
from server.metrics import Metrics
from server.security.person import Person
from server.settings import Settings
from server.stream.client import CLOSE_SLOW, Client
from server.stream.cuts import SharedCuts
from server.stream.news import News
from server.stream.wire import Notice, Ping

log = logging.getLogger(__name__)

STATUS_S, EVENT_STATUS_S = 0.2, 0.05
"""The status comes five times a second, and at once after an event, but not more often than this."""
PAGES_AT_ONCE = 25
"""Pages served before the event loop may do something else; each takes it some 20 us."""
CLOSE_FULL, CLOSE_GONE, CLOSE_NO_BENCH, CLOSE_TURNED = 1013, 1001, 4404, 4205
SLACK = 0.25
"""Share of a period a picture may come early: it follows a round of the engine, and rounds have their own period."""

BUSY = 0.5
"""Share of its time the event loop may work; above it commands wait too long behind pictures."""

SLOWEST_S = 0.2
OVER_S = 0.25
"""Time over which the work of the loop is measured."""


class Pace:
    """The period of pictures, chosen so that the event loop is busy for a given share of its time at most.

    Pictures cost in proportion to their rate and are nearly all the work of a busy loop. The period is therefore
    stretched by the ratio of the load of the loop to `BUSY`, and shrinks again in the same way.

    Parameters
    ----------
    rate_hz : float
        Pictures per second when there is time for them.
    clock : callable
        Seconds the calling thread has worked.
    """

    def __init__(self, rate_hz: float, clock: Callable[[], float] = time.thread_time) -> None:
        self._wanted_s = self.period_s = 1.0 / rate_hz
        self._clock = clock
        self._next = 0.0
        self._since: tuple[float, float] | None = None

    def is_due(self, now: float) -> bool:
        """Return whether it is time for a picture."""
        return now >= self._next

    def wait_s(self, now: float) -> float:
        """Return how long it is until a picture is late: rounds that come before that are in time to send it."""
        return max(self._next + SLACK * self.period_s - now, 0.0)

    def begin(self, now: float) -> None:
        """Note that pictures are sent now."""
        worked = self._clock()
        if self._since is None:
            self._since = (now, worked)
        elif (passed := now - self._since[0]) >= OVER_S:
            busy = (worked - self._since[1]) / passed
            stretch = min(max(busy / BUSY, 0.8), 1.5)
            self.period_s = min(max(self.period_s * stretch, self._wanted_s), SLOWEST_S)
            self._since = (now, worked)
        self._next = now + (1.0 - SLACK) * self.period_s


class Room:
    """The pages that watch a bench.

    Parameters
    ----------
    session : LiveBench or View
        The bench as they see it.
    around : callable
        Returns the fields of a status that the bench itself does not know.
    """

    def __init__(self, session: Seen, around: Callable[[], dict[str, Any]]) -> None:
        self.session = session
        self.clients: set[Client] = set()
        self.cuts = SharedCuts(session)
        self.news = News(session, around)
        self._scenario = session.scenario_id
        self._head = self._last = self._status_event = -1
        self._behind: list[tuple[tuple[int, int], ...]] = []
        self._status_at = 0.0

    def publish(self, now: float) -> Iterator[None]:
        """Offer every page the news; pause between groups of pages."""
        if self.session.scenario_id != self._scenario:  # no status carries title, interval and blocks of another one
            self._scenario = self.session.scenario_id
            self.turn()
        head, last = self.cuts.refresh(), self.session.events.last
        self.cuts.gather()
        status = last != self._status_event and now - self._status_at >= EVENT_STATUS_S
        if status:
            self._status_event, self._status_at = last, now
        behind = self.cuts.behind
        frame = head != self._head or behind != self._behind
        new = {"events": last != self._last, "frame": frame, "status": status}
        self._head, self._last, self._behind = head, last, behind
        if any(new.values()):
            for served, client in enumerate(list(self.clients), 1):
                client.offer(**new)
                if served % PAGES_AT_ONCE == 0:
                    yield

    def turn(self) -> None:
        """Close the streams, because another bench is to be seen; its pages come back at once."""
        for client in list(self.clients):
            client.close(CLOSE_TURNED, "the visible part of the bench has changed")


class Hub:
    """Sends news at the frame rate, and the status five times a second.

    Parameters
    ----------
    settings : Settings
        Limits and frame rate.
    metrics : Metrics
        Where streams are counted.
    lateness : callable
        Returns the fields of a status for the lag of the service.
    clock : callable
        Seconds, by which a stream counts as stalled; pictures keep to the time of the event loop.
    """

    def __init__(
        self,
        settings: Settings,
        metrics: Metrics,
        lateness: Callable[[], dict[str, Any]],
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._settings, self._metrics, self._lateness, self.clock = settings, metrics, lateness, clock
        self._numbers = count(1)
        self._rooms: dict[Seen, Room] = {}
        self._pace = Pace(settings.frame_rate_hz)
        self.company: Callable[[str], Company | None] = lambda _bench_id: None
        """Returns the users of a bench."""
        self._later: asyncio.TimerHandle | None = None
        self._showing: Iterator[None] | None = None

    def __len__(self) -> int:
        return sum(len(room.clients) for room in self._rooms.values())

    def watchers(self, bench_id: str) -> int:
        """Count the open streams of a bench."""
        return sum(len(room.clients) for seen, room in self._rooms.items() if seen.id == bench_id)

    def check_room(self, bench_id: str) -> None:
        """Refuse a new stream if a limit is reached.

        Raises
        ------
        ApiError
            Saying which limit is reached.
        """
        if len(self) >= self._settings.max_clients:
            raise ApiError(503, "too_many_clients", f"{len(self)} streams are open, the limit (max_clients)")
        if self.watchers(bench_id) >= self._settings.max_clients_per_bench:
            text = f"{self.watchers(bench_id)} streams of this bench are open, the limit (max_clients_per_bench)"
            raise ApiError(503, "too_many_clients", text)

    def room(self, session: Seen) -> Room:
        """Return the room of the users with the same view of a bench."""
        if session not in self._rooms:
            self._rooms[session] = Room(session, lambda: self.around(session))
        return self._rooms[session]

    def add(self, client: Client) -> None:
        """Add a stream, and give it a number that people know it by."""
        client.name = f"page {next(self._numbers)}"
        self.room(client.session).clients.add(client)
        self._metrics.clients.set(len(self))

    def remove(self, client: Client) -> None:
        """Remove a stream."""
        room = self._rooms[client.session]
        room.clients.discard(client)
        client.panels.clear()  # at once, not at the next collection: their views would continue to find captures
        if not room.clients:
            del self._rooms[client.session]
        self._metrics.clients.set(len(self))

    def publish(self) -> None:
        """Send news if a picture is due; called on the event loop after every round of the engine."""
        loop = asyncio.get_running_loop()
        now = loop.time()
        if self._showing is not None or not self._pace.is_due(now):
            # A paused bench has no later round, so its last picture is sent by a timer.
            if self._later is None:
                wait_s = self._pace.period_s if self._showing is not None else self._pace.wait_s(now)
                self._later = loop.call_later(wait_s, self._show)
            return
        self._show()

    def _show(self) -> None:
        """Send news to all pages."""
        if self._later is not None:
            self._later.cancel()
            self._later = None
        if self._showing is None:
            now = asyncio.get_running_loop().time()
            self._pace.begin(now)
            self._showing = chain.from_iterable(room.publish(now) for room in list(self._rooms.values()))
            self._go_on()

    def _go_on(self) -> None:
        """Serve some pages, then let the event loop do other work."""
        assert self._showing is not None
        try:
            for _ in self._showing:
                asyncio.get_running_loop().call_soon(self._go_on)
                return
        except Exception:
            log.exception("pictures of a bench could not be sent")
        self._showing = None

    async def capture(self, session: Seen) -> None:
        """Capture all that triggers of a bench have met by now."""
        room = self._rooms.get(session)
        if room is not None:
            room.cuts.refresh()
            for _ in iter(room.cuts.gather, False):
                await asyncio.sleep(0)

    def close_bench(self, bench_id: str) -> None:
        """Close the streams of a bench that is gone."""
        for client in self._all(bench_id):
            client.close(CLOSE_NO_BENCH, "the bench was closed")

    def turn_bench(self, bench_id: str) -> None:
        """Close the streams of a bench whose view has changed; its pages come back at once."""
        for seen, room in self._rooms.items():
            if seen.id == bench_id:
                room.turn()

    def close_all(self, reason: str) -> None:
        """Close every stream because the server stops."""
        for client in self._all():
            client.post(Notice(code="shutdown", message=reason))
            client.close(CLOSE_GONE, reason)

    def around(self, session: Seen) -> dict[str, Any]:
        """Return the fields of a status that the bench itself does not know."""
        return {"watchers": self.watchers(session.id), "company": self.company(session.id), **self._lateness()}

    def ask(self, bench_id: str, person: Person) -> None:
        """Ask the pages of a person at a bench to answer."""
        for client in self._all(bench_id):
            if client.person.id == person.id:
                client.post(Ping())

    def tell(self, bench_id: str) -> None:
        """Make the next status of a bench, which all its pages get soon, a new one; also while it is paused."""
        for seen, room in self._rooms.items():
            if seen.id == bench_id:
                room.news.renew()

    def show_status(self, benches: Sequence[Seen]) -> None:
        """Send the status of some benches now."""
        for session in benches:
            for client in self._all(session.id):
                client.offer(status=True)

    def renew(self) -> None:
        """Make the next status of every bench a new one, because the state of the server has changed."""
        for room in self._rooms.values():
            room.news.renew()

    def call(self, people: list[Person]) -> None:
        """Tell all pages of some persons to read their present rights."""
        ids = {person.id for person in people}
        for client in self._all():
            if client.person.id in ids:
                client.post(Notice(code="ask_me", message="what you see or may do has changed"))

    def pages_of(self, person: Person) -> int:
        """Count the open streams of a person."""
        return sum(client.person.id == person.id for client in self._all())

    async def run(self) -> None:
        """Offer the status, and close stalled streams."""
        while True:
            due = self.clock() + STATUS_S
            await asyncio.sleep(STATUS_S)
            for room in self._rooms.values():
                room.cuts.gather()  # of a paused bench, too
            for client in self._all():
                # The time due counts: a loop that stood still has not read the acknowledgements of that time yet.
                if client.stalled(due):
                    self._metrics.streams_closed.labels("stalled").inc()
                    client.close(CLOSE_SLOW, "nothing was taken for 5 s")
                else:
                    client.offer(status=True)

    def _all(self, bench_id: str | None = None) -> Iterator[Client]:
        """Go through the streams, of one bench or of all; they may close meanwhile."""
        rooms = [room for seen, room in self._rooms.items() if bench_id in (None, seen.id)]
        yield from [client for room in rooms for client in room.clients]
