"""The join code of a class, as the wall shows it."""

from __future__ import annotations

import re
import secrets
from collections.abc import Container

from server.store.links import LETTERS

CLASS_LETTERS, CODE_LETTERS = 4, 8
"""The first letters identify the class; the others are the secret, some 7e11 of them. At a thousand tries a second all
of them take twenty years, and a code lasts for hours."""


def new_class_id(taken: Container[str]) -> str:
    """Return the id of a new class."""
    while True:
        made = "".join(secrets.choice(LETTERS) for _ in range(CLASS_LETTERS))
        if made not in taken:
            return made


def new_code() -> str:
    """Return the secret part of a new code."""
    return "".join(secrets.choice(LETTERS) for _ in range(CODE_LETTERS))


def shown(class_id: str, code: str) -> str:
    """Write a code as people read it aloud, such as ``K7M4 X9P2 TQ5H``."""
    return f"{class_id} {code[:4]} {code[4:]}".upper()


def split(typed: str) -> tuple[str, str]:
    """Return class and secret of a typed code: small or capital, with or without spaces."""
    letters = re.sub(r"[\s-]+", "", typed).lower()
    return letters[:CLASS_LETTERS], letters[CLASS_LETTERS:]
