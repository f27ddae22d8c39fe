"""Text as editors save it."""

from __future__ import annotations

MARK = "\ufeff"
"""The byte order mark, with which some editors begin UTF-8."""


def without_mark(text: str) -> str:
    """Return a text without a byte order mark at its beginning."""
    return text.removeprefix(MARK)
