"""The people of launches: the class of a course and its students, known by keyed hashes of the platform's ids."""

from __future__ import annotations

import asyncio
from datetime import timedelta
from typing import Any

from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from scenarios import library
from server.bench.commands import DEFAULT_SCALE
from server.classroom.classes import Classes
from server.classroom.lti.launch import Launch
from server.classroom.lti.tool import Tool
from server.classroom.name import LONGEST_NAME, clean, in_one_line
from server.classroom.people import People
from server.classroom.sheets import Sheets
from server.errors import ApiError, not_found
from server.security.person import Person
from server.store.base import now
from server.store.change import Change
from server.store.database import Database
from server.store.people import ClassRow, LtiKeyRow

LASTS = timedelta(days=14)
"""How long a class lasts after the last launch; then names are forgotten, as they are of every class."""


class LaunchMembers:
    """Lets people in who come by a launch.

    Parameters
    ----------
    database : Database
        Where the hashes are.
    classes, people, sheets
        The classes of courses, their students, and the sheets of links.
    tool : Tool
        Hashes the platform's ids.
    """

    def __init__(self, database: Database, classes: Classes, people: People, sheets: Sheets, tool: Tool) -> None:
        self._database, self._classes, self._people, self._sheets = database, classes, people, sheets
        self._tool = tool
        self._turn = asyncio.Lock()

    async def group(self, launch: Launch) -> ClassRow:
        """Return the class of a course; the first launch opens it."""
        async with self._turn:
            return await self._group(launch)

    async def enter(self, launch: Launch) -> tuple[Person, str]:
        """Let a learner in, on the bench and sheet of the link; return the person and the secret of the session.

        Raises
        ------
        ApiError
            If the class is full, or the link leads to a sheet or scenario that is not there.
        """
        if launch.sheet:
            self._sheets.get(launch.sheet)
        elif launch.scenario and launch.scenario not in library.ids():
            raise not_found("scenario", launch.scenario)
        async with self._turn:  # one may come twice at once
            person, secret = await self._student(launch, await self._group(launch))
        await self._lead(person, launch)
        return person, secret

    async def _group(self, launch: Launch) -> ClassRow:
        key = self._tool.hash_of("course", *launch.course)
        if (known := await self._known(key)) is not None:
            return await self._classes.prolong(known.class_id, now() + LASTS)
        name = in_one_line(launch.course_name)[:100] or "Course"
        hours = LASTS.total_seconds() / 3600.0
        made = await self._classes.open(
            name, _wanted(launch.scenario), hours, 0.0, "lti", lambda id_: [_known_as(LtiKeyRow(key=key, class_id=id_))]
        )
        return await self._classes.row(made.id)

    async def _student(self, launch: Launch, group: ClassRow) -> tuple[Person, str]:
        key = self._tool.hash_of("user", group.id, launch.platform.issuer, launch.platform.client_id, launch.user)
        known = await self._known(key)
        for person in self._people.students(group.id):
            if known is not None and person.id == known.person_id:
                return await self._people.renew(person, group.until)
        person, secret = await self._classes.admit(
            group,
            self._free_name(launch.name, group.id),
            lambda id_: [_known_as(LtiKeyRow(key=key, class_id=group.id, person_id=id_))],
        )
        self._classes.note_joined(person)
        return person, secret

    def _free_name(self, given: str, class_id: str) -> str:
        """Return a name in the form of the class: cleaned, short enough, and unique."""
        try:
            name = clean(in_one_line(given)[:LONGEST_NAME])
        except ApiError:  # there is no name, or logs use it for another person
            name = "Student"
        free, number = name, 1
        while self._classes.is_called(class_id, free):
            number += 1
            free = f"{name[: LONGEST_NAME - 5]} {number}"
        return free

    async def _lead(self, person: Person, launch: Launch) -> None:
        """Give a student the bench of the link, unless the student has it already."""
        benches = self._classes.benches
        session = await benches.get(person)
        if launch.sheet:
            works = {work.sheet_id: work for work in self._sheets.works(person.id)}
            if launch.sheet not in works or works[launch.sheet].bench_id != session.id:
                await self._sheets.begin(person, launch.sheet)
        elif launch.scenario and session.scenario.id != launch.scenario:
            await benches.replace(person, _wanted(launch.scenario))

    async def _known(self, key: str) -> LtiKeyRow | None:
        """Return the row of a hash; hashes of classes that are over are forgotten."""

        def known(session: Session) -> LtiKeyRow | None:
            session.execute(delete(LtiKeyRow).where(LtiKeyRow.class_id.not_in(select(ClassRow.id))))
            return session.get(LtiKeyRow, key)

        return await self._database.run(known)


def _known_as(row: LtiKeyRow) -> Change:
    """Keep the class or the student of a hash."""
    return Change(lambda session: session.merge(row))


def _wanted(scenario: str) -> dict[str, Any]:
    """Return the scenario with which a bench begins."""
    return {
        "source": scenario if scenario in library.ids() else "first-look",
        "values": {},
        "seed": None,
        "paused": False,
        "time_scale": DEFAULT_SCALE,
        "own_scale": True,
    }
