"""The benches of students: makes each at its first request, replaces it, and brings it back after a crash."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Sequence
from typing import Any, Protocol

from sqlalchemy import select

from core.errors import InputError
from core.own.admission import kept
from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.checkpoints import Checkpoints, Kept
from server.bench.view import KeptWatch
from server.classroom.hiding import Blind, from_the_start, hide_again
from server.classroom.people import People
from server.errors import not_found
from server.security.person import Person
from server.store.change import Change
from server.store.database import Database
from server.store.people import ClassRow

log = logging.getLogger(__name__)


async def _nothing(_: Person) -> None:
    """Do nothing more."""


class Swap(Protocol):
    """Lets a bench that was just made take the place of others."""

    def __call__(self, made: LiveBench, before: Sequence[LiveBench], *changes: Change) -> Awaitable[None]:
        """Change all of it, or close the bench again where it cannot be kept."""


class CloseBenches(Protocol):
    """Closes benches and their streams."""

    def __call__(self, sessions: Sequence[LiveBench], *changes: Change) -> Awaitable[None]:
        """Change all of it, or nothing where it cannot be kept."""


class StudentBenches:
    """The benches of all students.

    Parameters
    ----------
    database : Database
        Has the scenario with which the benches of a class begin.
    people : People
        Knows which bench is whose.
    benches : Benches
        Where they are made.
    swap : callable
        Lets a bench take the place of others, as something changes.
    close : callable
        Closes benches and their streams, as something changes.
    checkpoints : Checkpoints
        From which they come back after a crash.
    """

    def __init__(
        self,
        database: Database,
        people: People,
        benches: Benches,
        swap: Swap,
        close: CloseBenches,
        checkpoints: Checkpoints,
    ) -> None:
        self._database, self._people, self._benches = database, people, benches
        self._swap, self._close, self._checkpoints = swap, close, checkpoints
        self._turn = asyncio.Lock()
        self._all_back = False
        self._given_up: set[str] = set()
        self.welcome: Callable[[Person], Awaitable[None]] = _nothing
        """Called before a student gets the first bench; it may give one."""
        self.on_revived: Callable[[LiveBench, KeptWatch | None], None] = lambda *_: None
        """Called with a bench before it continues from its checkpoint, and with its watch."""

    def find(self, person: Person) -> LiveBench | None:
        """Return the live bench of a student, if there is one."""
        return self._benches.find(self._people.bench_of(person))

    async def get(self, person: Person) -> LiveBench:
        """Return the bench of a student; a missing bench comes back, or is made as the class begins.

        Raises
        ------
        ApiError
            If the class has ended.
        """
        if not self._people.bench_of(person):
            await self.welcome(person)
        async with self._turn:
            if found := self.find(person):
                return found
            if revived := await self._revived(self._people.bench_of(person)):
                return revived
            query = select(ClassRow.scenario).where(ClassRow.id == person.class_id)
            wanted = await self._database.run(lambda session: session.scalar(query))
            if wanted is None:
                raise not_found("class", person.class_id, "it may have ended")
            with kept():
                return await self._make(person, wanted, [])

    async def replace(
        self,
        person: Person,
        wanted: dict[str, Any],
        hide: Callable[[LiveBench], Blind] | None = None,
        also: Callable[[LiveBench], Sequence[Change]] = lambda _: (),
    ) -> LiveBench:
        """Replace the bench of a student, with a hidden fault if ``hide`` chooses one.

        The old bench closes, and then the pages of the student go to the new one. The change that ``also`` returns for
        the new bench is made before that, so that the pages find all their data.

        Raises
        ------
        InputError
            If it cannot be made; the student keeps the bench there is.
        DBAPIError
            If it cannot be kept; the same then.
        """
        async with self._turn:
            before = self.find(person)
            return await self._make(person, wanted, [before] if before is not None else [], hide, also)

    async def remove(self, people: Sequence[Person], *changes: Change) -> None:
        """Close the benches of students, as something changes."""
        async with self._turn:
            await self._close([bench for one in people if (bench := self.find(one)) is not None], *changes)

    async def recover(self, students: list[Person]) -> None:
        """Bring all benches back, as they were shortly before the server ended; forget those that cannot come."""
        for person in students:
            try:
                if self._people.bench_of(person):
                    await self.get(person)
            except Exception:
                log.exception("the bench of %s could not be brought back", person.id)
        for bench_id in await self._checkpoints.ids():
            async with self._turn:
                if self._benches.find(bench_id) is None:
                    await self._revived(bench_id, of_nobody=True)
        self._all_back = True
        await self._checkpoints.forget_others()

    def may_come(self, bench_id: str) -> bool:
        """Whether a bench that is not there may be on its way back: until all that can come have come."""
        return not self._all_back and bench_id not in self._given_up

    async def bring_back(self, bench_id: str) -> bool:
        """Bring a bench back; return whether it exists."""
        async with self._turn:
            return self._benches.find(bench_id) is not None or await self._revived(bench_id) is not None

    async def _revived(self, bench_id: str, *, of_nobody: bool = False) -> LiveBench | None:
        """Return a bench that continues from its checkpoint, if it has one that this version can read.

        With ``of_nobody`` the bench of a student is left out: the student is gone.
        """
        found = await self._checkpoints.load(bench_id) if bench_id else None
        if found is None or (of_nobody and found.head.class_id):
            self._given_up.add(bench_id)
            return None
        try:
            return await self._benches.revive(found, self._continue)
        except Exception as error:
            log.exception("bench %s cannot continue from its checkpoint", bench_id)
            self._benches.not_back[bench_id] = str(error) if isinstance(error, InputError) else "an internal error"
            self._given_up.add(bench_id)
            return None

    def _continue(self, bench: LiveBench, kept: Kept) -> None:
        """Hide the fault of a bench again, and watch the bench, before it continues from its checkpoint."""
        hide_again(bench, kept)
        self.on_revived(bench, kept.watch)

    async def _make(
        self,
        person: Person,
        wanted: dict[str, Any],
        before: Sequence[LiveBench],
        hide: Callable[[LiveBench], Blind] | None = None,
        also: Callable[[LiveBench], Sequence[Change]] = lambda _: (),
    ) -> LiveBench:
        """Make a bench and give it to a student."""
        made = await self._benches.create(**wanted, class_id=person.class_id, before=from_the_start(hide))
        await self._swap(made, before, self._people.giving(person, made.id), *also(made))
        return made
