"""Lab sheets: list them, begin one, answer its steps, hand it in; push one to a class, and take its grades."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import Depends, Path, Query, Response
from pydantic import BaseModel, Field

from server.api.bodies import AnswerBody, Body, MemberIds
from server.api.deps import PersonDep, RateLimited, ServiceDep
from server.api.files import HTML
from server.api.paging import Number, pages
from server.api.router import Router
from server.api.students import Outcomes, refusal, student_of, students_of
from server.classroom.grades import Grade, grades_csv, grades_of
from server.classroom.sheet_report import sheet_report
from server.classroom.sheet_view import SheetView
from server.classroom.sheet_work import SheetBrief, brief
from server.errors import ApiError, not_found
from server.paging import ListPage
from server.security.person import Person
from server.service import Service

router = Router(tags=["sheets"])

Id = Annotated[str, Path(max_length=80)]


def get_worker(person: PersonDep) -> Person:
    """Return the caller; refuse a watcher, because watchers have no bench for a sheet."""
    if person.role == "watcher":
        raise ApiError(409, "conflict", "a person who watches a bench has no sheet")
    return person


WorkerDep = Annotated[Person, Depends(get_worker)]


class SheetCard(AnswerBody):
    """A sheet in a list."""

    id: str
    title: str
    summary: str
    minutes: int
    points: float
    steps: int
    own: bool = Field(description="Whether a user opened the sheet; all others belong to the library")
    work: SheetBrief | None = Field(description="Progress of the caller; null: not begun")


class SheetList(BaseModel):
    """The sheets, in the order in which they are taught."""

    sheets: list[SheetCard]
    current: str | None = Field(description="Id of the sheet that the caller began last")


class NewSheet(Body):
    """A sheet as Markdown."""

    text: str = Field(min_length=1, max_length=200_000, description="Markdown text with a TOML head")


class StepAnswer(Body):
    """An answer: a number with its unit, or the id of an option."""

    answer: str = Field(min_length=1, max_length=200, description="Number with its unit, or id of an option")


class SheetForAll(Body):
    """A sheet for the students of a class."""

    sheet: str = Field(description="Id of a sheet")
    members: MemberIds = None


class GradeList(BaseModel):
    """The work of the students of a class at sheets."""

    grades: list[Grade]


@router.get("/sheets")
async def list_sheets(
    person: PersonDep, service: ServiceDep, page: Annotated[ListPage, pages(Number, str)]
) -> SheetList:
    """List the sheets."""
    works = {work.sheet_id: work for work in service.sheets.works(person.id)}
    current = service.sheets.current(person)
    return SheetList(
        sheets=[
            SheetCard.of(
                sheet,
                sheet.head,
                steps=len(sheet.steps),
                own=service.sheets.shelf.is_own(sheet.id),
                work=brief(works[sheet.id], sheet) if sheet.id in works else None,
            )
            for sheet in page.cut(service.sheets.all(), service.sheets.shelf.key)
        ],
        current=current[0].sheet_id if current is not None else None,
    )


@router.post("/sheets", status_code=201, dependencies=[RateLimited])
async def open_sheet(body: NewSheet, person: PersonDep, service: ServiceDep, response: Response) -> SheetView:
    """Open a user's own sheet; a faulty sheet is refused with its line and field."""
    sheet = await service.sheets.shelf.open(body.text)
    response.headers["Location"] = f"/api/v1/sheets/{sheet.id}"
    return await service.sheets.view(person, sheet.id)


@router.get("/sheets/{sheet_id}")
async def get_sheet(sheet_id: Id, person: PersonDep, service: ServiceDep) -> SheetView:
    """Return a sheet up to the step that is open for the caller."""
    return await service.sheets.view(person, sheet_id)


@router.delete("/sheets/{sheet_id}", status_code=204, dependencies=[RateLimited])
async def delete_sheet(sheet_id: Id, service: ServiceDep) -> None:
    """Delete a user's own sheet, and the work at it."""
    await service.sheets.delete(sheet_id)


@router.post("/sheets/{sheet_id}/begin", dependencies=[RateLimited])
async def begin_sheet(sheet_id: Id, person: WorkerDep, service: ServiceDep) -> SheetView:
    """Begin a sheet, or continue it on a new bench; answers stay."""
    await service.sheets.begin(person, sheet_id)
    return await service.sheets.view(person, sheet_id)


@router.delete("/sheets/{sheet_id}/progress", status_code=204, dependencies=[RateLimited])
async def start_over(sheet_id: Id, person: PersonDep, service: ServiceDep) -> None:
    """Forget the caller's answers at a sheet."""
    await service.sheets.start_over(person, sheet_id)


@router.post("/sheets/{sheet_id}/steps/{step_id}/answer", dependencies=[RateLimited])
async def answer_step(sheet_id: Id, step_id: Id, body: StepAnswer, person: WorkerDep, service: ServiceDep) -> SheetView:
    """Answer the step that is open."""
    await service.sheets.change(
        person, sheet_id, lambda progress, sheet, tick: progress.answer(sheet, step_id, body.answer, tick)
    )
    return await service.sheets.view(person, sheet_id)


