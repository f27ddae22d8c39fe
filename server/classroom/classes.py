"""Classes: students who join by a code, each with a bench of their own."""

from __future__ import annotations

import asyncio
import hmac
import logging
from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from typing import Any

from pydantic import BaseModel, Field
from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from server.bench.build import prepare
from server.classroom.audit import Audit
from server.classroom.blinds import Blinds
from server.classroom.code import new_class_id, new_code, shown, split
from server.classroom.draw import draw
from server.classroom.game_table import GameTable
from server.classroom.lesson import Lesson
from server.classroom.name import clean
from server.classroom.people import People
from server.classroom.student_benches import StudentBenches
from server.classroom.votes import Votes
from server.clock import Clock
from server.errors import REFUSED, ApiError, not_found, why
from server.paging import ListPage, by_age
from server.security.person import Person, hash_of, new_secret
from server.store.base import now
from server.store.change import Change
from server.store.database import Database
from server.store.people import ClassRow

log = logging.getLogger(__name__)

EVERY_S = 30.0
"""Between two looks for classes that have ended."""
MOST_CLASSES = 20


class Class(BaseModel):
    """A class as the teacher sees it."""

    id: str
    name: str
    scenario: str = Field(description="Start of the benches of new students")
    created: datetime
    until: datetime = Field(description="When it ends, and its students are forgotten")
    students: int
    shown: str | None = Field(None, description="The bench that all students see now; null: each sees the own one")
    code: str | None = Field(
        description="As shown on the wall; null: joining is closed, or the code has to be made anew"
    )
    code_until: datetime | None
    path: str | None = Field(description="Path of the address by which students join")
    addresses: list[str] = Field(
        [], description="Whole addresses for other machines, likeliest first; none: no other machine can connect"
    )


