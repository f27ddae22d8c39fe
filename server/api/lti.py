"""The doors of learning platforms: a launch from its beginning to a session, the choice of an exercise, keys."""

from __future__ import annotations

import hmac
from dataclasses import dataclass
from typing import Annotated, cast
from urllib.parse import parse_qsl, urlencode, urlsplit

from fastapi import APIRouter, Depends, FastAPI, Request, Response
from fastapi.responses import HTMLResponse, JSONResponse, RedirectResponse
from pydantic import BaseModel, Field

from core.errors import InputError
from server.api.bodies import Body, StrictRoute
from server.api.deps import PersonDep, ServiceDep
from server.api.joining import address_of, give_session
from server.api.page import Page
from server.classroom.access import LTI
from server.classroom.lti.exercises import choices, configuration, resource
from server.classroom.lti.keys import KeySets
from server.classroom.lti.launch import Launch
from server.classroom.lti.members import LaunchMembers
from server.classroom.lti.messages import Login, Messages
from server.classroom.lti.pages import answer_page, choice_page, instructor_page, login_page, refusal_page
from server.classroom.lti.scores import LtiScores
from server.classroom.lti.tool import Tool
from server.classroom.sheet_work import brief
from server.errors import ApiError, body_of
from server.security.frames import Frames, Ticket
from server.security.limits import Buckets
from server.security.once import Once
from server.security.person import hash_of
from server.service import Service

LONGEST_FORM = 64 << 10
CODE_S, CHOICE_S = 60.0, 1800.0
LAUNCHES_PER_S, LAUNCHES_AT_ONCE = 20.0, 600
"""Of one address, behind which a whole class may be, each with two requests."""


@dataclass
class Lti:
    """Parts that all doors use."""

    service: Service
    tool: Tool
    messages: Messages
    members: LaunchMembers
    scores: LtiScores
    key_sets: KeySets
    frames: Frames
    launches: Once[tuple[Launch, Login]]
    choices: Once[Launch]
    tries: Buckets

    async def close(self) -> None:
        """Stop sending scores and asking for keys."""
        await self.scores.close()
        self.key_sets.close()


def install(app: FastAPI, service: Service) -> Frames:
    """Add the doors to the application; return the data for the gate and the headers."""
    settings = service.settings
    tool = Tool(settings.lti, settings.data)
    origins = sorted({origin for platform in settings.lti for origin in platform.frames})
    frames = Frames(LTI, " ".join(origins), frozenset({f"{LTI}/login", f"{LTI}/launch"}))
    key_sets = KeySets(service.clock)
    scores = LtiScores(tool, service.audit, lambda work: brief(work, service.sheets.get(work.sheet_id)))
    service.sheets.on_kept = scores.changed
    app.state.lti = Lti(
        service,
        tool,
        Messages(tool, key_sets),
        LaunchMembers(service.database, service.classes, service.people, service.sheets, tool),
        scores,
        key_sets,
        frames,
        Once[tuple[Launch, Login]](CODE_S),
        Once[Launch](CHOICE_S),
        Buckets(LAUNCHES_PER_S, LAUNCHES_AT_ONCE, clock=service.clock),
    )
    app.router.routes += [*router.routes, *pages.routes]
    return frames


def get_lti(request: Request) -> Lti:
    """Return the shared state of the doors."""
    return cast(Lti, request.app.state.lti)


LtiDep = Annotated[Lti, Depends(get_lti)]

router = APIRouter(prefix=LTI, include_in_schema=False, route_class=StrictRoute)
pages = APIRouter(prefix=LTI, include_in_schema=False)


class NewSession(Body):
    """The session of a page after a launch."""

    code: str = Field(max_length=100)
    browser: str = Field(max_length=100, description="The secret that this browser kept when the launch began")
    framed: bool = Field(description="Whether the page is in a frame, where it gets no cookie")


class NewTicket(Body):
    """A path that a browser is to load by itself."""

    path: str = Field(pattern="^/(api|benches)/", max_length=400, description="Without a query")


class Session(BaseModel):
    """A session; only a page in a frame gets its secret, others get a cookie."""

    session: str | None


@pages.get("")
async def show_page(request: Request) -> Response:
    """Return the page, which exchanges the code of a launch for a session."""
    return cast(Page, request.app.state.page).shown(request.scope)


@pages.api_route("/login", methods=["GET", "POST"])
async def begin_launch(request: Request, lti: LtiDep) -> Response:
    """Send a browser to the platform that began a launch, to learn its user."""
    try:
        given = await _parameters(request, lti)
        again = f"{lti.service.public.prefix}{LTI}/login?{urlencode(given)}"
        return login_page(*lti.messages.begin(given, f"{_base(request, lti.service)}{LTI}/launch"), again)
    except ApiError as error:
        return refusal_page(error.status_code, error.body)


