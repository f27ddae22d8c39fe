"""Security headers on every response."""

from __future__ import annotations

import secrets

from starlette.datastructures import MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from server.security.frames import Frames
from server.security.visitor import STYLE_HASH

POLICY = "Content-Security-Policy"


def app_policy(nonce: str) -> str:
    """Return the policy of the page: scripts from files alone, styles from files or by the nonce of this answer.

    Attributes of style stay allowed, because formulas are set with them.
    """
    return "; ".join(
        (
            "default-src 'self'",
            "script-src 'self'",
            "style-src 'self' 'unsafe-inline'",  # for browsers that do not know the next two
            f"style-src-elem 'self' 'nonce-{nonce}' '{STYLE_HASH}'",
            "style-src-attr 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "font-src 'self' data:",
            "connect-src 'self'",
            "worker-src 'self' blob:",
            "frame-src 'self'",
            "frame-ancestors 'none'",
            "base-uri 'self'",
            "form-action 'self'",
            "object-src 'none'",
        )
    )


FIXED = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
}


class SecurityHeaders:
    """Adds the headers; a route that needs another content policy sets its own.

    Parameters
    ----------
    app : ASGIApp
        The application to wrap.
    prefix : str
        The prefix a proxy takes off every path; redirects put it on again.
    frames : Frames, optional
        Knows which pages of other sites may show ours.
    """

    def __init__(self, app: ASGIApp, prefix: str = "", frames: Frames | None = None) -> None:
        self._app, self._prefix, self._frames = app, prefix, frames

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the call on, adding headers to the start of an HTTP response."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        nonce = scope["nonce"] = secrets.token_urlsafe(16)

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.setdefault(POLICY, app_policy(nonce))
                if self._frames is not None:
                    headers[POLICY] = self._frames.policy(scope["path"], headers[POLICY])
                for name, value in FIXED.items():
                    headers.setdefault(name, value)
                if headers.get("location", "").startswith("/"):
                    headers["location"] = self._prefix + headers["location"]
                if scope["path"].startswith("/api/"):
                    headers.setdefault("Cache-Control", "no-store")
            await send(message)

        await self._app(scope, receive, send_with_headers)
