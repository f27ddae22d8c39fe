"""Lab sheets: who works at which, on which bench, how far each has come; kept in the database."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from core.errors import InputError
from scenarios.sheets.begin import SEEDS, Beginning, begin
from scenarios.sheets.look import known_limits
from scenarios.sheets.progress import Progress
from scenarios.sheets.sheet import BlindStep, Hold, Sheet
from server.bench.bench import LiveBench
from server.bench.benches import Benches
from server.bench.engine import Engine
from server.bench.view import KeptWatch
from server.classroom.blind import hide
from server.classroom.blind_class import quiet
from server.classroom.blinds import OF_DRAW, Blinds, hidden_on
from server.classroom.classes import Classes
from server.classroom.hiding import HINT, Blind, from_the_start
from server.classroom.people import People
from server.classroom.sheet_shelf import Shelf
from server.classroom.sheet_view import SheetView, view_of
from server.classroom.sheet_watch import Done, SheetWatch
from server.classroom.sheet_work import Work, Works
from server.classroom.student_benches import Swap
from server.clock import Clock
from server.errors import ApiError, not_found
from server.security.person import Person
from server.store.base import now
from server.store.change import Change
from server.store.database import Database

log = logging.getLogger(__name__)

EVERY_S = 1.0
"""Between two looks for benches that have come back and are not watched."""


class Sheets:
    """The lab sheets of this server, and who works at them.

    Parameters
    ----------
    database : Database
        Keeps the work.
    shelf : Shelf
        The sheets there are.
    classes : Classes
        Draws the varying numbers of a student, and knows the benches of students.
    people : People
        The students there are.
    benches : Benches
        Where benches are made.
    engine : Engine
        Whose thread may look at a bench.
    swap : callable
        Lets a bench take the place of others.
    blinds : Blinds
        Keeps the hidden faults of sheets, and the answers.
    """

    def __init__(
        self,
        database: Database,
        shelf: Shelf,
        classes: Classes,
        people: People,
        benches: Benches,
        engine: Engine,
        swap: Swap,
        blinds: Blinds,
    ) -> None:
        self._classes, self._people = classes, people
        self._benches, self._engine, self._swap, self._blinds = benches, engine, swap, blinds
        self.shelf = shelf
        self._database, self._works = database, Works(database)
        self._turn = asyncio.Lock()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._tasks: set[asyncio.Task[None]] = set()
        self._welcoming = asyncio.Lock()
        classes.benches.on_revived, classes.benches.welcome = self._go_on, self._welcome
        self.on_kept: Callable[[Work], None] = lambda _: None
        """Called with each work after it is written."""

    async def recover(self) -> None:
        """Restore the stored works."""
        self._loop = asyncio.get_running_loop()
        await self.shelf.recover()
        await self._works.recover()

    async def run(self, clock: Clock) -> None:
        """Watch benches that have come back, and forget the work of classes that are over, again and again."""
        async for _ in clock.every(EVERY_S):
            try:
                there = {person.id for person in self._people.students()}
                await self._forget([w for w in self._works.all() if w.class_id and w.person_id not in there])
                for work in self._works.all():
                    await self._follow(work)
            except Exception:
                log.exception("a bench could not be watched for a sheet; it is tried again")

    def all(self) -> list[Sheet]:
        """List the sheets that can be done here."""
        return self.shelf.all()

    def get(self, sheet_id: str) -> Sheet:
        """Return a sheet, or refuse with 404."""
        found = self._known(sheet_id)
        if found is None:
            raise not_found("sheet", sheet_id, known=(sheet.id for sheet in self.all()))
        return found

    def _known(self, sheet_id: str) -> Sheet | None:
        return next((sheet for sheet in self.all() if sheet.id == sheet_id), None)

    async def delete(self, sheet_id: str) -> None:
        """Delete a user's sheet, and the work at it."""
        gone, works = self.shelf.deletion(sheet_id), [one for one in self._works.all() if one.sheet_id == sheet_id]
        await self._forget(works, gone)

    def works(self, person_id: str = "", class_id: str = "") -> list[Work]:
        """List the works of students, latest first: of one person, or of a class."""
        return self._works.all(person_id, class_id)

    def current(self, person: Person) -> tuple[Work, Sheet] | None:
        """Return the sheet that a person began last."""
        known = {sheet.id: sheet for sheet in self.all()}
        return next(((work, known[work.sheet_id]) for work in self.works(person.id) if work.sheet_id in known), None)

    async def view(self, person: Person, sheet_id: str) -> SheetView:
        """Show a sheet to a person."""
        sheet, work = self.get(sheet_id), self._works.get(person.id, sheet_id)
        if work is None:
            return view_of(sheet, None, None, None)
        await self._follow(work)
        bench = self._benches.find(work.bench_id)
        watch = bench.watch if bench is not None and bench.view is None else None
        held = watch.now if isinstance(watch, SheetWatch) and watch.step is work.progress.open_step(sheet) else None
        return view_of(sheet, work.progress, bench.id if bench is not None else None, held)

    async def begin(self, person: Person, sheet_id: str) -> Work:
        """Give a person the bench of a sheet; the answers so far stay.

        Raises
        ------
        InputError
            If the bench cannot be made.
        """
        sheet = self.get(sheet_id)
        beginning = await self._beginning(person, sheet)
        async with self._turn:
            before = self._works.get(person.id, sheet_id)
            progress = before.progress if before is not None else Progress(facts=beginning.facts)
            work = Work(person.id, person.class_id, sheet_id, "", now(), progress)

            def kept(made: LiveBench) -> list[Change]:
                work.bench_id = made.id
                return [self._keeping(work)]

            await self._give(person, sheet, beginning.values, before, kept)
        await self._follow(work)
        return work

    async def hide(self, person: Person, sheet_id: str, step_id: str) -> None:
        """Hide the fault of the step that is open, on a new bench of the sheet; its answer closes the step.

        All of it is drawn for the student and the step, anew after each answer: the student has not touched the bench,
        and does not know the fault.

        Raises
        ------
        ApiError
            If the sheet has not been begun, or something is hidden already.
        InputError
            If the step is not open, or hides nothing.
        """
        sheet, number = self.get(sheet_id), len(self._blinds.of_person(person.id))
        exercise = f"{sheet_id} {step_id}"
        which, when, noise = [
            await self._classes.draw(person, exercise, str(number), word) for word in ("fault", "moment", "noise")
        ]
        beginning = await self._beginning(person, sheet)

        def hidden(made: LiveBench) -> Blind:
            return hide(made.board, made.board.spec.document, secrets.token_hex(8), False, which, when / OF_DRAW)

        async with self._turn:
            work = self._must_have(person, sheet_id)
            step = work.progress.must_be_open(sheet, step_id)
            if not isinstance(step, BlindStep):
                raise InputError("hides nothing", "step", code="conflict")
            bench = self._benches.find(work.bench_id)
            if bench is not None and bench.view is not None:
                raise ApiError(409, "blind", "a fault is hidden here already", hint=HINT)

            def kept(made: LiveBench) -> list[Change]:
                blind, progress = hidden_on(made), work.progress.model_copy(deep=True)
                progress.of(step).hidden = blind.question.id
                now_there = replace(work, bench_id=made.id, progress=progress)
                return [self._keeping(now_there), self._blinds.noting(made, person, blind, exercise)]

            values = {**beginning.values, "seed": noise % SEEDS}
            await self._give(person, sheet, values, work, kept, hidden)

    async def _beginning(self, person: Person, sheet: Sheet) -> Beginning:
        """Draw the bench of a sheet for a person."""
        words = ["device", "noise", *(f"number {name}" for name in sheet.head.draws)]
        drawn = {word: await self._classes.draw(person, sheet.id, word) for word in words}
        return await asyncio.to_thread(begin, sheet, drawn.__getitem__)

    async def _give(
        self,
        person: Person,
        sheet: Sheet,
        values: dict[str, Any],
        before: Work | None,
        also: Callable[[LiveBench], Sequence[Change]],
        hide: Callable[[LiveBench], Blind] | None = None,
    ) -> None:
        """Replace the bench of a sheet by a new one, with a hidden fault if ``hide`` chooses one."""
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

    async def _welcome(self, person: Person) -> None:
        """Begin the sheet of the class with a student who has just joined."""
        async with self._welcoming:  # a page asks several times at once
            sheet = self._known((await self._classes.row(person.class_id)).sheet or "")
            if sheet is not None and not self._people.bench_of(person):
                try:
                    await self.begin(person, sheet.id)
                except (InputError, ApiError):
                    log.exception("the sheet %s could not be begun with a student who joined", sheet.id)

    async def change(self, person: Person, sheet_id: str, what: Callable[[Progress, Sheet, int], None]) -> None:
        """Do something at a sheet, and keep it.

        Raises
        ------
        ApiError
            If it has not been begun, or cannot be done now.
        """
        sheet = self.get(sheet_id)
        async with self._turn:
            work = self._must_have(person, sheet_id)
            bench = self._benches.find(work.bench_id)
            progress = work.progress.model_copy(deep=True)
            what(progress, sheet, bench.status.tick if bench is not None else 0)
            await self._database.keep(self._keeping(work, progress))
        await self._follow(work)

    def _must_have(self, person: Person, sheet_id: str) -> Work:
        work = self._works.get(person.id, sheet_id)
        if work is None:
            raise ApiError(409, "conflict", "the sheet has not been begun", "sheet", "begin it first")
        return work

    async def start_over(self, person: Person, sheet_id: str) -> None:
        """Forget the work of a person at a sheet."""
        await self._forget([work for work in self.works(person.id) if work.sheet_id == sheet_id])

    async def _follow(self, work: Work) -> None:
        """Let the bench of a sheet be watched for the step that is open."""
        sheet = self._known(work.sheet_id)
        if sheet is None:
            return
        step = work.progress.open_step(sheet)
        if isinstance(step, BlindStep):
            return await self._follow_blind(work, step)
        bench = self._benches.find(work.bench_id)
        if bench is None:
            return
        watch = bench.watch if isinstance(bench.watch, SheetWatch) else None
        if not isinstance(step, Hold) or bench.view is not None:  # progress would reveal hidden values
            bench.watch = None
        elif watch is None or watch.step is not step:

            def put(step: Hold = step) -> None:
                now = bench.watch
                if not isinstance(now, SheetWatch) or now.step is not step:
                    bench.watch = self._watch(work, step, bench)

            await self._engine.call(put)

    def _watch(self, work: Work, step: Hold, bench: LiveBench) -> SheetWatch:
        """Return a watch for a step, which looks at a bench from now on."""

        def done(found: Done) -> None:
            assert self._loop is not None
            self._loop.call_soon_threadsafe(self._held, work, step, found)

        limits = known_limits(step, work.progress.facts)
        return SheetWatch(step, limits, bench.board.tick, bench.dt_ms, done)

    def _go_on(self, bench: LiveBench, kept: KeptWatch | None) -> None:
        """Watch a bench again as before the crash, before it continues from its checkpoint."""
        for work in self._works.all():
            sheet = self._known(work.sheet_id) if work.bench_id == bench.id else None
            step = work.progress.open_step(sheet) if sheet is not None else None
            if isinstance(step, Hold) and bench.view is None:
                bench.watch = watch = self._watch(work, step, bench)
                if kept is not None:
                    watch.go_on(kept)

    def _held(self, work: Work, step: Hold, found: Done) -> None:
        """Close a step whose conditions have held; on the event loop."""
        task = asyncio.get_running_loop().create_task(self._held_kept(work, step, found))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _held_kept(self, work: Work, step: Hold, found: Done) -> None:
        async with self._turn:
            work.progress.held(step, found.values, found.trace, found.tick)
            if self._works.get(work.person_id, work.sheet_id) is work:
                await self._database.keep(self._keeping(work))
        await self._follow(work)

    async def _follow_blind(self, work: Work, step: BlindStep) -> None:
        """Close a step of blind diagnosis once its hidden fault has an answer or is revealed."""
        answer = self._blinds.find(work.progress.of(step).hidden)
        if answer is None or answer.ended_tick is None:
            return  # a bench that has gone is no answer
        async with self._turn:
            if work.progress.of(step).done:
                return
            progress = work.progress.model_copy(deep=True)
            state = progress.of(step)
            state.share, state.done = min(max(answer.points / 100.0, 0.0), 1.0), True
            state.values = {"score": answer.points, "right": "yes" if answer.said == answer.truth else "no"}
            await self._database.keep(self._keeping(work, progress))

    def _keeping(self, work: Work, progress: Progress | None = None) -> Change:
        """Keep the work of a person, with another progress if there is one."""
        change = self._works.keeping(work, progress)

        def take() -> None:
            change.take()
            self.on_kept(work)

        return Change(change.write, take)

    async def _forget(self, works: list[Work], *changes: Change) -> None:
        """Forget the work at some sheets, as something changes."""
        await self._database.keep(*self._works.forgetting(works), *changes)
        for work in works:
            if (bench := self._benches.find(work.bench_id)) is not None:
                bench.watch = None
