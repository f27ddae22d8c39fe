"""The public address of the page when a proxy is in front of the service."""

from __future__ import annotations

import re
from dataclasses import dataclass
from urllib.parse import urlsplit

DEFAULT_PORTS = {"http": 80, "https": 443}
EXAMPLE = "https://lab.example or https://lab.example/bench"


@dataclass(frozen=True)
class PublicOrigin:
    """Scheme, host and port as a browser writes them in ``Origin``, and the path the proxy takes off.

    Parameters
    ----------
    origin : str
        Such as ``https://lab.example``; nothing without a proxy.
    prefix : str
        Such as ``/bench``; nothing when the page is at the root.
    """

    origin: str = ""
    prefix: str = ""

    @classmethod
    def parse(cls, text: str) -> PublicOrigin:
        """Read it from the settings.

        Raises
        ------
        ValueError
            For anything but http or https, a host, and perhaps a port and a path.
        """
        if not text:
            return cls()
        try:
            parts = urlsplit(text)
            port = parts.port
        except ValueError as error:
            raise ValueError(f"must be an address such as {EXAMPLE}: {error}") from None
        path = parts.path.rstrip("/")
        name = parts.hostname or ""
        is_plain = text.isascii() and not (parts.query or parts.fragment or parts.username is not None)
        if parts.scheme not in DEFAULT_PORTS or not re.fullmatch(r"[a-z0-9._-]+|[0-9a-f:.]+", name) or not is_plain:
            raise ValueError(f"must be http or https, a host and perhaps a path, such as {EXAMPLE}")
        if not re.fullmatch(r"(/(?!\.{1,2}(/|$))[A-Za-z0-9._~-]+)*", path):
            raise ValueError(f"must have a path of letters, digits and . _ ~ - alone, such as {EXAMPLE}")
        host = f"[{name}]" if ":" in name else name
        shown = "" if port in (None, DEFAULT_PORTS[parts.scheme]) else f":{port}"
        return cls(f"{parts.scheme}://{host}{shown}", path)

    def __str__(self) -> str:
        """Write it as it is typed into a browser."""
        return f"{self.origin}{self.prefix}"

    @property
    def host(self) -> str:
        """The name in the Host header, without a port."""
        return re.sub(r":\d+$", "", self.origin.partition("//")[2])

    @property
    def is_secure(self) -> bool:
        """Whether browsers come by TLS."""
        return self.origin.startswith("https:")


DIRECT = PublicOrigin()
"""No proxy: the page is where the service listens."""
