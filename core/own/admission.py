"""Terms on which a document is read: whether it may carry units of its own, and how many events."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

from core.errors import InputError


@dataclass(frozen=True)
class Terms:
    """Terms on which documents of a person are read.

    Parameters
    ----------
    refusal : str
        Why units are refused; empty where they are admitted.
    most_events : int, optional
        How many events a document may have, if fewer than the schema allows.
    """

    refusal: str = ""
    most_events: int | None = None


ANYTHING = Terms()
_terms: ContextVar[Terms] = ContextVar("terms", default=ANYTHING)


def admit(given: Terms) -> None:
    """Set the terms for the request at work and all it begins."""
    _terms.set(given)


def terms() -> Terms:
    """Return the terms of the request at work."""
    return _terms.get()


def refusal() -> str:
    """Return why units are refused to whom the code at work belongs; empty where they are admitted."""
    return _terms.get().refusal


@contextmanager
def kept() -> Iterator[None]:
    """Read a document that this server has kept: it was admitted when it came."""
    token = _terms.set(ANYTHING)
    try:
        yield
    finally:
        _terms.reset(token)


def kept_with(values: Mapping[str, Any]) -> AbstractContextManager[None]:
    """Read a document that this server has kept, with values written over; their units and events must be admitted."""
    check_admitted({"events": values.get("events")})
    return nullcontext() if any(path.split(".")[0] == "units" for path in values) else kept()


def check_admitted(document: dict[str, Any]) -> None:
    """Refuse a document with units of its own where they are not admitted, and one with too many events.

    Raises
    ------
    InputError
        Saying who may bring units, or how many events.
    """
    given, events = _terms.get(), document.get("events")
    if given.refusal and document.get("units"):
        raise InputError(given.refusal, "units", code="forbidden")
    if given.most_events is not None and isinstance(events, list) and len(events) > given.most_events:
        text = f"a student's scenario may have at most {given.most_events} events, and this one has {len(events)}"
        raise InputError(text, "events", code="too_much")
