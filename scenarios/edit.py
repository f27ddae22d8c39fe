"""Changes to a scenario by dotted paths, for ``--set``."""

from __future__ import annotations

import re
from typing import Any

from core.board.document import Document, has, written_over
from core.errors import InputError
from core.nesting import read_toml
from scenarios.schema import HEAD, Scenario

OF_NO_BENCH = {"controller", "controllers", "diagnosers", "identifiers", "seed", "twins", *HEAD} - {
    "samples",
    "duration_ms",
}
"""Parts of a scenario that its comparator does not depend on, which was chosen without faults."""

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
    """Return a scenario with values written over; a fitted field that changes with them is no longer named.

    Printed marks belong to the events they count from, so other events have none; a comparator belongs to the bench it
    was chosen on, so another bench has none; a length in samples takes the place of one in milliseconds, and the other
    way round. It shares the tables that stay as they are.
    """
    changed = written_over(document, values)
    for length, other in (("samples", "duration_ms"), ("duration_ms", "samples")):
        if values.get(length) is not None and other not in values:
            changed.pop(other, None)
    if "events" in values and "printed" not in values:
        changed.pop("printed", None)
    changes = {path.partition(".")[0] for path in values}
    if "comparator" not in changes and changes - OF_NO_BENCH:
        changed.pop("comparator", None)
    rows = changed.get("expect")
    if isinstance(rows, list) and any(isinstance(row, dict) and row.keys() & {"fitted", "pid_too"} for row in rows):
        changed["expect"] = [_still(row, document, changed) for row in rows]
    return changed


def _still(row: Any, before: Document, changed: Document) -> Any:
    """Return an expectation that names only its remaining fitted fields and its PID."""
    if not isinstance(row, dict):
        return row
    row = {**row}
    if isinstance(row.get("fitted"), list):
        row["fitted"] = [path for path in row["fitted"] if not has(before, str(path)) or has(changed, str(path))]
    if "comparator" in before and "comparator" not in changed:
        row.pop("pid_too", None)
    return row


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
