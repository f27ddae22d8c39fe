"""The benches of lab sheets: the draws for each student, and the replacement of one bench by the next."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

from scenarios.sheets.begin import Beginning, begin
from scenarios.sheets.sheet import Sheet
from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.classroom.blind_class import quiet
from server.classroom.classes import Classes
from server.classroom.hiding import Blind, from_the_start
from server.classroom.sheet_work import Work
from server.classroom.student_benches import Swap
from server.security.person import Person
from server.store.change import Change


class SheetBenches:
    """The benches of lab sheets.

    Parameters
    ----------
    classes : Classes
        Draws the varying numbers of a student, and knows the benches of students.
    benches : Benches
        Where benches are made.
    swap : callable
        Lets a bench take the place of others.
    """

    def __init__(self, classes: Classes, benches: Benches, swap: Swap) -> None:
        self._classes, self._benches, self._swap = classes, benches, swap

    async def beginning(self, person: Person, sheet: Sheet) -> Beginning:
        """Draw the bench of a sheet for a person."""
        words = ["device", "noise", *(f"number {name}" for name in sheet.head.draws)]
        drawn = {word: await self._classes.draw(person, sheet.id, word) for word in words}
        return await asyncio.to_thread(begin, sheet, drawn.__getitem__)

    async def give(
        self,
        person: Person,
        sheet: Sheet,
        values: dict[str, Any],
        before: Work | None,
        also: Callable[[LiveBench], Sequence[Change]],
        hide: Callable[[LiveBench], Blind] | None = None,
    ) -> None:
        """Replace the bench of a sheet by a new one, with a hidden fault if ``hide`` chooses one.

        Raises
        ------
        InputError
            If it cannot be made, or hides nothing.
        """
        bench = sheet.head.bench
        wanted: dict[str, Any] = {
            "source": bench.scenario if hide is None else (await asyncio.to_thread(quiet, bench.scenario)).document,
            "values": values,
            "seed": None,
            "paused": False,
            "time_scale": bench.time_scale,
            "own_scale": bench.time_scale is None,
            "quiet_lead": False,
        }
        if person.role == "student":
            await self._classes.benches.replace(person, wanted, hide, also)
            return
        old = self._benches.find(before.bench_id) if before is not None else None
        made = await self._benches.create(**wanted, before=from_the_start(hide))
        await self._swap(made, [old] if old is not None else [], *also(made))
