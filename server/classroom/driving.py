"""Who drives each bench: by a lease, as soon as two who may drive it have it open.

A lease belongs to a person, not to a page. It lasts as long as a page of the person answers the server, or a command of
the person comes; after that the bench is free, and acts as its scenario defines for a bench without a driver.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable

from core.board.commands import MakeSafe
from server.bench.bench import LiveBench
from server.bench.status import Company, Somebody
from server.classroom.access import Need
from server.classroom.lease import LEASE_S, Lease, Pages, Presence
from server.classroom.people import People
from server.clock import Clock
from server.errors import ApiError
from server.security.person import TEACHER, Person

log = logging.getLogger(__name__)

LOOK_S = 1.0
"""Between two questions to the pages of drivers."""
COMING_S = 10.0
"""How long a student who was handed a bench may take to come."""
MOST_NAMES = 12
"""Names of watching users in the message to every page."""

Note = Callable[[str, Person, str], None]


class Driving:
    """The leases of all benches; on the event loop.

    Parameters
    ----------
    people : People
        Knows the permitted drivers of each bench.
    pages : Pages
        The pages that people have open.
    note : callable
        Keeps an action on a bench, in words; with the bench and the person.
    lost : callable
        Makes a bench act without a driver; with the bench and the reason.
    clock : callable
        Monotonic seconds.
    """

    def __init__(
        self,
        people: People,
        pages: Pages,
        note: Note,
        lost: Callable[[str, str], None],
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._people, self._pages, self._note, self._lost, self._clock = people, pages, note, lost, clock
        self._leases: dict[str, Lease] = {}
        self._presence = Presence()
        self._looked = clock()

    def recover(self) -> None:
        """Let students with a lent bench continue to drive it, if they come."""
        for student in self._people.students():
            if bench_id := self._people.lent_to(student):
                lease = self._leases[bench_id] = Lease(driver=student, lent_by=TEACHER.id)
                lease.renew(self._clock() + COMING_S)

    def come(self, bench_id: str, person: Person) -> None:
        """Note that a page of a person shows a bench from now on."""
        if self._presence.come(bench_id, person) and len(self._presence.of(bench_id)) > 1:
            self._note(bench_id, person, "came to the bench")
        self._look(bench_id)
        if self.company(bench_id) is not None:
            self._pages.tell(bench_id)

    def go(self, bench_id: str, person: Person) -> None:
        """Note that a page of a person no longer shows a bench; a person who comes back soon was never away."""
        self._presence.go(bench_id, person, self._clock())
        if self._presence.of(bench_id):
            self._pages.tell(bench_id)

    def heard(self, bench_id: str, person: Person) -> None:
        """Note that a person is present."""
        if (lease := self._leases.get(bench_id)) is not None and lease.is_of(person):
            lease.renew(self._clock())

    def check(self, bench_id: str, person: Person) -> None:
        """Refuse a person who does not drive a bench; without a driver, the person drives from now on.

        Raises
        ------
        ApiError
            Saying who drives.
        """
        lease = self._leases.get(bench_id)
        if lease is None:
            return
        if lease.driver is None:
            self._give(bench_id, lease, person, "now drives the bench")
        elif not lease.is_of(person):
            raise lease.refusal(person)
        lease.renew(self._clock())

    def ask(self, bench_id: str, person: Person) -> None:
        """Request the bench from the driver; without a driver, the person drives at once."""
        lease = self._leases.get(bench_id)
        if lease is None or lease.is_of(person):
            return
        if lease.driver is None:
            return self.check(bench_id, person)
        lease.asking[person.id] = person
        self._note(bench_id, person, f"asked {lease.driver.name} for the bench")
        self._pages.tell(bench_id)

    def refuse(self, bench_id: str, person: Person, whom: str) -> None:
        """Keep the bench although another person has requested it."""
        lease = self._held(bench_id, person)
        if (asked := lease.asking.pop(whom, None)) is None:
            raise ApiError(422, "invalid", "no person of this id has asked", "to")
        self._note(bench_id, person, f"keeps the bench, although {asked.name} asked for it")
        self._pages.tell(bench_id)

    def hand_over(self, bench_id: str, person: Person, whom: str) -> None:
        """Let another person drive: a present person with the right, or a student to whom the teacher lends it."""
        present = self._presence.of(bench_id).get(whom)
        lease = self._leases.get(bench_id)
        if present is not None and self._people.may(present, Need.DRIVE, bench_id):
            lease = self._held(bench_id, person)
            lease.lent_by = person.id
            return self._give(bench_id, lease, present, f"was handed the bench by {person.name}")
        if not person.is_teacher:
            raise ApiError(422, "invalid", "no person of this id is here and may drive", "to")
        self._lend(bench_id, whom)

    def _lend(self, bench_id: str, whom: str) -> None:
        """Let a student drive a bench of the teacher."""
        student = next((one for one in self._people.students() if one.id == whom), None)
        if student is None:
            raise ApiError(422, "invalid", "there is no student of this id", "to")
        if self._people.owner(bench_id) is not None:
            text = "the bench of a student is not lent to another"
            raise ApiError(409, "conflict", text, hint="hand over a bench of your own")
        lease = self._leases.setdefault(bench_id, Lease())
        self._people.lend(student, bench_id)
        lease.lent_by = TEACHER.id
        self._give(bench_id, lease, student, "was handed the bench by teacher", COMING_S)
        self._pages.call([student])

    def take(self, bench_id: str, person: Person) -> None:
        """Take a bench: the teacher any, a student the own one after handing it over.

        Raises
        ------
        ApiError
            For any other person: the bench has to be requested.
        """
        lease = self._leases.get(bench_id)
        if lease is None and person.is_teacher:  # a program, which is present by its commands
            lease = self._leases[bench_id] = Lease()
        if lease is None or lease.is_of(person):
            return
        if lease.driver is not None and not person.is_teacher and lease.lent_by != person.id:
            raise lease.refusal(person)
        self._give(bench_id, lease, person, "took the bench")

    def leave(self, bench_id: str, person: Person) -> None:
        """Drive no longer: the bench is free, or the teacher's again."""
        lease = self._held(bench_id, person)
        self._note(bench_id, person, "drives the bench no longer")
        self._free(bench_id, lease)
        self._look(bench_id)
        self._pages.tell(bench_id)

    def forget(self, bench_id: str) -> None:
        """Forget a bench that is gone."""
        if (lease := self._leases.pop(bench_id, None)) is not None:
            self._return_loan(bench_id, lease.driver)

    def company(self, bench_id: str) -> Company | None:
        """Return the users of a bench; None while it is one person."""
        lease, here = self._leases.get(bench_id), self._presence.of(bench_id)
        people = [one for one in here.values() if one.role != "watcher"]
        links = self._presence.pages_of_watchers(bench_id)
        if lease is None and len(people) + links < 2:
            return None
        drivers = [one for one in people if self._people.may(one, Need.DRIVE, bench_id)]
        names = [one.name for one in people if one not in drivers]
        return Company(
            is_leased=lease is not None,
            driver=_shown(lease.driver) if lease is not None and lease.driver is not None else None,
            drivers=[_shown(one) for one in drivers],
            asking=[_shown(one) for one in lease.asking.values()] if lease is not None else [],
            lent_by=lease.lent_by if lease is not None else "",
            watching=names[:MOST_NAMES],
            more_watching=max(0, len(names) - MOST_NAMES),
            links=links,
        )

    async def run(self, clock: Clock) -> None:
        """Look at all leases, again and again."""
        async for _ in clock.every(LOOK_S):
            try:
                self.look()
            except Exception:
                log.exception("the leases of benches could not be looked at; it is tried again")

    def look(self) -> None:
        """Ping the drivers, and end the leases that are over."""
        now = self._clock()
        late, self._looked = max(0.0, now - self._looked - 2 * LOOK_S), now
        for bench_id, lease in list(self._leases.items()):
            lease.until += late  # a server that was suspended has received no answers
            self._look(bench_id)
            if lease.driver is not None:
                self._pages.ask(bench_id, lease.driver)
        for bench_id, person in self._presence.gone(now - LEASE_S):
            if self._presence.of(bench_id):
                self._note(bench_id, person, "left the bench")

    def _look(self, bench_id: str) -> None:
        """Begin, continue or end the lease of a bench."""
        now, lease = self._clock(), self._leases.get(bench_id)
        here = self._presence.of(bench_id).values()
        drivers = {one.id: one for one in here if self._people.may(one, Need.DRIVE, bench_id)}
        if lease is None:
            if len(drivers) < 2:
                return
            lease = self._leases[bench_id] = Lease()
            owner = self._people.owner(bench_id)
            first = owner if owner is not None and owner.id in drivers else next(iter(drivers.values()))
            lease.driver = first
            lease.renew(now)
            return
        lease.asking = {key: one for key, one in lease.asking.items() if key in drivers}
        if lease.driver is not None and now >= lease.until:
            why = f"{lease.driver.name}, who drove, has not been heard for {LEASE_S:.0f} s"
            self._note(bench_id, lease.driver, "was not heard and drives the bench no longer")
            self._free(bench_id, lease)
            self._lost(bench_id, why)
            self._pages.tell(bench_id)
        involved = {*drivers, *([lease.driver.id] if lease.driver is not None else [])}
        if len(involved) > 1 or (lease.driver is not None and self._people.is_lent(lease.driver, bench_id)):
            lease.alone_since = None
        elif lease.alone_since is None and lease.driver is not None:
            lease.alone_since = now
        elif lease.alone_since is None or now - lease.alone_since >= LEASE_S:
            del self._leases[bench_id]
            self._pages.tell(bench_id)

    def _give(self, bench_id: str, lease: Lease, person: Person, how: str, extra_s: float = 0.0) -> None:
        """Make a person the driver from now on."""
        before = lease.driver
        lease.driver = person
        lease.asking.pop(person.id, None)
        lease.until = 0.0
        lease.renew(self._clock() + extra_s)
        if person.id == lease.lent_by:
            lease.lent_by = ""
        if before is None or before.id != person.id:
            self._return_loan(bench_id, before)
        self._note(bench_id, person, how)
        self._pages.tell(bench_id)

    def _free(self, bench_id: str, lease: Lease) -> None:
        """Leave the bench without a driver."""
        self._return_loan(bench_id, lease.driver)
        lease.driver, lease.lent_by = None, ""

    def _return_loan(self, bench_id: str, person: Person | None) -> None:
        """End the right of a student to a bench that the teacher lent; a student keeps the own bench."""
        if person is not None and self._people.is_lent(person, bench_id):
            self._people.end_loan(person)
            self._pages.call([person])

    def _held(self, bench_id: str, person: Person) -> Lease:
        """Return the lease of a bench with a driver, or refuse."""
        lease = self._leases.get(bench_id)
        if lease is None:
            raise ApiError(409, "conflict", "no other person has this bench open, so it needs no driver")
        if not lease.is_of(person):
            raise lease.refusal(person)
        return lease


def go_without_driver(session: LiveBench, why: str) -> None:
    """Act on a bench without a driver: continue with its settings, or take its outputs to safe values (a job)."""
    board = session.board
    if board.spec.frame.without_driver == "safe" and board.trip is None and not session.replay_of:
        session.execute(MakeSafe(make_safe=why), "board")
    else:
        session.note("board", "driving", f"{why}; the bench keeps its settings and runs on")


def _shown(person: Person) -> Somebody:
    return Somebody(id=person.id, name=person.name)
