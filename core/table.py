"""A table written by people: it refuses unknown fields, numbers that are not finite, and anything else for a number."""

from __future__ import annotations

from collections.abc import Hashable
from functools import cache
from types import NoneType
from typing import Annotated, Any, Literal, cast, get_args, get_origin

from pydantic import AfterValidator, BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import InitErrorDetails

from core.format import typeset

NUMBERS = frozenset({int, float, bool})
TRUTHS = frozenset({"true", "false", "yes", "no", "on", "off", "t", "f", "y", "n"})
"""Texts that pydantic takes for true or false."""
Words = Annotated[str, AfterValidator(typeset)]
"""A text for people: typed as "2e-6 um", read as "2×10⁻⁶ µm"."""
OPEN = frozenset({"inf", "infinity"})


class Table(BaseModel):
    """Base of every table of a scenario, a campaign or a command."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _nothing_else_is_a_number(cls, values: Any) -> Any:
        """Refuse true in place of 1, and "1" or "true" in quotes: the writer has made a slip."""
        fields = _fields(cls)
        for name, value in values.items() if isinstance(values, dict) else ():
            allowed = fields.get(name)
            if allowed is None or type(value) is float:
                continue
            takes_numbers = bool(allowed & {int, float})
            is_slip = isinstance(value, bool) and takes_numbers and bool not in allowed
            if is_slip or (allowed <= NUMBERS and any(map(_is_quoted, value if isinstance(value, list) else [value]))):
                kind = "bool_type" if not takes_numbers else "float_type" if float in allowed else "int_type"
                refused = InitErrorDetails(type=kind, loc=(name,), input=value)
                raise ValidationError.from_exception_data(cls.__name__, [refused])
        return values


@cache
def _fields(table: type[Table]) -> dict[str, frozenset[Any]]:
    """Return the types that the value of each field, or an item of it, may have."""
    return {name: _kinds(cast(Hashable, field.annotation)) for name, field in table.model_fields.items()}


@cache
def _kinds(annotation: Hashable) -> frozenset[Any]:
    """Return the types that a value, or an item of it, may have."""
    if get_origin(annotation) is Literal:
        return frozenset(map(type, get_args(annotation)))
    parts = [part for part in get_args(annotation) if part not in (NoneType, ...)]
    if get_origin(annotation) is Annotated:
        parts = parts[:1]
    return frozenset().union(*map(_kinds, parts)) if parts else frozenset([annotation])


def _is_quoted(value: Any) -> bool:
    """Whether a value is a text that reads as a number or as true or false; the ends of open ranges are texts."""
    if not isinstance(value, str) or value.strip().lstrip("+-").lower() in OPEN:
        return False
    try:
        return value.strip().lower() in TRUTHS or float(value) is not None
    except ValueError:
        return False
