"""The identity of callers: an access token, shown once in the address, then a cookie; or the secret of a session."""

from __future__ import annotations

import hashlib
import hmac
import secrets
from pathlib import Path

from starlette.requests import HTTPConnection
from starlette.responses import Response

from server.security.ends import is_from_this_machine
from server.security.privacy import write_private
from server.security.public import DIRECT, PublicOrigin

TOKEN_FILE = "token"
COOKIE_S = 30 * 86400
BEARER_PROTOCOL = "combbench.session."


class Identity:
    """Checks callers against the access token.

    The cookie carries a digest of the token, never the token; both are compared in constant time. Browsers send a
    cookie to every port of a host, so its name depends on the token: two benches on one host do not log each other out.

    Parameters
    ----------
    token : str
        The access token.
    public : PublicOrigin
        Where the page is behind a proxy.
    loopback_only : bool
        Whether the token is accepted from this machine alone; from elsewhere the right one is refused like a wrong one.
    """

    def __init__(self, token: str, public: PublicOrigin = DIRECT, loopback_only: bool = False) -> None:
        self._token, self._public, self._loopback_only = token.encode(), public, loopback_only
        self.cookie = self._digest(b"combbench session")
        # A browser takes a cookie with one of these names by TLS alone, and __Host- for this host and its root alone.
        prefix = ("__Secure-" if public.prefix else "__Host-") if public.is_secure else ""
        name = f"{prefix}combbench-{self._digest(b'combbench cookie')[:8]}"
        self.cookie_name, self.session_name = name, f"{name}-class"

    def _digest(self, purpose: bytes) -> str:
        """Return a digest that only a holder of the token can compute."""
        return hmac.new(self._token, purpose, hashlib.sha256).hexdigest()

    def secret_of_link(self, link_id: str) -> str:
        """Return the secret of the session by which people without the token watch, if a link allows it."""
        return self._digest(f"combbench link {link_id}".encode())

    def give_cookie(self, response: Response) -> None:
        """Set the cookie that lets a browser come in again."""
        self._set_cookie(response, self.cookie_name, self.cookie, COOKIE_S)

    def give_session(self, response: Response, secret: str, seconds: float) -> None:
        """Set the cookie of a session that is not the teacher's."""
        self._set_cookie(response, self.session_name, secret, int(seconds))

    def _set_cookie(self, response: Response, name: str, value: str, seconds: int) -> None:
        response.set_cookie(
            name,
            value,
            max_age=seconds,
            path=f"{self._public.prefix}/",
            secure=self._public.is_secure,
            httponly=True,
            samesite="strict",
        )

    @property
    def token(self) -> str:
        """The token, for the address printed at the start."""
        return self._token.decode()

    def is_token(self, given: str) -> bool:
        """Return whether ``given`` is the token."""
        return hmac.compare_digest(given.encode(), self._token)

    def may_use_token(self, connection: HTTPConnection) -> bool:
        """Whether the token is accepted from where the caller is."""
        return not self._loopback_only or is_from_this_machine(connection)

    def has_token_in_address(self, connection: HTTPConnection) -> bool:
        """Whether the caller opened an address with the token."""
        return self.may_use_token(connection) and self.is_token(connection.query_params.get("token", ""))

    def has_bearer(self, connection: HTTPConnection) -> bool:
        """Whether the caller sent the token as a bearer."""
        return self.may_use_token(connection) and self.is_token(bearer_of(connection))

    def has_cookie(self, connection: HTTPConnection) -> bool:
        """Whether the caller sent our cookie."""
        given = connection.cookies.get(self.cookie_name, "")
        return self.may_use_token(connection) and hmac.compare_digest(given.encode(), self.cookie.encode())

    def knows(self, connection: HTTPConnection) -> bool:
        """Whether the caller is the teacher, who may do everything."""
        return self.has_bearer(connection) or self.has_cookie(connection)

    def session_of(self, connection: HTTPConnection) -> str:
        """Return the secret of the session that the caller sent, as a bearer or as a cookie."""
        return bearer_of(connection) or connection.cookies.get(self.session_name, "")


def bearer_of(connection: HTTPConnection) -> str:
    """Return the bearer of the caller; a page can give a WebSocket no header, but an additional protocol."""
    scheme, _, value = connection.headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        return value.strip()
    offered = connection.scope.get("subprotocols") or ()
    return next((word.removeprefix(BEARER_PROTOCOL) for word in offered if word.startswith(BEARER_PROTOCOL)), "")


def fits_header(token: str) -> bool:
    """Whether a token arrives in a header as it is: visible ASCII, no space at either end."""
    return token.isascii() and token.isprintable() and token == token.strip()


def token_of(data: Path) -> str:
    """Return the token kept in the data folder; make one on the first start, or when the file holds no token.

    It survives restarts, so that an open page can connect again; only the owner may read the file.
    """
    path = data / TOKEN_FILE
    try:
        kept = path.read_text("ascii").strip()
    except (FileNotFoundError, UnicodeDecodeError):
        kept = ""
    if len(kept) >= 32 and fits_header(kept):
        return kept
    token = secrets.token_urlsafe(32)
    write_private(path, f"{token}\n".encode())
    return token
