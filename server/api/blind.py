"""Hidden faults: begin one, answer, give up; for a class, begin for all, look at the answers, reveal."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, Field

from server.api.bodies import Body
from server.api.classes import Outcomes
from server.api.deps import PersonDep, RateLimited, ServiceDep, SessionDep
from server.api.router import Router
from server.api.students import students_of
from server.bench.status import HiddenQuestion
from server.classroom.blind_class import begin_for
from server.classroom.blinds import Answer
from server.classroom.hiding import blind_of
from server.errors import REFUSED, ApiError, why

router = Router(tags=["blind"])

BENCH = "/benches/{bench_id}/blind"
CLASS = "/classes/{class_id}/blind"
RULE = (
    "A right answer that is 100 % sure earns 100 points, a wrong one loses more than 100. No answer, and an answer "
    "that is no surer than a guess, earns 0. On average you earn most by saying how sure you really are."
)


class Hide(Body):
    """A fault to hide on the user's own bench."""

    seed: int = Field(ge=0, le=2**53, description="The same one hides the same fault, but for students of a class")
    shows: bool = Field(False, description="The diagnosers may be looked at: whether to trust them is the question")


class Said(Body):
    """The presumed fault of the device, and the confidence."""

    said: str = Field(max_length=24)
    confidence: float = Field(ge=0, le=1)


class Blindness(BaseModel):
    """The hidden fault of a bench, and the answers before."""

    question: HiddenQuestion | None = Field(description="Null while nothing is hidden")
    rule: str = Field(description="How points are counted")
    answers: list[Answer] = Field(description="Oldest first, each with the truth")


class HideForAll(Body):
    """A question to the students of a class."""

    scenario: str | dict[str, Any] = Field("ch5-seven-step", description="Library id, TOML text, or document")
    shows: bool = Field(False, description="The diagnosers may be looked at: whether to trust them is the question")
    members: list[str] | None = Field(None, max_length=500, description="Ids of students; null: all of them")


class BlindClass(BaseModel):
    """The hidden faults of the students of a class, and their answers."""

    rule: str
    hidden: int = Field(description="How many have not answered yet")
    answers: list[Answer] = Field(description="Oldest first, including faults that are still hidden")


@router.get(BENCH)
async def get_blind(session: SessionDep, service: ServiceDep, person: PersonDep) -> Blindness:
    """Return the question of a bench, and the answers so far."""
    blind = blind_of(session)
    return Blindness(
        question=blind.question if blind is not None and blind.question.game is None else None,
        rule=RULE,
        answers=service.blinds.of_person(person.id),
    )


@router.post(BENCH, status_code=201, dependencies=[RateLimited])
async def hide_fault(body: Hide, session: SessionDep, service: ServiceDep, person: PersonDep) -> Blindness:
    """Hide a fault on a bench, or none; until the answer, the bench serves nothing that reveals it."""
    if session.class_id and person.is_teacher:
        raise ApiError(409, "conflict", "this is the bench of a student", hint="hide one for the class")
    secret = (await service.classes.row(person.class_id)).secret if person.class_id else ""
    await service.blinds.begin(session, person, body.seed, body.shows, secret)
    await service.checkpoints.write()  # the bench of a student is blind after a crash too
    return await get_blind(session, service, person)


@router.post(f"{BENCH}/answer", dependencies=[RateLimited])
async def answer(body: Said, session: SessionDep, service: ServiceDep, person: PersonDep) -> Answer:
    """Name the state of the device; the reply reveals the hidden fault, and the bench serves everything again."""
    if session.class_id and person.is_teacher:
        raise ApiError(403, "forbidden", "only the student whose bench it is may answer")
    return await service.blinds.commit(session, person, body.said, body.confidence)


@router.delete(BENCH, dependencies=[RateLimited])
async def give_up(session: SessionDep, service: ServiceDep, person: PersonDep) -> Answer:
    """Reveal the fault without an answer."""
    return await service.blinds.reveal(session, person)


@router.post(CLASS, dependencies=[RateLimited])
async def hide_for_class(class_id: str, body: HideForAll, service: ServiceDep) -> Outcomes:
    """Give students a new bench each, with a device and a hidden fault of their own."""
    students = await students_of(service, class_id, body.members)
    failed = await begin_for(service.classes, service.blinds, students, body.scenario, body.shows)
    await service.checkpoints.write()  # they are blind after a crash too
    service.audit.add("teacher", "blind", f"hid a fault on {len(students) - len(failed)} benches", class_id)
    return Outcomes(done=len(students) - len(failed), failed=failed)


@router.get(CLASS)
async def get_class_blind(class_id: str, service: ServiceDep) -> BlindClass:
    """List the hidden faults of a class and the answers, with the truth."""
    await service.classes.row(class_id)
    answers = service.blinds.of_class(class_id)
    return BlindClass(rule=RULE, hidden=sum(one.state == "hidden" for one in answers), answers=answers)


@router.delete(CLASS, dependencies=[RateLimited])
async def reveal_class(class_id: str, service: ServiceDep, person: PersonDep) -> Outcomes:
    """Reveal their faults to all students of a class; students without an answer get no points."""
    await service.classes.row(class_id)
    done, failed = 0, []
    for student in service.people.students(class_id):
        session = service.student_benches.find(student)
        blind = blind_of(session) if session is not None else None
        if session is None or blind is None or blind.question.game is not None:
            continue
        try:
            await service.blinds.reveal(session, person)
            done += 1
        except REFUSED as error:
            failed.append(f"{student.name}: {why(error)}")
    service.audit.add("teacher", "blind", f"showed the hidden faults to {done} students", class_id)
    return Outcomes(done=done, failed=failed)
