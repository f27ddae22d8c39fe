"""The gate in front of every route and socket: Host, Origin, who it is, and whether that person may."""

from __future__ import annotations

import asyncio
import contextlib
import html
from collections import Counter
from urllib.parse import urlencode

from starlette.requests import HTTPConnection, Request
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.websockets import WebSocket

from core.own.admission import Terms, admit
from server.classroom.access import SOCKET, Need, need_of, serves_blind
from server.classroom.hiding import HINT, REFUSAL
from server.computing.asker import asks
from server.errors import ApiError, ErrorBody, reply
from server.security.frames import TICKET, Frames
from server.security.identity import Identity, bearer_of
from server.security.limits import Buckets
from server.security.origin import OriginPolicy
from server.security.person import TEACHER, Person
from server.security.visitor import ELSEWHERE, page, visitor_page
from server.service import Service

CLOSE_ORIGIN, CLOSE_AUTH, CLOSE_ROLE, CLOSE_FULL = 4003, 4401, 4403, 1013
REQUESTS_PER_S, REQUESTS_AT_ONCE = 40.0, 400
"""Requests of one student or link to watch; a page sends some fifty when it opens, a link may serve a whole room."""
BYTES_OF_REQUEST = 20_000
"""So many bytes of a body count as one more request: reading them takes the server's loop as long."""
LARGE = 1 << 20
"""Most bytes that are counted of a body."""
MOST_SOCKETS = 8
"""Open streams and 3D views of one student."""

WHOSE = {Need.TEACHER: "the teacher", Need.MEMBER: "the teacher or a student"}
WAY_IN = (
    "CombBench printed an address with a token when it started; open that one. "
    "`combbench doctor` says where the token is kept."
)


