"""The user: the page shows the rights of a teacher, a student and a watcher."""

from __future__ import annotations

from pydantic import BaseModel, Field

from server.api.bodies import Body
from server.api.deps import PersonDep, ServiceDep
from server.api.documents import is_built
from server.api.router import Router
from server.classroom.votes import OpenVote
from server.errors import ApiError
from server.security.person import Role

router = Router(prefix="/me", tags=["classes"])


class Me(BaseModel):
    """The user of the request."""

    id: str = Field(description="Id of the user, as in the company of a bench")
    role: Role
    name: str
    bench: str | None = Field(description="Id of the bench of a student or a watcher; null for the teacher")
    class_id: str | None = Field(None, description="Id of the class of a student")
    class_name: str | None = None
    hand: bool = Field(False, description="Whether a student has raised a hand")
    shown: str | None = Field(None, description="Id of the bench that the teacher shows to the class of a student")
    lent: str | None = Field(None, description="Id of the bench of the teacher that a student drives")
    layout: str | None = Field(None, description="Id of the last layout given to the class; /me/layout returns it")
    vote: OpenVote | None = Field(None, description="The open question to the class of a student")
    documents: bool = Field(default_factory=is_built, description="Whether the server shows the documents, at /docs")


class Hand(Body):
    """The hand of a student."""

    raised: bool = Field(description="Whether the hand is raised")


@router.get("")
async def get_me(person: PersonDep, service: ServiceDep) -> Me:
    """Return the user; a student whose bench is missing gets it here."""
    if person.role != "student":
        return Me(id=person.id, role=person.role, name=person.name, bench=service.people.bench_of(person) or None)
    given = service.lesson.layout_for(person)
    group, session = await service.classes.get(person.class_id), await service.student_benches.get(person)
    return Me(
        id=person.id,
        role=person.role,
        name=person.name,
        bench=session.id,
        class_id=group.id,
        class_name=group.name,
        hand=person.id in service.people.hands,
        shown=service.people.shown_to(person.class_id) or None,
        lent=service.people.lent_to(person) or None,
        layout=given.id if given is not None else None,
        vote=await service.votes.of(person),
    )


@router.put("/hand")
async def raise_hand(body: Hand, person: PersonDep, service: ServiceDep) -> Me:
    """Raise a hand, or take it down; the teacher sees it."""
    if person.role != "student":
        raise ApiError(403, "forbidden", "only a student of a class has a hand to raise")
    me = await get_me(person, service)
    (service.people.hands.add if body.raised else service.people.hands.discard)(person.id)
    return me.model_copy(update={"hand": body.raised})