@router.post("/sheets/{sheet_id}/steps/{step_id}/hide", status_code=201, dependencies=[RateLimited])
async def hide_in_step(sheet_id: Id, step_id: Id, person: WorkerDep, service: ServiceDep) -> SheetView:
    """Hide the fault of the step that is open, on a new bench of the sheet; the answer to it closes the step."""
    if person.role == "student":
        service.driving.check(service.people.bench_of(person), person)  # the bench before is closed with it
    await service.sheets.hide(person, sheet_id, step_id)
    await service.checkpoints.write()  # the bench of a student hides it after a crash too
    return await service.sheets.view(person, sheet_id)


@router.post("/sheets/{sheet_id}/steps/{step_id}/hint", dependencies=[RateLimited])
async def take_hint(sheet_id: Id, step_id: Id, person: WorkerDep, service: ServiceDep) -> SheetView:
    """Take the next hint, for the points that it costs."""
    await service.sheets.change(person, sheet_id, lambda progress, sheet, _: progress.take_hint(sheet, step_id))
    return await service.sheets.view(person, sheet_id)


@router.post("/sheets/{sheet_id}/steps/{step_id}/close", dependencies=[RateLimited])
async def close_step(sheet_id: Id, step_id: Id, person: WorkerDep, service: ServiceDep) -> SheetView:
    """Close the open step with its points; the reply has the right answer."""
    await service.sheets.change(person, sheet_id, lambda progress, sheet, tick: progress.go_on(sheet, step_id, tick))
    return await service.sheets.view(person, sheet_id)


@router.put("/sheets/{sheet_id}/recordings/{recording_id}", dependencies=[RateLimited])
async def add_recording(sheet_id: Id, recording_id: Id, person: WorkerDep, service: ServiceDep) -> SheetView:
    """Hand in one of the student's recordings with the sheet."""
    recording = await service.recordings.get(recording_id)
    if not service.people.may_see_recordings(person, recording.bench_id):
        raise not_found("recording", recording_id)
    await service.sheets.change(person, sheet_id, lambda progress, *_: progress.keep(recording_id))
    return await service.sheets.view(person, sheet_id)


@router.get("/sheets/{sheet_id}/report", response_class=Response, responses={200: {"content": {HTML: {}}}})
async def get_report(sheet_id: Id, person: PersonDep, service: ServiceDep) -> Response:
    """Return the sheet to hand in: text, answers, points and reasons in one HTML file."""
    return await _shown(service, person, sheet_id)


@router.post("/classes/{class_id}/sheet", dependencies=[RateLimited])
async def begin_for_all(class_id: Id, body: SheetForAll, service: ServiceDep) -> Outcomes:
    """Begin a sheet with all students of a class, also with later students, or with some; each gets its bench."""
    service.sheets.get(body.sheet)
    chosen = await students_of(service, class_id, body.members)
    if body.members is None:
        await service.classes.keep_sheet(class_id, body.sheet)
    refusals = [await refusal(person, service.sheets.begin(person, body.sheet)) for person in chosen]
    service.audit.add("teacher", "sheet", f"began the sheet {body.sheet} on all benches", class_id)
    return Outcomes.of(refusals)


@router.get("/classes/{class_id}/grades", response_model=GradeList, responses={200: {"content": {"text/csv": {}}}})
async def get_grades(
    class_id: Id, service: ServiceDep, kind: Annotated[Literal["json", "csv"], Query(alias="format")] = "json"
) -> Response:
    """Return points, answers and reasons of all students, by student, sheet and step."""
    group = await service.classes.row(class_id)
    found = grades_of(service.people.students(class_id), service.sheets)
    if kind == "json":
        return Response(GradeList(grades=found).model_dump_json(), media_type="application/json")
    headers = {"Content-Disposition": f'attachment; filename="grades-{group.id}.csv"'}
    return Response(grades_csv(found), media_type="text/csv; charset=utf-8", headers=headers)


@router.get(
    "/classes/{class_id}/sheets/{sheet_id}/{member_id}/report",
    response_class=Response,
    responses={200: {"content": {HTML: {}}}},
)
async def get_report_of(class_id: Id, sheet_id: Id, member_id: Id, service: ServiceDep) -> Response:
    """Return the sheet of a student."""
    person = await student_of(service, class_id, member_id)
    return await _shown(service, person, sheet_id)


async def _shown(service: Service, person: Person, sheet_id: str) -> Response:
    """Return the sheet of a person, to be shown in the browser."""
    html = await sheet_report(service.sheets, service.recordings, person, sheet_id)
    return Response(html, media_type=HTML, headers={"Content-Disposition": f'inline; filename="{sheet_id}.html"'})
