"""Dependencies of routes: the service, the bench in the path, the rate limit of commands."""

from __future__ import annotations

from typing import Annotated, cast

from fastapi import Depends, Request, WebSocket

from server.bench.session import Session
from server.errors import ApiError
from server.service import Service
from server.settings import Settings


def get_service(request: Request) -> Service:
    """Return the service of the application."""
    return cast(Service, request.app.state.service)


def get_socket_service(socket: WebSocket) -> Service:
    """Return the service of the application, for a WebSocket."""
    return cast(Service, socket.app.state.service)


ServiceDep = Annotated[Service, Depends(get_service)]
SocketServiceDep = Annotated[Service, Depends(get_socket_service)]


def get_session(bench_id: str, service: ServiceDep) -> Session:
    """Return the bench in the path, which somebody asks for so, or refuse with 404."""
    session = service.benches.get(bench_id)
    service.idling.saw(bench_id)
    return session


SessionDep = Annotated[Session, Depends(get_session)]


def get_caller(request: Request) -> str:
    """Name the caller for the event log and the limits by address, because all callers share one token."""
    return f"api {request.client.host}" if request.client else "api"


CallerDep = Annotated[str, Depends(get_caller)]


def check_rate(service: ServiceDep, caller: CallerDep) -> None:
    """Refuse a caller whose commands exceed the rate limit."""
    if not service.commands.take(caller):
        raise rate_limited(service.settings)


def rate_limited(settings: Settings) -> ApiError:
    """Build the refusal of a command beyond the rate limit."""
    rate, burst = settings.command_rate_per_s, settings.command_burst
    text = f"more than {rate:g} commands per second (burst {burst})"
    return ApiError(429, "rate_limited", text, hint="wait a second", headers={"Retry-After": "1"})


RateLimited = Depends(check_rate)
