"""Changes to a scenario by dotted paths, for ``--set``."""

from __future__ import annotations

import re
from typing import Any

from core.board.document import Document, has, written_over
from core.errors import InputError
from core.nesting import read_toml
from scenarios.schema import Scenario

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


def with_values(scenario: Scenario, values: dict[str, Any]) -> Scenario:
    """Return the scenario with values written over at their paths.

    Raises
    ------
    InputError
        When a path leads nowhere or the result is not a valid scenario.
    """
    return Scenario.load(written(scenario.document, values)) if values else scenario


def written(document: Document, values: dict[str, Any]) -> Document:
    """Return a scenario with values written over; a fitted field that goes with that is no longer named.

    Printed marks belong to the events they count from, so other events have none; a length in samples takes the place
    of one in milliseconds, and the other way round. It shares the tables that stay as they are.
    """
    changed = written_over(document, values)
    for length, other in (("samples", "duration_ms"), ("duration_ms", "samples")):
        if values.get(length) is not None and other not in values:
            changed.pop(other, None)
    if "events" in values and "printed" not in values:
        changed.pop("printed", None)
    rows = changed.get("expect")
    if isinstance(rows, list) and any(isinstance(row, dict) and isinstance(row.get("fitted"), list) for row in rows):
        changed["expect"] = [_fitted(row, document, changed) for row in rows]
    return changed


def _fitted(row: Any, before: Document, changed: Document) -> Any:
    """Return an expectation that names of its fitted fields those that are still there."""
    if not isinstance(row, dict) or not isinstance(row.get("fitted"), list):
        return row
    left = [path for path in row["fitted"] if not has(before, str(path)) or has(changed, str(path))]
    return {**row, "fitted": left}


def parse_assignment(text: str) -> tuple[str, Any]:
    """Read ``path=value``; the value is TOML, a number as people write it, such as ``.5``, or else plain text.

    Raises
    ------
    InputError
        When there is no ``=``, or the value is nested too deeply.
    """
    path, equals, value = text.partition("=")
    if not equals or not path.strip():
        raise InputError(f"must be PATH=VALUE, got {text!r}", "--set")
    try:
        return path.strip(), read_toml(f"value = {value}", "--set")["value"]
    except InputError as error:
        if error.code != "malformed":
            raise
        plain = value.strip()
        return path.strip(), float(plain) if NUMBER.fullmatch(plain) else plain
