"""Who asks for what is computed now."""

from __future__ import annotations

from contextvars import ContextVar

from server.people.person import Person

_asker: ContextVar[str] = ContextVar("asker", default="")


def asks(person: Person | None) -> None:
    """Say who asks, for the request at work and all it begins."""
    _asker.set("" if person is None or person.is_teacher else person.id)


def asker() -> str:
    """Return the id of the student or watcher who asks; empty for the teacher, and for the server itself."""
    return _asker.get()
