"""The values that a run changes against its scenario in the library."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from typing import Any

from pydantic import BaseModel, Field

from core.board.document import PARKED, Document
from scenarios.library import get, ids

APART = frozenset("schema id title source summary claim verdict metrics seed expect printed comparator".split())
"""Parts that are no values of the bench; a run has its seeds apart."""

Value = str | bool | int | float | None


class ChangedValue(BaseModel):
    """A value of a run that differs from its scenario in the library."""

    path: str = Field(description="Dotted path; an entry of a list by its position, from 0")
    before: Value = Field(description="Value in the library; null: it has none")
    value: Value = Field(description="Value of the run; a list as JSON")


def changed_values(scenario_id: str, document: Document) -> list[ChangedValue]:
    """Return the values of a run that differ, in its order; none if the library does not have its scenario."""
    return differing(_of_library(scenario_id), document) if scenario_id in ids() else []


def differing(usual: dict[str, Value], document: Document) -> list[ChangedValue]:
    """Return the values of a scenario that differ from the values of another."""
    return [
        ChangedValue(path=path, before=usual.get(path), value=value)
        for path, value in values_of(document).items()
        if usual.get(path) != value
    ]


@cache
def _of_library(scenario_id: str) -> dict[str, Value]:
    return values_of(get(scenario_id).document)


def values_of(document: Document) -> dict[str, Value]:
    """Return the values of a scenario by path.

    A parameter of the controller or the sensor in use has its path in the table of all of them, where another value
    does not count.
    """
    found: dict[str, Value] = {}
    for path, value in _leaves({key: part for key, part in document.items() if key not in APART}):
        one, _, name = path.partition(".")
        if one in PARKED and name not in ("", "kind"):
            found[f"{PARKED[one][0]}.{document[one].get('kind', '')}.{name}"] = value
        else:
            found.setdefault(path, value)
    return found


def _leaves(part: Any, path: str = "") -> Iterator[tuple[str, Value]]:
    """Go through the values of a part with their paths."""
    if isinstance(part, list) and not any(isinstance(one, dict) for one in part):
        yield path, json.dumps(part, default=str)
    elif isinstance(part, dict | list):
        for key, inner in part.items() if isinstance(part, dict) else enumerate(part):
            yield from _leaves(inner, f"{path}.{key}" if path else str(key))
    else:
        yield path, part
