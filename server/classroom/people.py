"""All persons with a session except the teacher: students of classes, and holders of links to watch.

Sessions are kept by the hash of their secret. All of them are in memory too, because the gate asks at every request.
"""

from __future__ import annotations

import asyncio
import contextlib
import secrets
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from typing import cast

from sqlalchemy import delete, select, update

from server.classroom.access import Need
from server.paging import Key
from server.security.person import Person, Role, hash_of, new_secret
from server.store.base import now
from server.store.change import Change
from server.store.database import Database
from server.store.people import PersonRow

MOST_EARLIER = 100
"""Earlier benches of a student that are remembered."""


def by_arrival(person: Person) -> Key:
    """Return the key of a person in a list of people."""
    return person.joined, person.id


class People:
    """The sessions of all who are not the teacher.

    Parameters
    ----------
    database : Database
        Where they are kept.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self._by_hash: dict[str, Person] = {}
        self._hashes: dict[str, str] = {}
        self._benches: dict[str, str] = {}
        self._earlier: dict[str, list[str]] = {}
        self._lent: dict[str, str] = {}
        self._shown: dict[str, str] = {}
        self._changed = asyncio.Event()
        self.hands: set[str] = set()
        """Ids of the students who have raised a hand."""

    async def recover(self) -> None:
        """Restore the sessions of the last start, without the ended sessions."""
        await self._database.run(lambda session: session.execute(delete(PersonRow).where(PersonRow.until <= now())))
        for row in await self._database.run(lambda session: list(session.scalars(select(PersonRow)))):
            self._take(row)

    def _take(self, row: PersonRow) -> Person:
        person = Person(row.id, row.name, cast(Role, row.role), row.class_id or "", row.until, row.joined)
        self._by_hash[row.secret_hash], self._hashes[row.id] = person, row.secret_hash
        if row.bench_id:
            self._benches[row.id] = row.bench_id
        if row.lent:
            self._lent[row.id] = row.lent
        self._earlier[row.id] = list(row.earlier or [])
        return person

    async def add(
        self,
        role: Role,
        name: str,
        until: datetime,
        class_id: str | None = None,
        bench_id: str | None = None,
        also: Callable[[str], Sequence[Change]] = lambda _: (),
        secret: str = "",
    ) -> tuple[Person, str]:
        """Add a person; return the person and the secret of the session, which is new unless given, and kept nowhere.

        The change that ``also`` returns for the id of the person is stored with it. A session that the secret opened
        before ends.
        """
        secret = secret or new_secret()
        before = self._by_hash.get(hash_of(secret))
        row = PersonRow(
            id=secrets.token_hex(8),
            role=role,
            name=name,
            class_id=class_id,
            bench_id=bench_id,
            secret_hash=hash_of(secret),
            joined=now(),
            until=until,
        )
        ended = [self.removal(before)] if before is not None else []
        await self._database.keep(*ended, Change(lambda session: session.add(row)), *also(row.id))
        return self._take(row), secret

    async def renew(self, person: Person, until: datetime) -> tuple[Person, str]:
        """Give a person a new secret; the secret before, and the sockets that it opened, end."""
        secret = new_secret()
        hashed = hash_of(secret)
        query = update(PersonRow).where(PersonRow.id == person.id).values(secret_hash=hashed, until=until)
        await self._database.run(lambda session: session.execute(query))
        self._by_hash.pop(self._hashes.get(person.id, ""), None)
        back = replace(person, until=until)
        self._by_hash[hashed], self._hashes[person.id] = back, hashed
        self._check_again()
        return back, secret

    def by_secret(self, secret: str) -> Person | None:
        """Return whose session a secret opens, as long as it lasts."""
        person = self._by_hash.get(hash_of(secret)) if secret else None
        return person if person is not None and (person.until is None or person.until > now()) else None

    async def close(self, secret: str) -> None:
        """End the session that a secret opens, if there is one."""
        person = self._by_hash.get(hash_of(secret))
        if person is not None:
            await self.remove(person)

    def students(self, class_id: str = "") -> list[Person]:
        """List the students of a class, or of all classes, in the order in which they came."""
        return [one for one in self._by_hash.values() if one.role == "student" and class_id in ("", one.class_id)]

    def watchers(self, bench_id: str) -> list[Person]:
        """List the links to watch a bench."""
        return [one for one in self._by_hash.values() if one.role == "watcher" and self.bench_of(one) == bench_id]

    def bench_of(self, person: Person) -> str:
        """Return the bench of a student, or the bench of a watcher; "" if there is none yet."""
        return self._benches.get(person.id, "")

    def benches_of(self, person: Person) -> list[str]:
        """Return the present and earlier benches of a student, or the bench of a watcher."""
        bench_id = self.bench_of(person)
        return [*self._earlier.get(person.id, []), *([bench_id] if bench_id else [])]

    def owner(self, bench_id: str) -> Person | None:
        """Return the student of a bench; None for a bench of the teacher."""
        return next((one for one in self.students() if self.bench_of(one) == bench_id), None)

    def giving(self, person: Person, bench_id: str) -> Change:
        """Give a bench to a student, who keeps the right to see the recordings of the benches before."""
        earlier = [one for one in self.benches_of(person) if one != bench_id][-MOST_EARLIER:]
        values = {"bench_id": bench_id, "earlier": earlier}
        given = update(PersonRow).where(PersonRow.id == person.id).values(**values)

        def take() -> None:
            self._earlier[person.id], self._benches[person.id] = earlier, bench_id

        return Change(lambda session: session.execute(given), take)

    def lend(self, student: Person, bench_id: str) -> None:
        """Let a student see and drive a bench of the teacher."""
        self._lent[student.id] = bench_id
        self._keep_loan(student, bench_id)

    def lent_to(self, person: Person) -> str:
        """Return the bench of the teacher that a student may drive; nothing if there is none."""
        return self._lent.get(person.id, "")

    def is_lent(self, person: Person, bench_id: str) -> bool:
        """Whether a student may drive a bench of the teacher."""
        return self.lent_to(person) == bench_id

    def end_loan(self, person: Person) -> None:
        """End the right of a student to a bench of the teacher; open sockets to it are closed."""
        if self._lent.pop(person.id, None) is not None:
            self._keep_loan(person, None)
            self._check_again()

    def _keep_loan(self, person: Person, bench_id: str | None) -> None:
        change = update(PersonRow).where(PersonRow.id == person.id).values(lent=bench_id)
        self._database.run_later(lambda session: session.execute(change))

    def show(self, class_id: str, bench_id: str) -> None:
        """Show a bench to all students of a class, in place of the bench before; none if it is empty."""
        before = self._shown.pop(class_id, "")
        if bench_id:
            self._shown[class_id] = bench_id
        if before:
            self._check_again()

    def shown_to(self, class_id: str) -> str:
        """Return the bench that all students of a class may see; nothing if there is none."""
        return self._shown.get(class_id, "")

    def shown_at(self, bench_id: str) -> list[str]:
        """List the classes that see a bench."""
        return [class_id for class_id, one in self._shown.items() if one == bench_id]

    def seen_by_students(self) -> set[str]:
        """Return the benches that students see in addition to their own: shown and lent benches."""
        return {*self._shown.values(), *self._lent.values()}

    def removal(self, person: Person) -> Change:
        """End a session for good; its open sockets are closed."""
        gone = delete(PersonRow).where(PersonRow.id == person.id)
        return Change(lambda session: session.execute(gone), lambda: self._forget(person))

    async def remove(self, person: Person) -> None:
        """End a session for good; its open sockets are closed."""
        await self._database.keep(self.removal(person))

    def drop(self, person: Person) -> None:
        """Undo `add`; the row is deleted as soon as the database allows it."""
        self._forget(person)
        self._database.run_later(self.removal(person).write)

    def _forget(self, person: Person) -> None:
        self._by_hash.pop(self._hashes.pop(person.id, ""), None)
        for kept in (self._benches, self._earlier, self._lent):
            kept.pop(person.id, None)
        self.hands.discard(person.id)
        self._check_again()

    async def until_refused(self, person: Person, need: Need, bench_id: str) -> bool:
        """Wait until a person may no longer pass a door; return whether the reason is the end of the session."""
        while self.lasts(person) and self.may(person, need, bench_id):
            left = None if person.until is None else (person.until - now()).total_seconds()
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(self._changed.wait(), left)
        return not self.lasts(person)

    def lasts(self, person: Person) -> bool:
        """Return whether the session of a person lasts."""
        if person.is_teacher:
            return True
        known = self._by_hash.get(self._hashes.get(person.id, ""))  # who came back has another session
        return known is person and (person.until is None or person.until > now())

    def _check_again(self) -> None:
        """Let all waiting requests check their rights again."""
        before, self._changed = self._changed, asyncio.Event()
        before.set()

    def may(self, person: Person | None, need: Need, bench_id: str = "") -> bool:
        """Return whether a person may pass a door."""
        if need is Need.NOTHING or (person is not None and person.is_teacher):
            return True
        if person is None or need is Need.TEACHER:
            return False
        if need is Need.SESSION:
            return True
        if need is Need.MEMBER:
            return person.role == "student"
        if not bench_id:
            return False
        if bench_id in (self.bench_of(person), self.lent_to(person)):
            return need is Need.WATCH or person.role == "student"
        return need is Need.WATCH and bool(person.class_id) and self.shown_to(person.class_id) == bench_id

    def may_see_recordings(self, person: Person, bench_id: str) -> bool:
        """Return whether a person may see the recordings of a bench, also of a deleted bench."""
        return person.is_teacher or bench_id in self.benches_of(person)
