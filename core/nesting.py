"""How deep a document may be nested: code that copies, checks or prints a deeper document may run out of stack."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from core.errors import InputError
from core.text import without_mark

DEEPEST = 50
TOO_DEEP = f"nested too deeply, at most {DEEPEST} levels"

_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"""(?<![\w"'-]){_PART}(?:[ \t]*+\.[ \t]*+{_PART}){{{DEEPEST}}}""")
"""A dotted key of too many parts; found before TOML is read, which takes time by the square of their number."""


def depth(document: Any) -> int:
    """Return the depth of nested tables and lists."""
    levels, inside = 0, [document]
    while tables := [one for one in inside if isinstance(one, dict | list)]:
        inside = [one for table in tables for one in (table.values() if isinstance(table, dict) else table)]
        levels += 1
    return levels


def read_toml(text: str, field: str, what: str = "TOML") -> dict[str, Any]:
    """Read TOML.

    Raises
    ------
    InputError
        Naming the line of malformed TOML, with the code ``malformed``; or the limit of nesting.
    """
    if not _LONG_KEY.search(text):
        try:
            document = tomllib.loads(without_mark(text))
            if depth(document) <= DEEPEST:
                return document
        except tomllib.TOMLDecodeError as error:
            raise InputError(f"malformed {what}: {error}", field, code="malformed") from None
        except ValueError as error:  # a whole number of more digits than Python reads
            raise InputError(f"malformed {what}: {str(error).partition(':')[0]}", field, code="malformed") from None
        except RecursionError:
            pass  # lists in lists, which the reader goes into one by one
    raise InputError(TOO_DEEP, field, code="too_deep")