@pages.post("/launch")
async def end_launch(request: Request, lti: LtiDep) -> Response:
    """Take the signed message of the platform, and lead on: a learner to the bench, an instructor to a choice."""
    try:
        given = await _parameters(request, lti)
        launch, login = await lti.messages.end(given)
        if launch.is_choice:
            return await _ask_for_choice(launch, lti)
        if launch.is_instructor:
            group = await lti.members.group(launch)
            return instructor_page(group.name, len(lti.service.people.students(group.id)))
        if not launch.is_learner:
            raise ApiError(403, "lti_refused", "only students and instructors of a course have something to do here")
    except (ApiError, InputError) as error:
        status = error.status_code if isinstance(error, ApiError) else 422
        return refusal_page(status, body_of(error))
    code = lti.launches.put((launch, login))
    layout = "?layout=lab" if launch.sheet else ""  # the layout with the sheet next to the bench
    # behind the hash, where no log sees it
    return RedirectResponse(f"{LTI}{layout}#launch={code}&state={given['state']}", 303)


@router.post("/session")
async def make_session(body: NewSession, request: Request, response: Response, lti: LtiDep) -> Session:
    """Exchange the code of a launch for a session, in the browser that began it."""
    found = lti.launches.take(body.code)
    if found is None or not hmac.compare_digest(found[1].browser_hash, hash_of(body.browser)):
        text = "this launch has been used, is too old, or was begun in another browser"
        raise ApiError(403, "lti_refused", text, hint="open the exercise again from your course")
    launch = found[0]
    person, secret = await lti.members.enter(launch)
    works = (work for work in lti.service.sheets.works(person.id) if work.sheet_id == launch.sheet)
    lti.scores.aim(person, launch, next(works, None))
    response.headers["Cache-Control"] = "no-store"
    if body.framed:
        return Session(session=secret)
    give_session(request, response, person, secret)
    return Session(session=None)


@router.post("/ticket")
async def make_ticket(body: NewTicket, person: PersonDep, lti: LtiDep) -> dict[str, str]:
    """Let a browser load one path once without a cookie, if its person may load that path."""
    return {"ticket": lti.frames.tickets.put(Ticket(person, body.path))}


@pages.post("/link")
async def choose(request: Request, lti: LtiDep) -> Response:
    """Send the exercise that an instructor chose to the platform, signed."""
    try:
        given = await _parameters(request, lti)
        launch = lti.choices.take(given.get("code", ""))
        if launch is None:
            raise ApiError(403, "lti_refused", "this choice has been made, or was begun too long ago")
        kind, _, name = given.get("choice", "").partition(":")
        address = f"{_base(request, lti.service)}{LTI}/launch"
        return answer_page(*lti.messages.link(launch, resource(kind, name, address, lti.service.sheets)))
    except ApiError as error:
        return refusal_page(error.status_code, error.body)


@pages.get("/jwks")
async def get_keys(lti: LtiDep) -> JSONResponse:
    """Return the public key of this server."""
    return JSONResponse(lti.tool.key_set())


@pages.get("/configuration")
async def get_configuration(request: Request, service: ServiceDep) -> JSONResponse:
    """Return the configuration for a platform, in the form that Canvas reads; others need the same addresses."""
    return JSONResponse(configuration(f"{_base(request, service)}{LTI}"))


async def _ask_for_choice(launch: Launch, lti: Lti) -> HTMLResponse:
    """Ask an instructor which exercise a link is to lead to."""
    if not launch.is_instructor:
        raise ApiError(403, "lti_refused", "only an instructor of the course chooses exercises")
    back = urlsplit(launch.return_address)
    if back.scheme not in ("http", "https") or not back.hostname:
        raise ApiError(403, "lti_refused", "the platform does not say where the choice goes")
    action = f"{lti.service.public.prefix}{LTI}/link"
    return choice_page(action, lti.choices.put(launch), *choices(lti.service.sheets))


async def _parameters(request: Request, lti: Lti) -> dict[str, str]:
    """Return the parameters of an address or a form, unless too much is tried from where they come."""
    if not lti.tries.take(address_of(request)):
        raise ApiError(429, "rate_limited", "too many launches from here", hint="wait a minute")
    if request.method == "GET":
        return dict(request.query_params)
    body = await request.body()
    if len(body) > LONGEST_FORM:
        raise ApiError(413, "too_large", f"a launch has at most {LONGEST_FORM} bytes")
    return dict(parse_qsl(body.decode("utf-8", "replace")))


def _base(request: Request, service: Service) -> str:
    """Return the address of this server as platforms and browsers know it."""
    return str(service.public) if service.public.origin else f"http://{request.headers['host']}"