class Gate:
    """Admits only persons known to the server, within their rights, from this server's own page.

    Parameters
    ----------
    app : ASGIApp
        The application to guard.
    identity : Identity
        Knows the teacher.
    origin : OriginPolicy
        Checks the host and the origin.
    service : Service
        Holds all other persons and their rights, the drivers and hidden faults of benches, and the settings. A request
        revives its bench after a restart, so that a hidden fault stays hidden from the first request on.
    frames : Frames, optional
        The doors of learning platforms, if there are any.
    """

    def __init__(
        self,
        app: ASGIApp,
        identity: Identity,
        origin: OriginPolicy,
        service: Service,
        frames: Frames | None = None,
    ) -> None:
        self._app, self._identity, self._origin, self._service, self._frames = app, identity, origin, service, frames
        self._people, self._settings, self._prefix = service.people, service.settings, service.public.prefix
        self._requests = Buckets(REQUESTS_PER_S, REQUESTS_AT_ONCE, clock=service.clock)
        self._sockets: Counter[str] = Counter()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check a request, then pass it on or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        connection = HTTPConnection(scope)
        person = scope["person"] = self._person(connection)
        admit(self._terms(person))
        asks(person)
        is_post_of_others = scope["type"] == "http" and self._frames is not None and scope["path"] in self._frames.posts
        refusal = self._origin.refusal(connection, self._has_bearer(connection), is_post_of_others)
        if refusal:
            await self._refuse(scope, receive, send, 403, CLOSE_ORIGIN, "forbidden_origin", refusal)
            return
        if scope["type"] == "http" and scope["method"] == "GET":
            if self._identity.has_token_in_address(connection):
                await self._welcome(Request(scope))(scope, receive, send)
                return
            link = connection.query_params.get("link")
            if link and scope["path"] == "/" and (person is None or person.role == "watcher"):
                target = f"/watch?{urlencode({'link': link})}"
                await lead_on(Request(scope), target, self._prefix)(scope, receive, send)
                return
        method = SOCKET if scope["type"] == "websocket" else scope["method"]
        need, bench_id = need_of(method, scope["path"])
        if self._is_open(scope) or self._people.may(person, need, bench_id):
            if person is not None and need is not Need.NOTHING:
                await self._service.come_back(person, bench_id)
            is_blind = person is not None and self._service.views.is_blind(person, bench_id)
            if is_blind and not serves_blind(method, scope["path"]):
                await self._refuse(scope, receive, send, 403, CLOSE_ROLE, "blind", REFUSAL, HINT)
                return
            try:
                if need is Need.DRIVE and person is not None:
                    self._service.driving.check(bench_id, person)
            except ApiError as error:
                await reply(error.status_code, error.body)(scope, receive, send)
            else:
                await self._pass(scope, receive, send, person, need, bench_id)
        elif person is None:
            await self._refuse(scope, receive, send, 401, CLOSE_AUTH, "unauthorised", "an access token is needed")
        else:
            whose = WHOSE.get(need, "the person who has this bench")
            await self._refuse(scope, receive, send, 403, CLOSE_ROLE, "forbidden", f"only {whose} may do that")

    def _person(self, connection: HTTPConnection) -> Person | None:
        """Return the person; an explicit secret counts before a cookie."""
        if self._frames is not None and (ticket := connection.query_params.get(TICKET)):
            return self._frames.holder(ticket, connection.scope["path"])
        if (person := self._people.by_secret(bearer_of(connection))) is not None:
            return person
        if self._identity.knows(connection):
            return TEACHER
        return self._people.by_secret(self._identity.session_of(connection))

    def _terms(self, person: Person | None) -> Terms:
        """Return the terms on which scenarios of this person are read."""
        is_teacher = person is not None and person.is_teacher
        return Terms(self._units_refused(person), None if is_teacher else self._settings.student_events)

    def _units_refused(self, person: Person | None) -> str:
        """Return why this person may not bring units of their own; nothing where they may."""
        if self._settings.units == "off":
            return "this server takes no user units"
        if person is not None and (person.is_teacher or self._settings.units == "everyone"):
            return ""
        return "only the teacher may bring units of their own"

    def _is_open(self, scope: Scope) -> bool:
        """Whether a path needs no session; in a frame browsers send none with the files of the page."""
        is_file = scope["path"].startswith(("/assets/", "/comb.svg")) and scope.get("method") in ("GET", "HEAD")
        is_metrics = self._settings.metrics_open and scope["path"] == "/metrics"
        return is_metrics or (self._frames is not None and is_file)

    def _has_bearer(self, connection: HTTPConnection) -> bool:
        """Whether a secret that is known came as a bearer."""
        return self._identity.has_bearer(connection) or self._people.by_secret(bearer_of(connection)) is not None

    async def _pass(
        self, scope: Scope, receive: Receive, send: Send, person: Person | None, need: Need, bench_id: str
    ) -> None:
        """Pass a request on, unless a student sends too many at once; a socket lasts no longer than the right."""
        if person is None or person.is_teacher:
            await self._app(scope, receive, send)
        elif scope["type"] == "websocket":
            await self._pass_socket(scope, receive, send, person, need, bench_id)
        elif self._requests.take(person.id, 1.0 + _length(scope) / BYTES_OF_REQUEST):
            await self._app(scope, receive, send)
        else:
            await self._refuse(scope, receive, send, 429, 0, "rate_limited", "too many requests; wait a second")

    async def _pass_socket(
        self, scope: Scope, receive: Receive, send: Send, person: Person, need: Need, bench_id: str
    ) -> None:
        """Pass a socket on until it ends, or the session does, or the right to this bench."""
        if person.role == "student" and self._sockets[person.id] >= MOST_SOCKETS:
            text = f"{MOST_SOCKETS} pages of yours are open; close one"
            await self._refuse(scope, receive, send, 503, CLOSE_FULL, "limit", text)
            return

        async def close_when_gone() -> None:
            is_over = await self._people.until_refused(person, need, bench_id)
            code, why = (
                (CLOSE_AUTH, "your session has ended") if is_over else (CLOSE_ROLE, "you see this bench no longer")
            )
            with contextlib.suppress(RuntimeError):  # it has been closed meanwhile
                await send({"type": "websocket.close", "code": code, "reason": why})

        closing = asyncio.create_task(close_when_gone())
        self._sockets[person.id] += 1
        try:
            await self._app(scope, receive, send)
        finally:
            closing.cancel()
            self._sockets[person.id] -= 1
            self._sockets += Counter()  # forgets those at 0

    def _welcome(self, request: Request) -> Response:
        """Exchange the token in the address for a cookie, and take it out of the address."""
        given = request.query_params.multi_items()
        rest = [(name, value) for name, value in given if name != "token"]
        # Leading slashes are folded: "//evil.example" would be an address of another host.
        path = request.url.path.lstrip("/\\")
        target = f"/{path}" + ("?" + urlencode(rest) if rest else "")
        response = lead_on(request, target, self._prefix)
        self._identity.give_cookie(response)
        response.headers["Cache-Control"] = "no-store"
        return response

    async def _refuse(
        self,
        scope: Scope,
        receive: Receive,
        send: Send,
        status: int,
        close: int,
        code: str,
        message: str,
        advice: str = "",
    ) -> None:
        """Refuse in a form that suits the caller: a page for people, JSON for programs, a close code for sockets."""
        if scope["type"] == "websocket":
            # A browser hides the status of a failed handshake from the page, so the socket is opened to
            # be closed with a code; another site's page (403) is refused before that.
            socket = WebSocket(scope, receive, send)
            if close != CLOSE_ORIGIN:
                await socket.accept(subprotocol=next(iter(socket.scope["subprotocols"]), None))
            await socket.close(close, message)
            return
        connection = HTTPConnection(scope)
        may_use_token = self._identity.may_use_token(connection)
        response: Response
        if wants_page(connection) and not scope["path"].startswith("/api/"):
            query = connection.query_params.multi_items()
            text = plain_page(status, message, "")
            if status == 401:
                text = visitor_page(query, may_use_token, f"{self._prefix}/join")
            response = HTMLResponse(text, status, {"Cache-Control": "no-store"})
        else:
            hint = WAY_IN if may_use_token else ELSEWHERE
            body = ErrorBody(code=code, message=message, hint=hint if status == 401 else advice)
            response = reply(status, body, {"WWW-Authenticate": "Bearer"} if status == 401 else None)
        await response(scope, receive, send)


def wants_page(connection: HTTPConnection) -> bool:
    """Whether the caller is a browser that a person looks at, rather than a program."""
    return "text/html" in connection.headers.get("accept", "")


def lead_on(request: Request, target: str, prefix: str) -> Response:
    """Lead a browser on to a path, so that the cookie it is given on the way comes along."""
    if request.headers.get("sec-fetch-site") != "cross-site":
        return RedirectResponse(target, 303)
    # After a link on another site a strict cookie is not sent with a redirect; it is with a navigation that our own
    # page starts.
    return HTMLResponse(f'<meta http-equiv="refresh" content="0;url={html.escape(prefix + target)}">')


def plain_page(status: int, title: str, text: str) -> str:
    """Build a plain page for a person: a title and one line."""
    return page(title[:1].upper() + title[1:], f"<p>{html.escape(text)}</p><p><small>{status}</small></p>")


def _length(scope: Scope) -> int:
    """Return the length that a body declares; a body in pieces declares none, and counts as large."""
    headers = dict(scope["headers"])
    said = headers.get(b"content-length", b"")
    return min(int(said), LARGE) if said.isdigit() else LARGE if b"transfer-encoding" in headers else 0
