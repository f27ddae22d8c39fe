"""The name of a student, as the student gives it."""

from __future__ import annotations

import unicodedata

from server.errors import ApiError

LONGEST_NAME = 40
TAKEN = frozenset({"api", "board", "lti", "page", "scenario", "teacher", "watcher"})
"""First words of actors in the log that are no students."""


def clean(name: str) -> str:
    """Return a name in one line, as short as names are, of letters as they are usually written.

    Raises
    ------
    ApiError
        If it becomes empty, or if logs use it for another person.
    """
    text = in_one_line(name)
    if not text or len(text) > LONGEST_NAME:
        raise ApiError(422, "invalid", f"needs 1 to {LONGEST_NAME} characters", "name")
    if text.casefold().split()[0] in TAKEN:
        raise ApiError(422, "invalid", f"cannot begin with {text.split()[0]}: logs call others so", "name")
    return text


def in_one_line(text: str) -> str:
    """Return words in one line, of letters as they are usually written."""
    plain = unicodedata.normalize("NFKC", text)
    return " ".join("".join(letter if letter.isprintable() else " " for letter in plain).split())
