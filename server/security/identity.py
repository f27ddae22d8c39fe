"""The identity of callers: one access token, shown once in the address, then a cookie."""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
import tempfile
from pathlib import Path

from starlette.requests import HTTPConnection
from starlette.responses import Response

from server.security.public import DIRECT, PublicOrigin

TOKEN_FILE = "token"
COOKIE_S = 30 * 86400


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
    """

    def __init__(self, token: str, public: PublicOrigin = DIRECT) -> None:
        self._token, self._public = token.encode(), public
        self.cookie = self._digest(b"combbench session")
        # A browser takes a cookie with one of these names by TLS alone, and __Host- for this host and its root alone.
        prefix = ("__Secure-" if public.prefix else "__Host-") if public.is_secure else ""
        self.cookie_name = f"{prefix}combbench-{self._digest(b'combbench cookie')[:8]}"

    def _digest(self, purpose: bytes) -> str:
        """Return a digest that only a holder of the token can compute."""
        return hmac.new(self._token, purpose, hashlib.sha256).hexdigest()

    def give_cookie(self, response: Response) -> None:
        """Set the cookie that lets a browser come in again."""
        response.set_cookie(
            self.cookie_name,
            self.cookie,
            max_age=COOKIE_S,
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

    def has_bearer(self, connection: HTTPConnection) -> bool:
        """Whether the caller sent the token as a bearer."""
        scheme, _, value = connection.headers.get("authorization", "").partition(" ")
        return scheme.lower() == "bearer" and self.is_token(value.strip())

    def has_cookie(self, connection: HTTPConnection) -> bool:
        """Whether the caller sent our cookie."""
        given = connection.cookies.get(self.cookie_name, "")
        return hmac.compare_digest(given.encode(), self.cookie.encode())

    def knows(self, connection: HTTPConnection) -> bool:
        """Whether the caller may come in."""
        return self.has_bearer(connection) or self.has_cookie(connection)


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
    data.mkdir(parents=True, exist_ok=True)
    descriptor, part = tempfile.mkstemp(dir=data, prefix=f"{TOKEN_FILE}.")  # for the owner alone
    with os.fdopen(descriptor, "w") as file:
        file.write(token + "\n")
    os.replace(part, path)
    return token
