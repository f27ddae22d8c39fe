"""Doors that need no session: the page to join a class, and links to watch."""

from __future__ import annotations

from typing import Annotated, cast
from urllib.parse import parse_qsl

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import HTMLResponse, RedirectResponse

from server.api.deps import ServiceDep
from server.errors import SHARD, ApiError, Elsewhere
from server.people.code import shard_of
from server.people.joining import join_page
from server.people.person import Person
from server.security.gate import lead_on, page
from server.security.identity import Identity
from server.service import Service
from server.store.base import now

router = APIRouter(include_in_schema=False)

LONGEST_FORM = 4096
"""Bytes of the form that are read: a code and a name."""
FORM = {"Cache-Control": "no-store", "Referrer-Policy": "same-origin"}
"""Without a referrer a browser says that the form comes from nowhere (`Origin: null`), and it would be refused."""


@router.get("/join")
async def show_join_page(service: ServiceDep, code: Annotated[str, Query(max_length=40)] = "") -> HTMLResponse:
    """Ask for the code and a name."""
    return HTMLResponse(join_page(_action(service), code), headers=FORM)


@router.post("/join")
async def join(request: Request, service: ServiceDep) -> Response:
    """Let a student in, and lead to the page."""
    form = dict(parse_qsl((await request.body())[:LONGEST_FORM].decode("utf-8", "replace")))
    code, name = form.get("code", "")[:40], form.get("name", "")[:200]
    here, meant = service.settings.shard, shard_of(code)
    if here and meant not in ("", here, request.query_params.get(SHARD)):
        raise Elsewhere(meant)
    try:
        person, secret = await service.joining.join(address_of(request), code, name)
    except ApiError as error:
        text = join_page(_action(service), code, name, error.body)
        return HTMLResponse(text, error.status_code, {**FORM, **(error.headers or {})})
    service.classes.note_joined(person)
    response = RedirectResponse("/", 303)
    give_session(request, response, person, secret)
    return response


@router.get("/watch/{link}")
async def watch(link: str, request: Request, service: ServiceDep) -> Response:
    """Let somebody with a link watch its bench, and lead to the page."""
    person = service.people.by_secret(link)
    if person is None or person.role != "watcher":
        try:
            service.joining.note_wrong(address_of(request))
        except ApiError as error:
            status = error.status_code
            return HTMLResponse(page(status, "Too many tries", "Wait a minute."), status, error.headers)
        text = "Ask for a new one: links to watch end after a while, or when the bench is closed."
        return HTMLResponse(page(404, "This link leads nowhere any more", text), 404)
    response = lead_on(request, "/", service.public.prefix)
    give_session(request, response, person, link)
    return response


def give_session(request: Request, response: Response, person: Person, secret: str) -> None:
    """Let a browser come in again until the session ends."""
    seconds = (person.until - now()).total_seconds() if person.until is not None else 0.0
    cast(Identity, request.app.state.identity).give_session(response, secret, seconds)
    response.headers["Cache-Control"] = "no-store"


def address_of(request: Request) -> str:
    """Return where a request comes from."""
    return cast(Service, request.app.state.service).callers.address(request)


def _action(service: ServiceDep) -> str:
    """Return the path of the form, with the prefix that a proxy takes off; it leads back to this process."""
    here = f"?{SHARD}={service.settings.shard}" if service.settings.shard else ""
    return f"{service.public.prefix}/join{here}"
