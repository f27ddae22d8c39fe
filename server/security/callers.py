"""The address of a caller, of the connection or from a trusted proxy; limits and the log use it."""

from __future__ import annotations

from collections.abc import Sequence
from ipaddress import ip_address, ip_network

from starlette.requests import HTTPConnection


class Callers:
    """Tells callers apart.

    Parameters
    ----------
    trusted : sequence of str
        Addresses or networks of proxies that are believed.
    """

    def __init__(self, trusted: Sequence[str]) -> None:
        self._trusted = [ip_network(one) for one in trusted]

    def address(self, connection: HTTPConnection) -> str:
        """Return the address of the first caller, seen from here, that is no trusted proxy."""
        here = connection.client.host if connection.client else ""
        said = ",".join(connection.headers.getlist("x-forwarded-for")).split(",")
        while self._is_trusted(here) and said and said[-1].strip():
            here = said.pop().strip()
        return here[:64]

    def _is_trusted(self, address: str) -> bool:
        try:
            return any(ip_address(address) in one for one in self._trusted)
        except ValueError:
            return False
