"""The work of a student at a sheet: person, bench, progress; and all works, kept in the database."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from pydantic import BaseModel, Field
from sqlalchemy import delete, select, tuple_

from scenarios.sheets.progress import Progress
from scenarios.sheets.sheet import Sheet
from server.store.change import Change
from server.store.database import Database
from server.store.people import SheetProgressRow


@dataclass
class Work:
    """The work of a student at a sheet."""

    person_id: str
    class_id: str
    sheet_id: str
    bench_id: str
    begun: datetime
    progress: Progress


class Works:
    """Who works at which sheets.

    Parameters
    ----------
    database : Database
        Where it is kept.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self._all: dict[tuple[str, str], Work] = {}

    async def recover(self) -> None:
        """Restore the stored works."""
        for row in await self._database.run(lambda session: list(session.scalars(select(SheetProgressRow)))):
            progress = Progress.model_validate(row.progress)
            work = Work(row.person_id, row.class_id or "", row.sheet_id, row.bench_id, row.begun, progress)
            self._all[row.person_id, row.sheet_id] = work

    def get(self, person_id: str, sheet_id: str) -> Work | None:
        """Return the work of a person at a sheet."""
        return self._all.get((person_id, sheet_id))

    def all(self, person_id: str = "", class_id: str = "") -> list[Work]:
        """List the works of students, latest first: of one person, or of a class."""
        found = [work for work in self._all.values() if person_id in ("", work.person_id)]
        return sorted((w for w in found if class_id in ("", w.class_id)), key=lambda w: w.begun, reverse=True)

    def keeping(self, work: Work, progress: Progress | None = None) -> Change:
        """Keep the work of a person, with another progress if there is one."""
        row = SheetProgressRow(
            person_id=work.person_id,
            sheet_id=work.sheet_id,
            class_id=work.class_id or None,
            bench_id=work.bench_id,
            begun=work.begun,
            progress=(progress or work.progress).model_dump(),
        )

        def take() -> None:
            work.progress = progress or work.progress
            self._all[work.person_id, work.sheet_id] = work

        return Change(lambda session: session.merge(row), take)

    def forgetting(self, works: list[Work]) -> list[Change]:
        """Forget some works at sheets."""
        keys = [(work.person_id, work.sheet_id) for work in works]
        if not keys:
            return []
        table = SheetProgressRow
        gone = delete(table).where(tuple_(table.person_id, table.sheet_id).in_(keys))

        def take() -> None:
            for key in keys:
                self._all.pop(key, None)

        return [Change(lambda session: session.execute(gone), take)]


class SheetBrief(BaseModel):
    """A student's work at a sheet, in brief."""

    sheet: str
    title: str
    step: int = Field(description="The step that is open, counted from 1; the last one when all are done")
    steps: int
    earned: float
    points: float
    done: bool


def brief(work: Work, sheet: Sheet) -> SheetBrief:
    """Return the progress of a student, for a tile or a list."""
    step, steps = work.progress.open_step(sheet), sheet.steps
    return SheetBrief(
        sheet=sheet.id,
        title=sheet.head.title,
        step=len(steps) if step is None else steps.index(step) + 1,
        steps=len(steps),
        earned=work.progress.points(sheet),
        points=sheet.points,
        done=step is None,
    )
