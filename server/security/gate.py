"""The gate in front of every route and socket: Host, Origin, token."""

from __future__ import annotations

import html
from urllib.parse import urlencode

from starlette.requests import HTTPConnection, Request
from starlette.responses import HTMLResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.websockets import WebSocket

from server.errors import ErrorBody, reply
from server.security.identity import Identity
from server.security.origin import OriginPolicy
from server.security.visitor import visitor_page

OPEN_PATHS = frozenset({"/health/live", "/health/ready"})
"""Paths answered without a token, because a container's health check has none; they say which parts are well."""

CLOSE_ORIGIN, CLOSE_AUTH = 4003, 4401

WAY_IN = (
    "CombBench printed an address with a token when it started; open that one. "
    "`combbench doctor` says where the token is kept."
)


class Gate:
    """Lets through only callers with the token whose requests come from this server's own page.

    Parameters
    ----------
    app : ASGIApp
        The application to guard.
    identity : Identity
        Checks the token.
    origin : OriginPolicy
        Checks the host and the origin.
    open_paths : frozenset of str
        Paths that need no token.
    prefix : str
        The prefix a proxy takes off every path.
    """

    def __init__(
        self, app: ASGIApp, identity: Identity, origin: OriginPolicy, open_paths: frozenset[str], prefix: str = ""
    ) -> None:
        self._app, self._identity, self._origin = app, identity, origin
        self._open, self._prefix = open_paths, prefix

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check a request, then pass it on or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        connection = HTTPConnection(scope)
        refusal = self._origin.refusal(connection, self._identity.has_bearer(connection))
        if refusal:
            await self._refuse(scope, receive, send, 403, CLOSE_ORIGIN, "forbidden_origin", refusal)
            return
        if scope["type"] == "http" and scope["method"] == "GET":
            token = connection.query_params.get("token", "")
            if token and self._identity.is_token(token):
                await self._welcome(Request(scope))(scope, receive, send)
                return
        if scope["path"] in self._open or self._identity.knows(connection):
            await self._app(scope, receive, send)
            return
        await self._refuse(scope, receive, send, 401, CLOSE_AUTH, "unauthorised", "an access token is needed")

    def _welcome(self, request: Request) -> Response:
        """Exchange the token in the address for a cookie, and take it out of the address."""
        rest = [(name, value) for name, value in request.query_params.multi_items() if name != "token"]
        # Leading slashes are folded: "//evil.example" would be an address of another host.
        path = request.url.path.lstrip("/\\")
        target = f"/{path}" + ("?" + urlencode(rest) if rest else "")
        response: Response = RedirectResponse(target, 303)
        if request.headers.get("sec-fetch-site") == "cross-site":
            # After a link on another site a strict cookie is not sent with the redirect; it is with a
            # navigation that our own page starts.
            refresh = f'<meta http-equiv="refresh" content="0;url={html.escape(self._prefix + target)}">'
            response = HTMLResponse(refresh)
        self._identity.give_cookie(response)
        response.headers["Cache-Control"] = "no-store"
        return response

    async def _refuse(
        self, scope: Scope, receive: Receive, send: Send, status: int, close: int, code: str, message: str
    ) -> None:
        """Refuse in a form that suits the caller: a page for people, JSON for programs, a close code for sockets."""
        if scope["type"] == "websocket":
            # A browser hides the status of a failed handshake from the page, so the socket is opened to
            # be closed with a code; another site's page (403) is refused before that.
            socket = WebSocket(scope, receive, send)
            if status != 403:
                await socket.accept(subprotocol=next(iter(socket.scope["subprotocols"]), None))
            await socket.close(close, message)
            return
        connection = HTTPConnection(scope)
        wants_page = "text/html" in connection.headers.get("accept", "")
        response: Response
        if wants_page and not scope["path"].startswith("/api/"):
            text = visitor_page(connection.query_params.multi_items()) if status == 401 else page(status, message, "")
            response = HTMLResponse(text, status, {"Cache-Control": "no-store"})
        else:
            body = ErrorBody(code=code, message=message, hint=WAY_IN if status == 401 else "")
            response = reply(status, body, {"WWW-Authenticate": "Bearer"} if status == 401 else None)
        await response(scope, receive, send)


def page(status: int, title: str, text: str) -> str:
    """Build a plain page for a person: a title and one line."""
    return (
        "<!doctype html><html lang='en'><meta charset='utf-8'>"
        "<meta name='viewport' content='width=device-width'><title>CombBench</title>"
        "<body style='font:16px/1.6 system-ui;max-width:36rem;margin:18vh auto;padding:0 1.5rem'>"
        f"<h1 style='font-size:1.25rem'>{html.escape(title[:1].upper() + title[1:])}</h1>"
        f"<p>{html.escape(text)}</p><p style='color:#777'>{status}</p>"
    )
