"""Doors that need no session: the page to join a class, and links to watch."""

from __future__ import annotations

from typing import Annotated, cast
from urllib.parse import parse_qsl, urlencode

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import HTMLResponse, RedirectResponse

from server.api.deps import IdentityDep, ServiceDep
from server.api.gate import lead_on, plain_page, wants_page
from server.classroom.joining import join_page
from server.errors import ApiError, reply
from server.security.identity import Identity
from server.security.person import TEACHER, Person
from server.security.visitor import visitor_page
from server.service import Service
from server.store.base import now

router = APIRouter(include_in_schema=False)

LONGEST_FORM = 4096
"""Bytes of the form that are read: a code and a name."""
FORM = {"Cache-Control": "no-store", "Referrer-Policy": "same-origin"}
"""Without a referrer a browser gives the form no origin (`Origin: null`), and it would be refused."""
NO_WATCHING = ApiError(
    403,
    "wrong_link",
    "this link does not let you watch, or no longer does",
    "link",
    "ask for a new one: links to watch end after a while, or when the bench is closed",
)


@router.get("/join")
async def show_join_page(service: ServiceDep, code: Annotated[str, Query(max_length=40)] = "") -> HTMLResponse:
    """Ask for the code and a name."""
    return HTMLResponse(join_page(_action(service), code), headers=FORM)


@router.post("/join")
async def join(request: Request, service: ServiceDep) -> Response:
    """Let a student in, and lead to the page."""
    form = dict(parse_qsl((await request.body())[:LONGEST_FORM].decode("utf-8", "replace")))
    code, name = form.get("code", "")[:40], form.get("name", "")[:200]
    try:
        person, secret = await service.joining.join(address_of(request), code, name)
    except ApiError as error:
        text = join_page(_action(service), code, name, error.body)
        return HTMLResponse(text, error.status_code, {**FORM, **(error.headers or {})})
    service.classes.note_joined(person)
    response = RedirectResponse("/", 303)
    give_session(request, response, person, secret)
    return response


@router.get("/watch/{secret}")
async def watch(secret: str, request: Request, service: ServiceDep, identity: IdentityDep) -> Response:
    """Let a person with a link to watch see its bench, and lead to the page."""
    return _let_watch(request, service, identity, secret)


@router.get("/watch")
async def watch_by_link(
    link: Annotated[str, Query(max_length=64)], request: Request, service: ServiceDep, identity: IdentityDep
) -> Response:
    """Let a person without the token watch the bench of a shared link, if the teacher allows it."""
    if request.scope["person"] == TEACHER:  # the refusal required the token, and got it
        return RedirectResponse(f"/?{urlencode({'link': link})}", 303)
    return _let_watch(request, service, identity, identity.secret_of_link(link))


def _let_watch(request: Request, service: Service, identity: Identity, secret: str) -> Response:
    """Begin the session that a secret opens, or refuse it; too many that are wrong come from no address."""
    person = service.people.by_secret(secret)
    if person is not None and person.role == "watcher":
        response = lead_on(request, "/", service.public.prefix)
        give_session(request, response, person, secret)
        return response
    refusal = NO_WATCHING
    try:
        service.joining.note_wrong(address_of(request))
    except ApiError as error:
        refusal = error
    status, said, headers = refusal.status_code, refusal.body, {"Cache-Control": "no-store", **(refusal.headers or {})}
    if not wants_page(request):
        return reply(status, said, headers)
    text = plain_page(status, said.message, f"{said.hint.capitalize()}.")
    if refusal is NO_WATCHING and "link" in request.query_params:  # the token opens it all the same
        given, join = request.query_params.multi_items(), f"{service.public.prefix}/join"
        why = f"{said.message.capitalize()}. {said.hint.capitalize()}."
        text = visitor_page(given, identity.may_use_token(request), join, why)
    return HTMLResponse(text, status, headers)


def give_session(request: Request, response: Response, person: Person, secret: str) -> None:
    """Let a browser come in again until the session ends."""
    seconds = (person.until - now()).total_seconds() if person.until is not None else 0.0
    cast(Identity, request.app.state.identity).give_session(response, secret, seconds)
    response.headers["Cache-Control"] = "no-store"


def address_of(request: Request) -> str:
    """Return where a request comes from."""
    return cast(Service, request.app.state.service).callers.address(request)


def _action(service: ServiceDep) -> str:
    """Return the path of the form, with the prefix that a proxy takes off."""
    return f"{service.public.prefix}/join"
