"""Errors for input that the bench refuses."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pydantic import ValidationError

UNITS = (
    "_um",
    "_nm",
    "_m",
    "_mm",
    "_kg",
    "_mg",
    "_n_m",
    "_ns_m",
    "_n_per_v",
    "_v",
    "_mv",
    "_khz",
    "_hz",
    "_ms",
    "_us",
    "_s",
    "_k",
    "_c",
    "_pa",
    "_kpa",
    "_pct",
    "_gpa",
    "_kg_m3",
)


MOST_LISTED = 40
"""Names that an error lists; of more it gives the number."""
ALTERNATIVE = re.compile(r"(?:list|dict|literal)\[.*\]")
"""Part of a pydantic location that names one of the types a value may have."""


def one_line(text: str) -> str:
    """Replace characters of a caller's text that would break the line it is quoted in."""
    return "".join(character if character.isprintable() else " " for character in text)


class InputError(ValueError):
    """One clear line about one field.

    Parameters
    ----------
    message : str
        The mistake, and the values that are allowed.
    field : str
        Dotted path of the field, empty when there is none.
    hint : str
        Advice for the caller.
    code : str
        Stable word for programs: ``invalid``, ``unknown``, ``conflict``, ``not_live``.
    """

    def __init__(self, message: str, field: str = "", hint: str = "", code: str = "invalid") -> None:
        message, field = one_line(message), one_line(field)
        super().__init__(f"{field}: {message}" if field else message)
        self.message = message
        self.field = field
        self.hint = hint
        self.code = code

    def as_dict(self) -> dict[str, str]:
        """Return the error in the form that all interfaces share."""
        return {"code": self.code, "message": str(self), "field": self.field, "hint": self.hint}

    def under(self, prefix: str) -> InputError:
        """Return the same error with its field below ``prefix``."""
        path = ".".join(part for part in (prefix, self.field) if part)
        return InputError(self.message, path, self.hint, self.code)


def unknown(what: str, name: object, allowed: Iterable[str], field: str = "") -> InputError:
    """Build the error for a name that does not exist, and suggest the nearest names."""
    names = list(allowed)
    hint = did_you_mean(name, names)
    listed = ", ".join(names) if names else "none"
    if len(names) > MOST_LISTED:
        beginnings = dict.fromkeys(re.split("[.-]", one)[0] for one in names)
        listed = f"{len(names)} names" + ("" if hint else f", which begin with {', '.join(beginnings)}")
    return InputError(f"unknown {what} {short(name)}; allowed: {listed}", field, hint, "unknown")


def did_you_mean(name: object, allowed: Iterable[str]) -> str:
    """Return advice with the nearest name, or with the names that end alike; nothing where none is near."""
    names = list(allowed)
    near = difflib.get_close_matches(str(name), names, n=1)
    if not near:
        ends = list(dict.fromkeys(one.rpartition(".")[2] for one in names))
        end = difflib.get_close_matches(str(name).rpartition(".")[2], ends, n=1)
        near = [one for one in names if end and one.rpartition(".")[2] == end[0]][:3]
    return f"did you mean {' or '.join(near)}?" if near else ""


def short(value: object, limit: int = 60) -> str:
    """Show a value on one line, cut to a readable length."""
    text = " ".join(repr(value).split())
    return text if len(text) <= limit else text[: limit - 1] + "…"


def finite(value: float, field: str = "") -> float:
    """Return ``value`` or refuse it when it is not a finite number."""
    if not math.isfinite(value):
        raise InputError(f"must be a finite number, got {value}", field)
    return value


def field_of(complaint: Mapping[str, Any]) -> str:
    """Return the dotted path of the field pydantic complains about."""
    parts = [str(part) for part in complaint["loc"] if not ALTERNATIVE.fullmatch(str(part))]
    if parts[-1:] == ["str"] and complaint["type"] == "string_type":
        del parts[-1]
    return ".".join(parts)


def either(sayings: Iterable[str], verb: str) -> str:
    """Join pydantic's messages about a value that may have one of several types, without repeating the verb."""
    return " or ".join(dict.fromkeys(sayings)).replace(f" or {verb} ", " or ")


def from_validation(error: ValidationError, known: Mapping[str, Sequence[str]] | None = None) -> InputError:
    """Turn the first problem pydantic found into one clear line.

    Parameters
    ----------
    error : ValidationError
        The error pydantic raised.
    known : mapping of str to sequence of str, optional
        Field names allowed under each dotted parent, to suggest the intended name.
    """
    complaints = error.errors(include_url=False)
    first, path = complaints[0], field_of(complaints[0])
    given = first.get("input")
    kind = first["type"]
    if kind == "extra_forbidden":
        parent, _, leaf = path.rpartition(".")
        return unknown_field(leaf, (known or {}).get(parent, ()), path)
    if kind == "missing":
        return InputError("is required", path)
    sayings = {
        "greater_than": "must be > {gt:.16g}",
        "greater_than_equal": "must be >= {ge:.16g}",
        "less_than": "must be < {lt:.16g}",
        "less_than_equal": "must be <= {le:.16g}",
        "finite_number": "must be a finite number",
        "literal_error": "must be one of {expected}",
        "float_type": "must be a number",
        "float_parsing": "must be a number without its unit",
        "int_type": "must be a whole number",
        "int_parsing": "must be a whole number",
        "int_from_float": "must be a whole number",
        "bool_type": "must be true or false",
        "string_type": "must be a text",
        "list_type": "must be a list",
        "dict_type": "must be a table",
        "model_type": "must be a table",
    }
    if kind in sayings:
        same = [item for item in complaints if field_of(item) == path and item["type"] in sayings]
        saying = either((sayings[item["type"]].format(**item.get("ctx", {})) for item in same), "must be")
    else:
        saying = str(first["msg"]).removeprefix("Value error, ")
        if kind == "value_error":
            return InputError(saying, path)
    return InputError(f"{saying}, got {short(given)}", path)


def unknown_field(leaf: str, allowed: Sequence[str], path: str) -> InputError:
    """Build the error for a field that is not declared; a wrong unit in its name is pointed out."""
    stem = _without_unit(leaf)
    for name in allowed:
        if name != leaf and _without_unit(name) == stem:
            return InputError(f"wrong unit: this field is {name}", path, f"write {name}", "unit")
    listed = f"; allowed: {', '.join(allowed)}" if allowed else ""
    return InputError(f"unknown field{listed}", path, did_you_mean(leaf, allowed), "unknown")


def _without_unit(name: str) -> str:
    for unit in sorted(UNITS, key=len, reverse=True):
        if name.endswith(unit):
            return name[: -len(unit)]
    return name
