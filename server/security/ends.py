"""The two ends of a connection, by their addresses."""

from __future__ import annotations

from ipaddress import IPv4Address, IPv6Address, ip_address
from typing import Any

from starlette.requests import HTTPConnection


def address_of(end: Any) -> IPv4Address | IPv6Address | None:
    """Read one end of a connection; a socket of IPv6 writes an IPv4 address in a form of its own.

    Parameters
    ----------
    end : sequence or None
        Host and port, as the server names them in ``client`` and ``server``.
    """
    try:
        address = ip_address(end[0]) if end else None
    except ValueError:  # not of the internet: a Unix socket
        return None
    return getattr(address, "ipv4_mapped", None) or address


def is_from_this_machine(connection: HTTPConnection) -> bool:
    """Whether the caller came by a loopback address."""
    address = address_of(connection.scope.get("client"))
    return address is not None and address.is_loopback


def own_literal(connection: HTTPConnection) -> str:
    """Return the address of ours that the caller reached, as a Host header has it."""
    address = address_of(connection.scope.get("server"))
    if address is None:
        return ""
    return f"[{address}]" if address.version == 6 else str(address)
