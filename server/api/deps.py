"""Dependencies of routes: the service, the bench in the path, the rate limit of commands."""

from __future__ import annotations

from typing import Annotated, cast

from fastapi import Depends, Request
from starlette.requests import HTTPConnection

from server.bench.bench import LiveBench, Seen
from server.errors import ApiError
from server.security.identity import Identity
from server.security.person import Person
from server.service import Service
from server.settings import Settings


def get_service(connection: HTTPConnection) -> Service:
    """Return the service of the application."""
    return cast(Service, connection.app.state.service)


ServiceDep = Annotated[Service, Depends(get_service)]


def get_identity(request: Request) -> Identity:
    """Return the holder of the access token, and of secrets that are made from it."""
    return cast(Identity, request.app.state.identity)


IdentityDep = Annotated[Identity, Depends(get_identity)]


def get_session(bench_id: str, service: ServiceDep) -> LiveBench:
    """Return the bench in the path and note its use, or refuse with 404."""
    session = service.benches.get(bench_id)
    service.idling.saw(bench_id)
    return session


SessionDep = Annotated[LiveBench, Depends(get_session)]


def get_person(connection: HTTPConnection) -> Person:
    """Return whom the gate has let in."""
    return cast(Person, connection.scope["person"])


PersonDep = Annotated[Person, Depends(get_person)]


def get_caller(request: Request, person: PersonDep, service: ServiceDep) -> str:
    """Name the caller for the event log: a student by name, the teacher by address, as all programs share one token."""
    if not person.is_teacher:
        return person.name
    return f"api {service.callers.address(request)}".rstrip()


def get_seen(session: SessionDep, service: ServiceDep, person: PersonDep) -> Seen:
    """Return the bench in the path as the caller may see it."""
    return service.views.seen(session, person)


SeenDep = Annotated[Seen, Depends(get_seen)]
CallerDep = Annotated[str, Depends(get_caller)]


def check_rate(service: ServiceDep, caller: CallerDep, person: PersonDep) -> None:
    """Refuse a caller whose commands exceed the rate limit."""
    if not service.commands.take(caller if person.is_teacher else person.id):
        raise rate_limited(service.settings)


def rate_limited(settings: Settings) -> ApiError:
    """Build the refusal of a command beyond the rate limit."""
    rate, burst = settings.command_rate_per_s, settings.command_burst
    text = f"more than {rate:g} commands per second (burst {burst})"
    return ApiError(429, "rate_limited", text, hint="wait a second", headers={"Retry-After": "1"})


RateLimited = Depends(check_rate)
