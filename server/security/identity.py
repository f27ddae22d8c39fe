"""Who is asking: one access token, shown once in the address, then a cookie."""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
import tempfile
from pathlib import Path

from starlette.requests import HTTPConnection

COOKIE = "combbench"
TOKEN_FILE = "token"


class Identity:
    """Checks callers against the access token.

    The cookie carries a digest of the token, never the token; both are compared in constant time.

    Parameters
    ----------
    token : str
        The access token.
    """

    def __init__(self, token: str) -> None:
        self._token = token.encode()
        self.cookie = hmac.new(self._token, b"combbench session", hashlib.sha256).hexdigest()

    @property
    def token(self) -> str:
        """The token, for the address printed at the start."""
        return self._token.decode()

    def is_token(self, given: str) -> bool:
        """Whether ``given`` is the token."""
        return hmac.compare_digest(given.encode(), self._token)

    def has_bearer(self, connection: HTTPConnection) -> bool:
        """Whether the caller sent the token as a bearer."""
        scheme, _, value = connection.headers.get("authorization", "").partition(" ")
        return scheme.lower() == "bearer" and self.is_token(value.strip())

    def has_cookie(self, connection: HTTPConnection) -> bool:
        """Whether the caller sent our cookie."""
        given = connection.cookies.get(COOKIE, "")
        return hmac.compare_digest(given.encode(), self.cookie.encode())

    def knows(self, connection: HTTPConnection) -> bool:
        """Whether the caller may come in."""
        return self.has_bearer(connection) or self.has_cookie(connection)


def fits_header(token: str) -> bool:
    """Whether a token arrives in a header as it is: visible ASCII, no space at either end."""
    return token.isascii() and token.isprintable() and token == token.strip()


def token_of(data: Path) -> str:
    """Return the token kept in the data folder; made there on the first start, or when what is kept is no token.

    It survives restarts, so that an open page finds its way back; only the owner may read the file.
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
