"""The lease of a bench, and the users who have its pages open."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field
from typing import Protocol

from server.errors import ApiError
from server.security.person import TEACHER, Person

LEASE_S = 5.0
"""How long a silent driver keeps the bench."""


@dataclass
class Lease:
    """Who drives a bench, and who would like to."""

    driver: Person | None = None
    """The driver; if None, the next person who gives a command drives."""
    until: float = 0.0
    """When it ends unless the driver is heard, on the clock of the leases."""
    asking: dict[str, Person] = field(default_factory=dict)
    lent_by: str = ""
    """Id of the person who handed it over, and may take it back."""
    alone_since: float | None = None
    """Time since the driver is alone."""

    def is_of(self, person: Person) -> bool:
        """Whether a person drives."""
        return self.driver is not None and self.driver.id == person.id

    def refusal(self, person: Person) -> ApiError:
        """Tell another person the name of the driver, and the next step."""
        who = self.driver.name if self.driver is not None else "nobody"
        name = "the teacher" if who == TEACHER.name else who
        hint = "take it back, or ask for it" if person.is_teacher else "ask for it; the driver can hand it over"
        return ApiError(409, "driving", f"{name} drives this bench", hint=hint)

    def renew(self, now: float) -> None:
        """Let it last for a while from now on."""
        self.until = max(self.until, now + LEASE_S)


class Pages(Protocol):
    """The pages of benches, as the lease needs them."""

    def ask(self, bench_id: str, person: Person) -> None:
        """Ask the pages of a person at a bench to answer."""

    def tell(self, bench_id: str) -> None:
        """Send the list of users to all pages of a bench soon."""

    def call(self, people: list[Person]) -> None:
        """Tell all pages of some persons to read their present rights."""


class Presence:
    """The users with an open page of each bench, in the order of their arrival."""

    def __init__(self) -> None:
        self._here: defaultdict[str, dict[str, Person]] = defaultdict(dict)
        self._pages: Counter[tuple[str, str]] = Counter()
        self._gone: dict[tuple[str, str], tuple[Person, float]] = {}

    def come(self, bench_id: str, person: Person) -> bool:
        """Count a page; return whether it is the first of a person who was not present just now."""
        key = bench_id, person.id
        self._pages[key] += 1
        self._here[bench_id].setdefault(person.id, person)
        return self._gone.pop(key, None) is None and self._pages[key] == 1

    def go(self, bench_id: str, person: Person, now: float) -> None:
        """Count a page that was closed."""
        key = bench_id, person.id
        self._pages[key] -= 1
        if self._pages[key] > 0:
            return
        del self._pages[key]
        self._gone[key] = person, now
        self._here[bench_id].pop(person.id, None)
        if not self._here[bench_id]:
            del self._here[bench_id]

    def of(self, bench_id: str) -> dict[str, Person]:
        """Return the users of a bench, by id."""
        return self._here.get(bench_id, {})

    def pages_of_watchers(self, bench_id: str) -> int:
        """Count the pages of a bench that were opened by links to watch."""
        here = self.of(bench_id).values()
        return sum(self._pages[bench_id, one.id] for one in here if one.role == "watcher")

    def gone(self, before: float) -> list[tuple[str, Person]]:
        """Return once each person who has left, with the bench, and has not come again."""
        found = [(key, person) for key, (person, at) in self._gone.items() if at <= before]
        for key, _ in found:
            del self._gone[key]
        return [(bench_id, person) for (bench_id, _), person in found]
