"""A person at the bench: the teacher, a student of a class, or a holder of a link to watch."""

from __future__ import annotations

import hashlib
import secrets
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

Role = Literal["teacher", "student", "watcher"]


@dataclass(frozen=True)
class Person:
    """A person who passed the gate.

    Parameters
    ----------
    id : str
        Known to the server; names may be shared by several classes.
    name : str
        As the person gave it, or the kind of visitor.
    role : Role
        The role, which decides over most doors.
    class_id : str
        The class of a student.
    until, joined : datetime, optional
        When the session ends, and when the person came first.
    """

    id: str
    name: str
    role: Role
    class_id: str = ""
    until: datetime | None = None
    joined: datetime | None = None

    @property
    def is_teacher(self) -> bool:
        """Whether every door is open."""
        return self.role == "teacher"


TEACHER = Person("teacher", "teacher", "teacher")
"""The person with the access token, or a person who works alone."""


def new_secret() -> str:
    """Return a secret of 256 bits, for a session or a link."""
    return secrets.token_urlsafe(32)


def hash_of(secret: str) -> str:
    """Return the stored hash of a secret: it is long and random, so a plain hash cannot be inverted."""
    return hashlib.sha256(secret.encode()).hexdigest()
