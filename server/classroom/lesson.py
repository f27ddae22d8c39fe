"""A lesson: the teacher shows a bench to a whole class, arranges their panels, and starts their benches together."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from pydantic import BaseModel, Field
from sqlalchemy import select, update
from sqlalchemy.orm import Session

from core.errors import InputError
from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.commands import Pause, Reset, Start
from server.bench.engine import Engine
from server.classroom.audit import Audit
from server.classroom.lease import Pages
from server.classroom.people import People
from server.errors import ApiError
from server.security.person import Person
from server.store.change import Change
from server.store.database import Database
from server.store.people import ClassRow


class GivenLayout(BaseModel):
    """A layout that the teacher has given to a class."""

    id: str = Field(description="Another one each time")
    name: str
    layout: dict[str, Any] | None = Field(None, description="As the page writes it; null: the built-in one of its name")


class Lesson:
    """Shows benches to classes, until the teacher ends it or the bench is gone.

    Parameters
    ----------
    database : Database
        Where it is kept.
    people : People
        The students.
    audit : Audit
        The log of actions of the teacher.
    pages : Pages
        Streams of the students, which get messages.
    """

    def __init__(self, database: Database, people: People, audit: Audit, pages: Pages) -> None:
        self._database, self._people, self._audit, self._pages = database, people, audit, pages
        self._layouts: dict[str, GivenLayout] = {}

    async def recover(self) -> None:
        """Restore the presentations and layouts of classes."""
        for row in await self._database.run(lambda session: list(session.scalars(select(ClassRow)))):
            self._people.show(row.id, row.shown or "")
            if row.layout is not None:
                self._layouts[row.id] = GivenLayout.model_validate(row.layout)

    async def show(self, class_id: str, bench_id: str, title: str) -> None:
        """Let all students of a class see a bench."""
        await self._database.keep(self._showing(class_id, bench_id))
        self._audit.add("teacher", "shown", f"showed {title} to all", class_id, bench_id)
        self._pages.call(self._people.students(class_id))

    async def end_showing(self, class_id: str) -> None:
        """Let the students of a class see their own benches again."""
        await self._database.keep(*self._ending([class_id]))

    async def give_layout(self, class_id: str, name: str, layout: dict[str, Any] | None) -> None:
        """Arrange the panels of all students of a class, also of later students."""
        given = GivenLayout(id=secrets.token_hex(4), name=name, layout=layout)
        take = partial(self._layouts.__setitem__, class_id, given)
        await self._database.keep(Change(_changed(class_id, layout=given.model_dump()), take))
        self._audit.add("teacher", "layout", f"gave the layout {name} to all", class_id)
        self._pages.call(self._people.students(class_id))

    def layout_for(self, person: Person) -> GivenLayout | None:
        """Return the layout that the class of a student was given last."""
        return self._layouts.get(person.class_id)

    def lower_hand(self, person: Person) -> None:
        """Take down the hand of a student."""
        if person.id not in self._people.hands:
            raise ApiError(409, "conflict", f"{person.name} has not raised a hand")
        self._people.hands.discard(person.id)
        self._pages.call([person])

    def forgetting(self, bench_id: str) -> list[Change]:
        """End showing a bench that goes."""
        return self._ending(self._people.shown_at(bench_id))

    async def forget(self, bench_id: str) -> None:
        """End showing a bench that is gone."""
        await self._database.keep(*self.forgetting(bench_id))

    def end(self, class_id: str) -> None:
        """Forget the presentations to a class that has ended; its row is deleted with it."""
        self._people.show(class_id, "")
        self._layouts.pop(class_id, None)

    def _showing(self, class_id: str, bench_id: str) -> Change:
        take = partial(self._people.show, class_id, bench_id)
        return Change(_changed(class_id, shown=bench_id or None), take)

    def _ending(self, classes: list[str]) -> list[Change]:
        """Let the students of some classes see their own benches again, where they are shown another."""

        def ending(class_id: str, bench_id: str) -> Change:
            change = self._showing(class_id, "")

            def take() -> None:
                change.take()
                self._audit.add("teacher", "shown", "ended showing a bench to all", class_id, bench_id)
                self._pages.call(self._people.students(class_id))

            return Change(change.write, take)

        return [ending(one, bench_id) for one in classes if (bench_id := self._people.shown_to(one))]


def _changed(class_id: str, **values: Any) -> Callable[[Session], object]:
    """Return the change of the row of a class."""
    change = update(ClassRow).where(ClassRow.id == class_id).values(**values)
    return lambda session: session.execute(change)


async def start_together(
    benches: Benches, engine: Engine, sessions: Sequence[LiveBench | None], actor: str
) -> list[str | None]:
    """Bring benches to tick 0 and start all of them at once; return of each why not, if so.

    A bench that is already paused at tick 0 keeps its settings; any other is reset. From the start on, benches of the
    same time scale are at the same tick, within one round of the engine.

    Parameters
    ----------
    benches : Benches
        Where commands are carried out.
    engine : Engine
        Starts all of them between two slices.
    sessions : sequence of LiveBench
        The benches; a missing bench stays out.
    actor : str
        Who starts them.
    """

    async def stand(session: LiveBench | None) -> str | None:
        if session is None:
            return "there is no bench"
        try:
            await benches.command(session, Pause(), actor)
            if session.board.tick > 0:
                await benches.command(session, Reset(), actor)
        except (InputError, ApiError) as error:
            return str(error)
        return None

    why = await asyncio.gather(*map(stand, sessions))

    def start(session: LiveBench | None, before: str | None) -> str | None:
        if session is None or before is not None:
            return before
        try:
            session.execute(Start(), actor)
        except (InputError, ApiError) as error:
            return str(error)
        return None

    return await engine.call(lambda: [start(*pair) for pair in zip(sessions, why, strict=True)])
