"""All pages that see the same of one bench, and the news for them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from server.bench.bench import Seen
from server.stream.client import Client
from server.stream.cuts import SharedCuts
from server.stream.news import News

STATUS_S = 0.05
"""The status follows an event at once, but not more often than this."""


PAGES_AT_ONCE = 25
"""Pages served before the event loop may do something else; each takes it some 20 us."""


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
        self._head = self._last = self._status_event = -1
        self._behind: list[tuple[tuple[int, int], ...]] = []
        self._status_at = 0.0

    def publish(self, now: float) -> Iterator[None]:
        """Offer every page the news; pause between groups of pages."""
        head, last = self.cuts.refresh(), self.session.events.last
        self.cuts.gather()
        status = last != self._status_event and now - self._status_at >= STATUS_S
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
