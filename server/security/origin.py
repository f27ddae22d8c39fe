"""The origin of requests: Host and Origin must be this server's own.

This stops DNS rebinding (a strange name resolving to this machine) and other sites' pages that send commands to the
bench in the name of its user. CORS middleware does not suffice: it ignores WebSockets.
"""

from __future__ import annotations

import socket
from urllib.parse import urlsplit

from starlette.requests import HTTPConnection

from server.security.ends import own_literal
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
    classroom : bool
        Whether students come by the addresses and the name this machine has on the network.
    """

    def __init__(
        self, host: str, allowed_hosts: list[str], public: PublicOrigin = DIRECT, classroom: bool = False
    ) -> None:
        bound = f"[{host}]" if ":" in host else host
        bound_names = set() if bound in ("0.0.0.0", "[::]") else {bound.lower()}
        names = [*allowed_hosts, public.host, *(machine_names() if classroom else ())]
        self._names = LOOPBACK_NAMES | bound_names | {name.lower() for name in names if name}
        self._origin, self._classroom = public.origin, classroom

    def refusal(self, connection: HTTPConnection, has_bearer: bool, from_anywhere: bool = False) -> str | None:
        """Say why a request is refused, or nothing.

        Parameters
        ----------
        connection : HTTPConnection
            An HTTP request or a WebSocket handshake.
        has_bearer : bool
            Whether it carries the token itself: it is then a program, not a page, and needs no Origin.
        from_anywhere : bool
            Whether pages of other sites may send browsers there.
        """
        host = connection.headers.get("host", "").lower()
        if not self._is_ours(self._name_of(host), connection):
            return f"the Host header '{host[:80]}' is not a name of this server"
        if from_anywhere:
            return None
        is_handshake = connection.scope["type"] == "websocket"
        changes = is_handshake or connection.scope["method"] not in SAFE_METHODS
        origins = connection.headers.getlist("origin")
        if not origins:
            if changes and not has_bearer:
                return "a request without an Origin header needs a bearer token"
            return None
        # The service itself speaks plain HTTP. The settings contain the public address at the proxy; headers are not
        # trusted.
        if origins != [self._origin or f"http://{host}"]:
            return f"the Origin '{origins[0][:80]}' is not the origin of this server"
        return None

    def _is_ours(self, name: str, connection: HTTPConnection) -> bool:
        """Whether a name is one of this server; only a name can be rebound, so an address that was reached is ours."""
        return name in self._names or (self._classroom and name != "" and name == own_literal(connection))

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


def machine_names() -> list[str]:
    """Return the names of this machine for others: its own, and its name where no name server is used."""
    name = socket.gethostname()
    first = name.partition(".")[0]
    return [name, f"{first}.local"] if first else []
