"""Data for the gate and the headers about pages of other sites that show the bench in a frame.

In such a frame browsers send no cookie. The page has its session in memory, and resources that the browser loads
without the page, such as the 3D view, have a ticket in their address instead: a secret that opens one path once.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from server.security.once import Once
from server.security.person import Person

TICKET = "ticket"
"""The name of a ticket in an address."""
TICKET_S = 60.0


@dataclass(frozen=True)
class Ticket:
    """Who may pass, and where."""

    person: Person
    path: str


@dataclass(frozen=True)
class Frames:
    """The doors that learning platforms need.

    Parameters
    ----------
    below : str
        All of these doors are at or below this path.
    ancestors : str
        Origins whose pages may show the pages in a frame, as a content policy has them; nothing: no page may.
    posts : frozenset of str
        Paths to which browsers are sent from pages of other sites.
    tickets : Once
        Tickets that have been given.
    """

    below: str
    ancestors: str
    posts: frozenset[str]
    tickets: Once[Ticket] = field(default_factory=lambda: Once[Ticket](TICKET_S))

    def holder(self, ticket: str, path: str) -> Person | None:
        """Return the holder of a ticket, once."""
        found = self.tickets.take(ticket)
        return found.person if found is not None and found.path == path else None

    def policy(self, path: str, policy: str) -> str:
        """Return the content policy of an answer: pages of platforms, and frames within them, may be framed."""
        if not self.ancestors:
            return policy
        if path == self.below or path.startswith(f"{self.below}/"):
            policy = policy.replace("frame-ancestors 'none'", "frame-ancestors 'self'")
        return policy.replace("frame-ancestors 'self'", f"frame-ancestors 'self' {self.ancestors}")
