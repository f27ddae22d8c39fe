"""Classes: open one, let students join, look at all benches, do something on all of them."""

from __future__ import annotations

import asyncio

from fastapi import Request, Response
from pydantic import BaseModel, Field

from server.api.benches import NewBench
from server.api.bodies import Body, MemberIds
from server.api.deps import RateLimited, ServiceDep
from server.api.joining import address_of, give_session
from server.api.paging import AgePage
from server.api.router import Router
from server.api.students import Outcomes, refusal, student_of, students_of
from server.bench.commands import Command
from server.classroom.classes import Class
from server.classroom.people import by_arrival
from server.classroom.sheet_work import brief
from server.classroom.tile import Tile, tile_of
from server.security.person import Person
from server.service import Service

router = Router(prefix="/classes", tags=["classes"])

LONGEST_H = 24.0 * 14


class Minutes(Body):
    """The lifetime of a code."""

    minutes: float = Field(120.0, gt=0, le=60 * LONGEST_H, description="Minutes for which the code is valid")


class NewClass(Body):
    """A class, and the start of the benches of its students."""

    name: str = Field(min_length=1, max_length=100)
    bench: NewBench = Field(default_factory=lambda: NewBench(scenario="first-look"))
    hours: float = Field(8.0, gt=0, le=LONGEST_H, description="Hours until the class ends and its students are deleted")
    minutes: float = Field(120.0, gt=0, le=60 * LONGEST_H, description="Minutes for which the first code is valid")


class ClassList(BaseModel):
    """The classes, oldest first."""

    classes: list[Class]


class Join(Body):
    """Code and name of a student."""

    code: str = Field(max_length=40)
    name: str = Field(max_length=200)


class Joined(BaseModel):
    """A session for a program, which sends it as a bearer token; browsers join by the page and get a cookie."""

    id: str
    session: str
    bench: str


class MemberList(BaseModel):
    """The students of a class in the order in which they joined, each with a small picture of the bench."""

    members: list[Tile]


class ForAll(Body):
    """A command to the benches of a class."""

    command: Command
    members: MemberIds = None


@router.post("", status_code=201, dependencies=[RateLimited])
async def open_class(body: NewClass, service: ServiceDep, request: Request, response: Response) -> Class:
    """Open a class; the answer contains its code."""
    await service.benches.check(body.bench.scenario, body.bench.set)
    made = await service.classes.open(body.name, body.bench.wanted(), body.hours, body.minutes)
    response.headers["Location"] = f"/api/v1/classes/{made.id}"
    return _addressed(made, service, request)


@router.get("")
async def list_classes(service: ServiceDep, request: Request, page: AgePage) -> ClassList:
    """List the classes, oldest first."""
    return ClassList(classes=[_addressed(one, service, request) for one in await service.classes.all(page)])


@router.get("/{class_id}")
async def get_class(class_id: str, service: ServiceDep, request: Request) -> Class:
    """Describe a class."""
    return _addressed(await service.classes.get(class_id), service, request)


@router.delete("/{class_id}", status_code=204, dependencies=[RateLimited])
async def end_class(class_id: str, service: ServiceDep) -> None:
    """End a class: close its benches and sessions, and delete the names of its students and the log."""
    await service.classes.end(class_id)


@router.post("/{class_id}/code", dependencies=[RateLimited])
async def make_code(class_id: str, body: Minutes, service: ServiceDep, request: Request) -> Class:
    """Let students join by a new code; an earlier one ends."""
    return _addressed(await service.classes.new_code(class_id, body.minutes), service, request)


@router.delete("/{class_id}/code", dependencies=[RateLimited])
async def end_code(class_id: str, service: ServiceDep, request: Request) -> Class:
    """End the code, so that no further student joins; joined students stay."""
    return _addressed(await service.classes.close_joining(class_id), service, request)


@router.post("/{class_id}/join", status_code=201)
async def join_class(class_id: str, body: Join, request: Request, response: Response, service: ServiceDep) -> Joined:
    """Join a class by its code."""
    person, secret = await service.joining.join(address_of(request), body.code, body.name, class_id)
    try:
        bench = await service.student_benches.get(person)
    except BaseException:
        service.people.drop(person)  # or the name would be taken
        raise
    service.classes.note_joined(person)
    give_session(request, response, person, secret)
    return Joined(id=person.id, session=secret, bench=bench.id)


@router.get("/{class_id}/members", response_model=MemberList)
async def list_members(class_id: str, service: ServiceDep, page: AgePage, response: Response) -> Response:
    """List the students of a class with name, bench, state, verdict, truth and a small trace."""
    await service.classes.row(class_id)
    students = page.cut(service.people.students(class_id), by_arrival)
    found = MemberList(members=[_tile(service, person) for person in students])
    # written at once: checking sixty tiles again takes the loop ten times as long
    return Response(found.model_dump_json(), media_type="application/json", headers=dict(response.headers))


@router.delete("/{class_id}/members/{member_id}", status_code=204, dependencies=[RateLimited])
async def remove_member(class_id: str, member_id: str, service: ServiceDep) -> None:
    """Remove a student from a class: the session ends at once, and the bench is closed."""
    await service.classes.remove(await student_of(service, class_id, member_id))


@router.post("/{class_id}/commands", dependencies=[RateLimited])
async def command_all(class_id: str, body: ForAll, service: ServiceDep) -> Outcomes:
    """Carry out a command on the benches of all students or some at their next tick edges, no matter who drives."""
    students = await students_of(service, class_id, body.members)

    async def command(person: Person) -> None:
        session = await service.student_benches.get(person)
        await service.benches.command(session, body.command, "teacher")

    return Outcomes.of(await asyncio.gather(*(refusal(person, command(person)) for person in students)))


@router.post("/{class_id}/scenario", dependencies=[RateLimited])
async def begin_scenario(class_id: str, body: NewBench, service: ServiceDep) -> Outcomes:
    """Begin a scenario on the benches of all students; students who join later begin with it too."""
    await service.benches.check(body.scenario, body.set)
    failed = await service.classes.begin_all(class_id, body.wanted())
    return Outcomes(done=len(service.people.students(class_id)) - len(failed), failed=failed)


def _tile(service: Service, person: Person) -> Tile:
    """Show a student."""
    session = service.student_benches.find(person)
    # a student who watches a bench that is shown to all is present too
    watchers = max(service.hub.watchers(session.id) if session is not None else 0, service.hub.pages_of(person))
    work = service.sheets.current(person)
    tile = tile_of(person, session, watchers, hand=person.id in service.people.hands)
    done = {"blind": service.blinds.last_of(person.id), "sheet": brief(*work) if work is not None else None}
    return tile.model_copy(update=done)


def _addressed(group: Class, service: Service, request: Request) -> Class:
    """Add the addresses that students open from elsewhere."""
    if group.path is None:
        return group
    found = [f"{service.public}{group.path}"] if service.public.origin else []
    if service.settings.classroom:
        from server.classroom.addresses import join_addresses

        pages = join_addresses(service.settings.host, request.scope["server"][1])
        found = [f"{page}{group.path.removeprefix('/join')}" for page in pages]
    return group.model_copy(update={"addresses": found})
