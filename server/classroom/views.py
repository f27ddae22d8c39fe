"""Views: the benches as each person may see them."""

from __future__ import annotations

import logging
from collections.abc import Awaitable, Callable

from server.bench.bench import LiveBench, Seen
from server.bench.benches import Benches
from server.bench.idling import Idling
from server.bench.status import Bench
from server.classroom.hiding import refusal
from server.classroom.people import People
from server.paging import ListPage, by_age
from server.security.person import Person
from server.stream.hub import Hub

log = logging.getLogger(__name__)


class Views:
    """Describes benches to people.

    Parameters
    ----------
    benches : Benches
        The live benches.
    people : People
        Knows which bench is whose.
    hub : Hub
        Holds the users with an open page of each bench.
    idling : Idling
        Knows how long a bench stays.
    has_3d : bool
        Whether benches have a 3D view.
    close_bench : callable
        Closes a bench and its streams.
    """

    def __init__(
        self,
        benches: Benches,
        people: People,
        hub: Hub,
        idling: Idling,
        has_3d: bool,
        close_bench: Callable[[LiveBench], Awaitable[None]],
    ) -> None:
        self._benches, self._people, self._hub, self._idling = benches, people, hub, idling
        self._has_3d, self._close_bench = has_3d, close_bench

    def seen(self, session: LiveBench, person: Person) -> Seen:
        """Return a bench as a person may see it: a teacher sees all of the bench of a student, others its view."""
        view = session.view
        return session if view is None or (session.class_id and person.is_teacher) else view

    def is_blind(self, person: Person, bench_id: str) -> bool:
        """Whether a fault is hidden from a person, on the bench in the path or on the bench of a student."""
        session = self._benches.find(bench_id or self._people.bench_of(person))
        return session is not None and self.seen(session, person) is not session

    def whole(self, bench_id: str, person: Person) -> LiveBench:
        """Return a bench that a person may see completely, or refuse."""
        if self.is_blind(person, bench_id):
            raise refusal()
        return self._benches.get(bench_id)

    def of(self, session: LiveBench, person: Person) -> Bench:
        """Describe a bench as a person may see it."""
        view3d = f"/benches/{session.id}/3d/" if self._has_3d else None
        bench = self.seen(session, person).describe(self._hub.around(session), view3d)
        return bench.model_copy(update={"let_go_in_s": self._idling.left_s(session)})

    def all(self, person: Person, page: ListPage) -> list[Bench]:
        """Describe the benches outside classes, oldest first; a bench that cannot be described hides no others."""
        descriptions = []
        for session in page.cut((one for one in self._benches.all() if not one.class_id), by_age):
            try:
                descriptions.append(self.of(session, person))
            except Exception:
                log.exception("bench %s cannot be described", session.id)
        return descriptions

    async def opened(self, session: LiveBench, person: Person) -> Bench:
        """Describe a bench just made; a bench that cannot be described is closed again."""
        try:
            return self.of(session, person)
        except Exception:
            await self._close_bench(session)
            raise
