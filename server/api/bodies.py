"""Bodies: requests refuse unknown fields, silent conversions and NaN; answers take fields from records."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Coroutine
from typing import Annotated, Any, Self

from fastapi import Request, Response
from fastapi.routing import APIRoute
from pydantic import BaseModel, ConfigDict, Field, model_validator

from core.nesting import DEEPEST, TOO_DEEP, depth
from scenarios.json_schema.components import described_by


class Body(BaseModel):
    """Base of every request body."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _whole_numbers(cls, values: Any) -> Any:
        """Take 3.0 for 3 where a whole number is wanted: in JSON Schema they are the same."""
        if not isinstance(values, dict):
            return values
        whole = {name for name, field in cls.model_fields.items() if field.annotation in (int, int | None)}
        return {
            name: int(value) if name in whole and isinstance(value, float) and value.is_integer() else value
            for name, value in values.items()
        }


_NONE = object()


class AnswerBody(BaseModel):
    """Base of an answer that has fields of other records, by the same names."""

    @classmethod
    def of(cls, *records: object, **given: Any) -> Self:
        """Take every field from the first record that has it, unless its value is given here."""
        values = {
            name: value
            for record in reversed(records)
            for name in cls.model_fields
            if name not in given and (value := getattr(record, name, _NONE)) is not _NONE
        }
        return cls.model_validate({**values, **given}, from_attributes=True)


ScenarioDocument = Annotated[dict[str, Any], described_by("Scenario")]
CampaignDocument = Annotated[dict[str, Any], described_by("Campaign")]
DeviceDocument = Annotated[dict[str, Any], described_by("Device")]
EnvironmentDocument = Annotated[dict[str, Any], described_by("Environment")]
Source = Annotated[str | ScenarioDocument, Field(description="Library id, TOML text, or document")]
MemberIds = Annotated[list[str] | None, Field(max_length=500, description="Ids of students; null: the whole class")]
Values = Annotated[dict[str, Any], Field(description="Values by dotted path; they replace values of the scenario")]


def strict_json(text: str | bytes) -> Any:
    """Parse JSON as the standard has it: no NaN, no Infinity, no number that overflows, no double key, no half letter.

    It is nested no deeper than any document, so that the server can copy it and quote it in a reply.

    Raises
    ------
    json.JSONDecodeError
        With the reason.
    """

    def refuse(word: str) -> Any:
        raise json.JSONDecodeError(f"{word} is not a JSON number", str(word), 0)

    def number(word: str) -> float:
        value = float(word)
        return value if math.isfinite(value) else refuse(word)

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        table: dict[str, Any] = {}
        for key, value in pairs:
            if key in table:
                raise json.JSONDecodeError(f"the key '{key[:80]}' appears twice", key, 0)
            table[key] = value
        return table

    try:
        document = json.loads(text, parse_constant=refuse, parse_float=number, object_pairs_hook=unique)
        if depth(document) > DEEPEST:
            raise json.JSONDecodeError(TOO_DEEP, "", 0)
        json.dumps(document, ensure_ascii=False).encode()
        return document
    except UnicodeDecodeError:
        raise json.JSONDecodeError("not UTF-8", "", 0) from None
    except UnicodeEncodeError:
        raise json.JSONDecodeError("a \\u escape is half of a letter that takes two", "", 0) from None
    except RecursionError:
        raise json.JSONDecodeError(TOO_DEEP, "", 0) from None
    except ValueError as error:
        if isinstance(error, json.JSONDecodeError):
            raise
        raise json.JSONDecodeError(str(error), "", 0) from None


class StrictRequest(Request):
    """A request whose JSON is parsed strictly."""

    async def json(self) -> Any:
        """Return the parsed body."""
        return strict_json(await self.body())


class StrictRoute(APIRoute):
    """A route that reads strict JSON."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Wrap the handler so that it sees a `StrictRequest`."""
        handler = super().get_route_handler()

        async def strict(request: Request) -> Response:
            return await handler(StrictRequest(request.scope, request.receive))

        return strict
