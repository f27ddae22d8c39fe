"""The origin of requests: Host and Origin must be this server's own.

This stops DNS rebinding (a strange name resolving to this machine) and other sites' pages talking to the
bench in the name of the person who has it open. CORS middleware does not suffice: it ignores WebSockets.
"""

from __future__ import annotations

from urllib.parse import urlsplit

from starlette.requests import HTTPConnection

from server.security.public import DIRECT, PublicOrigin

LOOPBACK_NAMES = frozenset({"127.0.0.1", "localhost", "[::1]"})
SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})


class OriginPolicy:
    """Decides by the Host and Origin headers alone.

    Parameters
    ----------
    host : str
        The address the service listens on.
    allowed_hosts : list of str
        Further names people open the page under.
    public : PublicOrigin
        Where the page is behind a proxy; it is then the only origin there is.
    """

    def __init__(self, host: str, allowed_hosts: list[str], public: PublicOrigin = DIRECT) -> None:
        bound = f"[{host}]" if ":" in host else host
        bound_names = set() if bound in ("0.0.0.0", "[::]") else {bound.lower()}
        self._names = LOOPBACK_NAMES | bound_names | {name.lower() for name in [*allowed_hosts, public.host] if name}
        self._origin = public.origin

    def refusal(self, connection: HTTPConnection, has_bearer: bool) -> str | None:
        """Say why a request is refused, or nothing.

        Parameters
        ----------
        connection : HTTPConnection
            An HTTP request or a WebSocket handshake.
        has_bearer : bool
            Whether it carries the token itself: it is then a program, not a page, and needs no Origin.
        """
        host = connection.headers.get("host", "").lower()
        if self._name_of(host) not in self._names:
            return f"the Host header '{host[:80]}' is not a name of this server"
        is_handshake = connection.scope["type"] == "websocket"
        changes = is_handshake or connection.scope["method"] not in SAFE_METHODS
        origins = connection.headers.getlist("origin")
        if not origins:
            if changes and not has_bearer:
                return "a request without an Origin header needs a bearer token"
            return None
        # The service itself speaks plain HTTP. The settings say how a proxy publishes it; headers are not trusted.
        if origins != [self._origin or f"http://{host}"]:
            return f"the Origin '{origins[0][:80]}' is not the origin of this server"
        return None

    @staticmethod
    def _name_of(host: str) -> str:
        """Take the port off a Host header; nothing if it is malformed."""
        try:
            parts = urlsplit(f"//{host}")
            parts.port  # noqa: B018  (raises on a malformed port)
        except ValueError:
            return ""
        if parts.path or parts.query or parts.username or not parts.hostname:
            return ""
        return f"[{parts.hostname}]" if ":" in parts.hostname else parts.hostname
