"""Whether a document that arrives now may carry units of its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from typing import Any

from core.errors import InputError

_refusal: ContextVar[str] = ContextVar("refusal", default="")
"""Why units are refused to whom the code at work belongs; empty where they are admitted."""


def admit(refusal: str) -> None:
    """Say, for the request at work and all it begins, why units are refused; empty admits them."""
    _refusal.set(refusal)


def refusal() -> str:
    """Return why units are refused to whom the code at work belongs; empty where they are admitted."""
    return _refusal.get()


@contextmanager
def kept() -> Iterator[None]:
    """Read what this server has kept: its units were admitted when it came."""
    token = _refusal.set("")
    try:
        yield
    finally:
        _refusal.reset(token)


def kept_with(values: Iterable[str]) -> AbstractContextManager[None]:
    """Read what this server has kept, with values written over at these paths; units among them must be admitted."""
    return nullcontext() if any(path.split(".")[0] == "units" for path in values) else kept()


def check_admitted(document: dict[str, Any]) -> None:
    """Refuse a document with units of its own where they are not admitted.

    Raises
    ------
    InputError
        Saying who may bring units.
    """
    if _refusal.get() and document.get("units"):
        raise InputError(_refusal.get(), "units", code="forbidden")
