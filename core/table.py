"""A table written by people: it refuses unknown fields, numbers that are not finite, and true or false for a number."""

from __future__ import annotations

from typing import Any, get_args

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import InitErrorDetails


class Table(BaseModel):
    """Base of every table of a scenario, a campaign or a command."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _truth_is_no_number(cls, values: Any) -> Any:
        """Refuse true in place of 1: the writer has made a slip."""
        for name, value in values.items() if isinstance(values, dict) else ():
            if isinstance(value, bool) and name in cls.model_fields:
                annotation = cls.model_fields[name].annotation
                allowed = [getattr(kind, "__origin__", kind) for kind in get_args(annotation) or (annotation,)]
                if (int in allowed or float in allowed) and bool not in allowed:
                    refused = InitErrorDetails(type="float_type", loc=(name,), input=value)
                    raise ValidationError.from_exception_data(cls.__name__, [refused])
        return values
