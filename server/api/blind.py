"""Hidden faults: begin one, answer, give up; for a class, begin for all, look at the answers, reveal."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field

from server.api.bodies import Body, MemberIds, Source
from server.api.deps import PersonDep, RateLimited, ServiceDep, SessionDep
from server.api.router import Router
from server.api.students import Outcomes, refusal, students_of
from server.bench.bench import LiveBench
from server.bench.status import HiddenQuestion
from server.classroom.blind_class import begin_for
from server.classroom.blinds import Answer
from server.classroom.hiding import blind_of
from server.errors import ApiError

router = Router(tags=["blind"])

BENCH = "/benches/{bench_id}/blind"
CLASS = "/classes/{class_id}/blind"
RULE = (
    "A right answer that is 100 % sure earns 100 points, a wrong one loses more than 100. No answer, and an answer "
    "that is no surer than a guess, earns 0. On average you earn most by saying how sure you really are."
)

Shows = Annotated[bool, Field(description="Show the diagnosers; the question is then whether to trust them")]


class Hide(Body):
    """A fault to hide on the user's own bench."""

    seed: int = Field(ge=0, le=2**53, description="Equal seeds hide equal faults, except in a class")
    shows: Shows = False


class Said(Body):
    """The presumed fault of the device, and the confidence."""

    said: str = Field(max_length=24, description="Name of the hypothesis")
    confidence: float = Field(ge=0, le=1, description="Probability, in the opinion of the user, that it is right")


class Blindness(BaseModel):
    """The hidden fault of a bench, and the answers before."""

    question: HiddenQuestion | None = Field(description="The hidden fault to find; null while no fault is hidden")
    rule: str = Field(description="Rule of the points, in words")
    answers: list[Answer] = Field(description="Earlier answers with the truth, oldest first")


class HideForAll(Body):
    """A question to the students of a class."""

    scenario: Source = "ch5-seven-step"
    shows: Shows = False
    members: MemberIds = None


class BlindClass(BaseModel):
    """The hidden faults of the students of a class, and their answers."""

    rule: str
    hidden: int = Field(description="Number of students who have not answered yet")
    answers: list[Answer] = Field(description="Answers and truths, oldest first, also of faults still hidden")


@router.get(BENCH)
async def get_blind(session: SessionDep, service: ServiceDep, person: PersonDep) -> Blindness:
    """Return the question of a bench, and the answers so far."""
    answers = service.blinds.of_person(person.id)
    return Blindness(question=_question(session), rule=RULE, answers=answers)


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
    """Make a new bench for each student; device and hidden fault differ from student to student."""
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
    refusals = []
    for student in service.people.students(class_id):
        session = service.student_benches.find(student)
        if session is not None and _question(session) is not None:
            refusals.append(await refusal(student, service.blinds.reveal(session, person)))
    outcomes = Outcomes.of(refusals)
    service.audit.add("teacher", "blind", f"showed the hidden faults to {outcomes.done} students", class_id)
    return outcomes


def _question(session: LiveBench) -> HiddenQuestion | None:
    """Return the question of a bench where a fault is hidden; a game has a question of its own."""
    blind = blind_of(session)
    return blind.question if blind is not None and blind.question.game is None else None