class Classes:
    """The classes of this server.

    Parameters
    ----------
    database : Database
        Where they are kept.
    people : People
        The students.
    benches : StudentBenches
        Their benches.
    audit : Audit
        The log of actions of users.
    lesson : Lesson
        Shows them benches.
    blinds : Blinds
        Their hidden faults and answers.
    votes : Votes
        Their votes, which are deleted with them.
    games : GameTable
        Their attempts at games, which are deleted with them too.
    most_students : int
        Students of all classes.
    """

    def __init__(
        self,
        database: Database,
        people: People,
        benches: StudentBenches,
        audit: Audit,
        lesson: Lesson,
        blinds: Blinds,
        votes: Votes,
        games: GameTable,
        most_students: int,
    ) -> None:
        self._database, self._people, self.benches = database, people, benches
        self._audit, self._lesson, self._blinds = audit, lesson, blinds
        self._votes, self._games = votes, games
        self._most = most_students
        self._codes: dict[str, str] = {}
        self._turn = asyncio.Lock()

    async def open(
        self,
        name: str,
        wanted: dict[str, Any],
        hours: float,
        code_minutes: float,
        actor: str = "teacher",
        also: Callable[[str], Sequence[Change]] = lambda _: (),
    ) -> Class:
        """Open a class; students can join at once. The change that ``also`` returns for its id is stored with it.

        Raises
        ------
        InputError
            If the scenario is not valid.
        ApiError
            If there are too many.
        """
        await self._check(wanted)
        there = {row.id for row in await self._rows()}
        if len(there) >= MOST_CLASSES:
            raise ApiError(409, "limit", f"{MOST_CLASSES} classes are open, the limit", hint="end one first")
        row = ClassRow(
            id=new_class_id(there),
            name=name,
            scenario=wanted,
            secret=new_secret(),
            created=now(),
            until=now() + timedelta(hours=hours),
        )
        code = _let_in(row, code_minutes)
        await self._database.keep(Change(lambda session: session.add(row)), *also(row.id))
        self._codes[row.id] = code
        self._audit.add(actor, "class", f"opened the class {name}", row.id)
        return self._shown(row)

    async def new_code(self, class_id: str, minutes: float) -> Class:
        """Let students join for a while by a new code; an earlier one opens nothing any more."""
        codes: list[str] = []
        row = await self._changed(class_id, lambda row: codes.append(_let_in(row, minutes)))
        self._codes[class_id] = codes[0]
        return self._shown(row)

    async def close_joining(self, class_id: str) -> Class:
        """Close joining."""

        def close(row: ClassRow) -> None:
            row.code_hash = row.code_until = None

        row = await self._changed(class_id, close)
        self._codes.pop(class_id, None)
        return self._shown(row)

    async def all(self, page: ListPage) -> list[Class]:
        """List the classes, oldest first."""
        return [self._shown(row) for row in page.cut(await self._rows(), by_age)]

    async def get(self, class_id: str) -> Class:
        """Return a class, or refuse with 404."""
        return self._shown(await self.row(class_id))

    async def join(self, typed: str, name: str) -> tuple[Person, str]:
        """Let a student in; return the person and the secret of the session.

        Raises
        ------
        ApiError
            For a code that opens no class, a name that is taken, or a class that is full.
        """
        class_id, code = split(typed)
        async with self._turn:  # two may give the same name at once
            row = await self._database.run(lambda session: session.get(ClassRow, class_id))
            known = row.code_hash if row is not None and row.code_hash and _lasts(row.code_until) else ""
            if row is None or not hmac.compare_digest(hash_of(code), known or ""):
                raise ApiError(
                    403, "wrong_code", "no class is open under this code", "code", "ask for the current code"
                )
            name = clean(name)
            if self.is_called(class_id, name):
                raise ApiError(409, "conflict", f"another student has the name {name}", "name", "add a letter to it")
            return await self.admit(row, name)

    async def admit(
        self, row: ClassRow, name: str, also: Callable[[str], Sequence[Change]] = lambda _: ()
    ) -> tuple[Person, str]:
        """Let a student in whose name is clean and free; return the person and the secret of the session."""
        if len(self._people.students()) >= self._most:
            text = f"the class is full: this server has room for {self._most} students"
            raise ApiError(409, "limit", text, hint="tell your teacher, who can raise max_students")
        return await self._people.add("student", name, row.until, row.id, also=also)

    def note_joined(self, person: Person) -> None:
        """Note in the log that a student has joined."""
        self._audit.add(person.name, "joined", "joined the class", person.class_id)

    def is_called(self, class_id: str, name: str) -> bool:
        """Whether a name is taken in a class."""
        return name.casefold() in {person.name.casefold() for person in self._people.students(class_id)}

    async def prolong(self, class_id: str, until: datetime) -> ClassRow:
        """Let a class last longer; return its row, or refuse with 404."""

        def prolong(row: ClassRow) -> None:
            row.until = max(row.until, until)

        return await self._changed(class_id, prolong)

    async def begin_all(self, class_id: str, wanted: dict[str, Any]) -> list[str]:
        """Begin a scenario on the bench of every student, and for all who join later; return the errors, by name.

        Raises
        ------
        InputError
            If the scenario is not valid; nothing has changed then.
        """
        await self.row(class_id)
        await self._check(wanted)

        def begin(row: ClassRow) -> None:
            row.scenario, row.sheet = wanted, None

        await self._changed(class_id, begin)
        failed: list[str] = []
        for person in self._people.students(class_id):
            try:
                await self.benches.replace(person, wanted)
            except REFUSED as error:
                failed.append(f"{person.name}: {why(error)}")
        self._audit.add("teacher", "scenario", "began a scenario on all benches", class_id)
        return failed

    async def keep_sheet(self, class_id: str, sheet_id: str) -> None:
        """Let all who join later begin with a sheet."""

        def keep(row: ClassRow) -> None:
            row.sheet = sheet_id

        await self._changed(class_id, keep)

    async def remove(self, person: Person) -> None:
        """Send a student away: the session ends, the bench is closed."""
        await self.benches.remove([person], *self._removal(person))
        self._audit.add("teacher", "removed", f"sent {person.name} away", person.class_id)

    def _removal(self, person: Person) -> list[Change]:
        """Forget a student; the session ends first, or the page would report that its bench is gone."""
        votes, games = self._votes.forgetting(person_id=person.id), self._games.forgetting(person_id=person.id)
        return [self._people.removal(person), votes, games]

    async def end(self, class_id: str) -> None:
        """End a class: close sessions and benches, delete names and the list of actions."""
        await self.row(class_id)
        students = self._people.students(class_id)
        gone = delete(ClassRow).where(ClassRow.id == class_id)

        def take() -> None:
            self._codes.pop(class_id, None)
            self._lesson.end(class_id)

        await self.benches.remove(
            students,
            *(change for person in students for change in self._removal(person)),
            self._audit.forgetting(class_id),
            self._blinds.forgetting(class_id),
            self._votes.forgetting(class_id),
            self._games.forgetting(class_id),
            Change(lambda session: session.execute(gone), take),
        )
        self._audit.drop(class_id)  # entries of the benches as they closed

    async def run(self, clock: Clock) -> None:
        """Reopen the benches of all students, then end classes whose time is over, now and again and again."""
        await self.benches.recover(self._people.students())
        await self.end_due()
        async for _ in clock.every(EVERY_S):
            await self.end_due()

    async def end_due(self) -> None:
        """End the classes whose time is over."""
        try:
            for row in await self._rows():
                if not _lasts(row.until):
                    await self.end(row.id)
        except Exception:
            log.exception("a class that is over could not be ended; it is tried again")

    def students(self, class_id: str) -> list[Person]:
        """List the students of a class, in the order in which they came."""
        return self._people.students(class_id)

    async def row(self, class_id: str) -> ClassRow:
        """Return the row of a class, or refuse with 404."""
        row = await self._database.run(lambda session: session.get(ClassRow, class_id[:32]))
        if row is None:
            raise not_found("class", class_id, "it may have ended")
        return row

    async def draw(self, person: Person, *what: str) -> int:
        """Return the number that is drawn for a person and a purpose; see `draw`."""
        secret = (await self.row(person.class_id)).secret if person.class_id else ""
        return draw(secret, person.id, *what)

    @staticmethod
    async def _check(wanted: dict[str, Any]) -> None:
        """Refuse a bench that could not be made, whether or not there are students."""
        await asyncio.to_thread(prepare, wanted["source"], wanted["values"], wanted["seed"])

    async def _rows(self) -> list[ClassRow]:
        query = select(ClassRow).order_by(ClassRow.created)
        return await self._database.run(lambda session: list(session.scalars(query)))

    async def _changed(self, class_id: str, how: Callable[[ClassRow], object]) -> ClassRow:
        """Change the row of a class and return it, or refuse with 404."""

        def change(session: Session) -> ClassRow | None:
            row = session.get(ClassRow, class_id[:32])
            if row is not None:
                how(row)
            return row

        row = await self._database.run(change)
        if row is None:
            raise not_found("class", class_id, "it may have ended")
        return row

    def _shown(self, row: ClassRow) -> Class:
        """Describe a class; its code is known only to the process that made it."""
        code = self._codes.get(row.id) if _lasts(row.code_until) else None
        source = row.scenario["source"]
        return Class(
            id=row.id,
            name=row.name,
            scenario=source if isinstance(source, str) and "\n" not in source else "own",
            created=row.created,
            until=row.until,
            students=len(self._people.students(row.id)),
            shown=self._people.shown_to(row.id) or None,
            code=shown(row.id, code) if code else None,
            code_until=row.code_until if _lasts(row.code_until) else None,
            path=f"/join?code={row.id}{code}" if code else None,
        )


def _let_in(row: ClassRow, minutes: float) -> str:
    """Let students join for a while by a new code, and return it."""
    code = new_code()
    row.code_hash, row.code_until = hash_of(code), min(row.until, now() + timedelta(minutes=minutes))
    return code


def _lasts(until: datetime | None) -> bool:
    return until is not None and until > now()
