"""A lesson: a bench and a layout for all students of a class, all benches started together, hands lowered."""

from __future__ import annotations

from pydantic import Field

from server.api.bodies import Body, MemberIds
from server.api.deps import PersonDep, RateLimited, ServiceDep
from server.api.router import Router
from server.api.students import Outcomes, student_of, students_of
from server.bench.recording import Layout
from server.classroom.lesson import GivenLayout, start_together
from server.errors import ApiError, not_found

router = Router(tags=["classes"])


class Shown(Body):
    """The bench that all are to see."""

    bench: str = Field(max_length=64, description="Id of a live bench")


class NewLayout(Body):
    """A layout for all."""

    name: str = Field(min_length=1, max_length=60)
    layout: Layout = Field(None, description="Layout as the page writes it; null: the built-in layout of this name")


class Some(Body):
    """The students whose benches start."""

    members: MemberIds = None


@router.put("/classes/{class_id}/shown", status_code=204, dependencies=[RateLimited])
async def show_bench(class_id: str, body: Shown, service: ServiceDep) -> None:
    """Show a bench to all students of a class; they cannot change it, and they keep their own benches."""
    await service.classes.row(class_id)
    if (session := service.benches.find(body.bench)) is None:
        raise ApiError(422, "invalid", f"there is no bench '{body.bench}'", "bench")
    await service.lesson.show(class_id, session.id, session.scenario.head.title or session.scenario.id)


@router.delete("/classes/{class_id}/shown", status_code=204, dependencies=[RateLimited])
async def end_showing(class_id: str, service: ServiceDep) -> None:
    """Let the students of a class see their own benches again."""
    await service.classes.row(class_id)
    await service.lesson.end_showing(class_id)


@router.put("/classes/{class_id}/layout", status_code=204, dependencies=[RateLimited])
async def give_layout(class_id: str, body: NewLayout, service: ServiceDep) -> None:
    """Arrange the panels of all students of a class; each can go back to the own layout."""
    await service.classes.row(class_id)
    await service.lesson.give_layout(class_id, body.name, body.layout)


@router.get("/me/layout")
async def get_layout(person: PersonDep, service: ServiceDep) -> GivenLayout:
    """Return the layout that the class of a student was given last."""
    given = service.lesson.layout_for(person)
    if given is None:
        raise not_found("layout given to", person.name)
    return given


@router.delete("/classes/{class_id}/members/{member_id}/hand", status_code=204, dependencies=[RateLimited])
async def lower_hand(class_id: str, member_id: str, service: ServiceDep) -> None:
    """Take down the hand of a student."""
    service.lesson.lower_hand(await student_of(service, class_id, member_id))


@router.post("/classes/{class_id}/start", dependencies=[RateLimited])
async def start_all(class_id: str, body: Some, service: ServiceDep) -> Outcomes:
    """Start the benches of all students or of some together, from tick 0.

    A bench that is not paused at tick 0 is reset. When all are paused there, they begin between the same two slices of
    the engine: benches of the same time scale are at the same tick from then on.
    """
    students = await students_of(service, class_id, body.members)
    sessions = [service.student_benches.find(person) for person in students]
    reasons = await start_together(service.benches, service.engine, sessions, "teacher")
    pairs = zip(students, reasons, strict=True)
    return Outcomes.of([reason and f"{person.name}: {reason}" for person, reason in pairs])
