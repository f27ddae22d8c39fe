"""Grades: the work of the students of a class at sheets, as rows of a file."""

from __future__ import annotations

import csv
import io

from pydantic import BaseModel, Field

from scenarios.sheets.sheet import Answered, Choice
from server.classroom.sheets import Sheets
from server.security.person import Person

COLUMNS = ("student", "sheet", "step", "kind", "state", "earned", "lost", "of", "answers", "reasons", "tick")
DANGEROUS = ("=", "+", "-", "@", "\t", "\r")
"""A cell that begins with one of these is a formula to a spreadsheet."""


class StepGrade(BaseModel):
    """A step of a student's sheet."""

    step: str
    kind: str
    state: str = Field(description="done, left out, or open")
    earned: float = Field(description="Points before losses; points of a prediction once it is judged")
    lost: float = Field(description="Points that wrong answers and hints cost")
    of: float
    answers: list[str]
    reasons: list[str]
    tick: int = Field(description="Tick of the bench at which it was done")


class Grade(BaseModel):
    """A sheet of a student."""

    student: str
    member: str
    sheet: str
    title: str
    done: bool
    points: float
    of: float
    recordings: list[str]
    steps: list[StepGrade]


def grades_of(students: list[Person], sheets: Sheets) -> list[Grade]:
    """Return the grades of students, in their order, latest sheet first."""
    known = {sheet.id: sheet for sheet in sheets.all()}
    found = []
    for person in students:
        for work in sheets.works(person.id):
            if (sheet := known.get(work.sheet_id)) is None:
                continue
            steps = []
            for step in sheet.steps:
                state, told = work.progress.of(step), work.progress.is_told(sheet, step)
                options = step.asks.options if isinstance(step, Answered) and isinstance(step.asks, Choice) else []
                words = {option.id: option.text for option in options}
                steps.append(
                    StepGrade(
                        step=step.id,
                        kind=step.kind,
                        state="given up" if state.given_up else "done" if state.done else "open",
                        earned=round(state.share * step.points, 3) if told else 0.0,
                        lost=state.lost,
                        of=step.points,
                        answers=[words.get(given.text, given.text) for given in state.answers],
                        reasons=[given.reason if told else "not shown yet" for given in state.answers],
                        tick=state.tick,
                    )
                )
            found.append(
                Grade(
                    student=person.name,
                    member=person.id,
                    sheet=sheet.id,
                    title=sheet.head.title,
                    done=work.progress.open_step(sheet) is None,
                    points=work.progress.points(sheet),
                    of=sheet.points,
                    recordings=work.progress.recordings,
                    steps=steps,
                )
            )
    return found


def grades_csv(grades: list[Grade]) -> str:
    """Write grades as CSV, a row for each step."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\r\n")
    writer.writerow(COLUMNS)
    for grade in grades:
        for step in grade.steps:
            row = {**step.model_dump(), "student": grade.student, "sheet": grade.sheet}
            row |= {"answers": " | ".join(step.answers), "reasons": " | ".join(step.reasons)}
            writer.writerow([safe(row[column]) for column in COLUMNS])
    return file.getvalue()


def safe(value: object) -> str:
    """Return a cell that no spreadsheet takes for a formula."""
    text = str(value)
    return f"'{text}" if text.startswith(DANGEROUS) else text
