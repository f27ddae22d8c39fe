"""All open streams: who watches what, when to wake them, when to let one go."""

from __future__ import annotations

import asyncio
import time
from collections import defaultdict
from collections.abc import Callable
from itertools import count
from typing import Any

from server.bench.portrait import document_now
from server.bench.session import Session
from server.bench.status import BenchStatus
from server.errors import ApiError
from server.metrics import Metrics
from server.settings import Settings
from server.stream.client import Client
from server.stream.cuts import SharedCuts
from server.stream.wire import Notice, Status

STATUS_S = 0.2
CLOSE_SLOW, CLOSE_FULL, CLOSE_GONE, CLOSE_NO_BENCH = 4408, 1013, 1001, 4404


class Hub:
    """Wakes clients at the frame rate, at events, and five times a second for the status.

    Parameters
    ----------
    settings : Settings
        Limits and frame rate.
    metrics : Metrics
        Where streams are counted.
    lateness : callable
        Returns the fields of a status that say how late the service is.
    """

    def __init__(self, settings: Settings, metrics: Metrics, lateness: Callable[[], dict[str, Any]]) -> None:
        self._settings, self._metrics, self._lateness = settings, metrics, lateness
        self._texts: dict[tuple[str, bool], tuple[BenchStatus, str]] = {}
        self._numbers = count(1)
        self._clients: dict[str, set[Client]] = defaultdict(set)
        self._heads: dict[str, tuple[int, int]] = {}
        self._cuts: dict[str, SharedCuts] = {}
        self._next_frame = 0.0

    def __len__(self) -> int:
        return sum(len(clients) for clients in self._clients.values())

    def watchers(self, bench_id: str) -> int:
        """Count the open streams of a bench."""
        return len(self._clients.get(bench_id, ()))

    def check_room(self, bench_id: str) -> None:
        """Refuse one stream too many.

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

    def add(self, client: Client) -> None:
        """Take a stream in, and give it a number people can tell it by."""
        client.name = f"page {next(self._numbers)}"
        self._clients[client.session.id].add(client)
        self._metrics.clients.set(len(self))

    def remove(self, client: Client) -> None:
        """Let a stream go."""
        clients = self._clients.get(client.session.id, set())
        clients.discard(client)
        if not clients:
            self._clients.pop(client.session.id, None)
            self._heads.pop(client.session.id, None)
            self._cuts.pop(client.session.id, None)
            for with_parameters in (False, True):
                self._texts.pop((client.session.id, with_parameters), None)
        self._metrics.clients.set(len(self))

    def cuts(self, session: Session) -> SharedCuts:
        """Return the history of a bench as all its pages see it."""
        return self._cuts.setdefault(session.id, SharedCuts(session))

    def publish(self) -> None:
        """Wake who has something new to see; called on the loop after every round of the engine."""
        now = time.monotonic()
        frame_due = now >= self._next_frame
        if frame_due:
            # A quarter period of slack: rounds and frames are not in phase.
            self._next_frame = now + 0.75 / self._settings.frame_rate_hz
        for bench_id, clients in self._clients.items():
            session = next(iter(clients)).session
            head, last = self._heads.get(bench_id, (-1, -1))
            # a bench that stands still has no later round that would show where it came to
            due = frame_due or not session.is_running
            new_head = self._cuts[bench_id].refresh() if due else head
            new_last = session.events.last
            for client in clients:
                if new_last != last:
                    client.offer_events()
                    client.offer_status()
                if new_head != head:
                    client.offer_frame()
            self._heads[bench_id] = (new_head, new_last)

    def close_bench(self, bench_id: str) -> None:
        """Close the streams of a bench that is gone."""
        for client in list(self._clients.get(bench_id, ())):
            client.close(CLOSE_NO_BENCH, "the bench was closed")

    def close_all(self, reason: str) -> None:
        """Close every stream: the server goes."""
        for clients in list(self._clients.values()):
            for client in list(clients):
                client.post(Notice(code="shutdown", message=reason))
                client.close(CLOSE_GONE, reason)

    def around(self, session: Session) -> dict[str, Any]:
        """Return the fields of a status that the bench itself does not know."""
        return {"watchers": self.watchers(session.id), **self._lateness()}

    def describe(self, session: Session, with_parameters: bool, dropped: int) -> str:
        """Return the status message of a bench; all its watchers share all but one number."""
        key, status = (session.id, with_parameters), session.status
        known = self._texts.get(key)
        if known is None or known[0] is not status:
            message = Status(
                **{**dict(status), **self.around(session)},
                parameters=document_now(session) if with_parameters else None,
                dropped_frames=-1,
            )
            known = (status, message.model_dump_json())
            self._texts[key] = known
        return known[1].replace('"dropped_frames":-1', f'"dropped_frames":{dropped}')

    async def run(self) -> None:
        """Offer the status, let stalled clients go."""
        while True:
            due = time.monotonic() + STATUS_S
            await asyncio.sleep(STATUS_S)
            for clients in list(self._clients.values()):
                for client in list(clients):
                    # As of when it was due: a loop that stood still has not read yet what pages took meanwhile.
                    if client.stalled(due):
                        self._metrics.streams_closed.labels("stalled").inc()
                        client.close(CLOSE_SLOW, "nothing was taken for 5 s")
                    else:
                        client.offer_status()
