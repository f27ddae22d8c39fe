"""The person whose request is at work."""

from __future__ import annotations

from contextvars import ContextVar

from server.security.person import Person

_asker: ContextVar[str] = ContextVar("asker", default="")


def asks(person: Person | None) -> None:
    """Name the person, for the request at work and all it begins."""
    _asker.set("" if person is None or person.is_teacher else person.id)


def asker() -> str:
    """Return the id of a student or watcher; empty for the teacher, and for work of the server's own."""
    return _asker.get()
