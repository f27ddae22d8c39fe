"""The classroom way to serve: the address that students open, and its exposure to the network."""

from __future__ import annotations

import io
import socket
import sys
from ipaddress import IPv4Address, IPv6Address, ip_address

import psutil
import segno

from server.settings import ANY_IPV4, ANY_IPV6, Settings

FAR_AWAY = {socket.AF_INET: "198.51.100.1", socket.AF_INET6: "2001:db8::1"}
"""Unassigned addresses, to learn which way packets leave; nothing is sent to them."""

EXPOSED = """\
This address is the teacher's. It works on this machine alone.

Everyone on this network can open the page to join. Only students with the code
of a class get further. Names and answers of students, and the pictures, travel
unencrypted: others on this network can read and change them. Where that is too
little, serve the class with TLS: docs/behind-a-proxy.md says how.
"""
NO_NETWORK = "This machine has no address that students could open: connect it to a network and start again.\n"

PAPER, PLAIN = "\033[38;5;231;48;5;16m", "\033[0m"
"""White on black in terminals of all colours: the blocks drawn are the light modules."""


def join_addresses(host: str, port: int) -> list[str]:
    """List the addresses that students open, the likeliest first.

    Parameters
    ----------
    host, port : str, int
        Where the service listens.
    """
    if host not in (ANY_IPV4, ANY_IPV6):
        return [_join_address(host, port)]
    found = network_addresses()
    return [_join_address(str(address), port) for address in found if host == ANY_IPV6 or address.version == 4]


def _join_address(host: str, port: int) -> str:
    """Write the address of the page to join."""
    shown = f"[{host}]" if ":" in host else host
    return f"http://{shown}:{port}/join"


def network_addresses() -> list[IPv4Address | IPv6Address]:
    """List the addresses of this machine on its networks; IPv6 addresses only without any IPv4 address.

    The address of outgoing packets comes first, addresses of tunnels, which no student shares, come last.
    """
    leaving = {_leaving_address(family) for family in FAR_AWAY}
    links = psutil.net_if_stats()
    found = []
    for name, entries in psutil.net_if_addrs().items():
        if name not in links or not links[name].isup:
            continue
        is_tunnel = "pointopoint" in links[name].flags
        for entry in entries:
            if entry.family not in FAR_AWAY:
                continue
            address = ip_address(entry.address)
            # A browser cannot open a link-local address of IPv6, which needs the name of an interface.
            if not address.is_loopback and (address.version == 4 or not address.is_link_local):
                found.append((is_tunnel, address.is_link_local, str(address) not in leaving, address))
    found.sort(key=lambda entry: entry[:3])
    addresses = [address for *_, address in found]
    return [address for address in addresses if address.version == 4] or addresses


def _leaving_address(family: socket.AddressFamily) -> str:
    """Return the address from which packets to elsewhere leave; connecting a UDP socket sends none."""
    try:
        with socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.connect((FAR_AWAY[family], 9))
            return str(probe.getsockname()[0])
    except OSError:  # no way there
        return ""


def qr_text(address: str) -> str:
    """Draw the QR code of an address for a terminal, two modules in a character."""
    drawn = io.StringIO()
    segno.make_qr(address, error="m").terminal(drawn, compact=True)
    return "".join(f"{PAPER}{line}{PLAIN}\n" for line in drawn.getvalue().splitlines())


def notice(settings: Settings, port: int) -> str:
    """Return a text about the reach of the class, its readers, and the address for students.

    Parameters
    ----------
    settings : Settings
        Where the service listens.
    port : int
        On which port, if the settings leave that open.
    """
    addresses = join_addresses(settings.host, port)
    if not addresses:
        return f"{EXPOSED}\n{NO_NETWORK}"
    first, *others = addresses
    lines = [f"Students open  {first}", *(f"if that fails  {other}" for other in others)]
    can_draw = sys.stdout.isatty() and sys.stdout.encoding.lower().startswith("utf")
    return "\n".join([EXPOSED, *lines, qr_text(first) if can_draw else ""])
