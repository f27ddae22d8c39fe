"""Results of a campaign as columns: a row for each run, in the order of points and seeds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from scenarios.arrow import pa
from scenarios.campaign.outcome import Diagnosis, RunOutcome
from scenarios.campaign.sweep import Sweep

FIXED = {
    "seed": "int64",
    "key": "string",
    "digest": "string",
    "ticks": "int64",
    "ok": "bool",
    "trip": "string",
    "error": "string",
    "warnings": "string",
    "elapsed_s": "float64",
}
DIAGNOSIS = {"names": "string", "confusion": "int32", "delays": "int32", "healthy": "int32", "faulty": "int32"}
"""Lists of each diagnoser: hypotheses; samples by truth and verdict, row by row; samples until each change of the
truth was found, null for a missed change; samples by evidence (`scenarios.campaign.outcome.EVIDENCE`)."""
ABOUT = b"combbench"
"""The content of a column, stored with its name: an axis, a figure, or the result of a diagnoser."""

Row = tuple[int, str, RunOutcome]
"""The number of a run, its key, and its outcome."""


def columns(sweep: Sweep, rows: Iterable[Row]) -> pa.Table:
    """Return the finished runs as a table.

    Columns are the number of the point, every axis by its path, the `FIXED` columns (a warning a line), every figure,
    and for each diagnoser `DIAGNOSIS`; a cell is null where a run has no such figure.
    """
    rows = list(rows)
    seeds = len(sweep.seeds)
    numbers = [number // seeds for number, _, _ in rows]
    points = {number: sweep.points[number].labels for number in set(numbers)}
    outcomes = [outcome for _, _, outcome in rows]
    found: dict[str, tuple[str, pa.Array]] = {"point": ("", pa.array(numbers, pa.int32()))}
    for name, kind in axes(sweep).items():
        values = [points[number].get(name) for number in numbers]
        found[name] = ("axis", pa.array([_cell(value, kind) for value in values], kind))
    special = {"key": [key for _, key, _ in rows], "warnings": ["\n".join(one.warnings) for one in outcomes]}
    for name, kind in FIXED.items():
        cells = special[name] if name in special else [getattr(outcome, name) for outcome in outcomes]
        found[name] = ("", pa.array(cells, kind))
    for name in sorted({name for outcome in outcomes for name in outcome.metrics}):
        found[name] = ("figure", pa.array([outcome.metrics.get(name) for outcome in outcomes], pa.float64()))
    for name in sorted({name for outcome in outcomes for name in outcome.diagnosis}):
        said = [outcome.diagnosis.get(name) for outcome in outcomes]
        for part, kind in DIAGNOSIS.items():
            lists = pa.array([_part(one, part) for one in said], pa.list_(pa.type_for_alias(kind)))
            found[f"diagnosis.{name}.{part}"] = ("diagnosis", lists)
    schema = pa.schema([pa.field(name, array.type, metadata={ABOUT: about}) for name, (about, array) in found.items()])
    return pa.table([array for _, array in found.values()], schema=schema)


def axes(sweep: Sweep) -> dict[str, pa.DataType]:
    """Return the labels of the points of a campaign: numbers, or texts where one of them is a text."""
    return {name: pa.string() if is_text else pa.float64() for name, is_text in sweep.points.axes().items()}


def _cell(value: str | float | None, kind: pa.DataType) -> str | float | None:
    return value if value is None else str(value) if pa.types.is_string(kind) else float(value)


def _part(said: Diagnosis | None, part: str) -> Any:
    if said is None:
        return None
    value = getattr(said, part)
    return [count for row in value for count in row] if part == "confusion" else value


def diagnosers(schema: pa.Schema) -> list[str]:
    """Return the diagnosers that said something."""
    return list(dict.fromkeys(name.split(".", 1)[1].rsplit(".", 1)[0] for name in named(schema, "diagnosis")))


def about(field: pa.Field) -> str:
    """Return the content of a column."""
    return str((field.metadata or {}).get(ABOUT, b""), "utf-8")


def named(schema: pa.Schema, what: str) -> list[str]:
    """Return the columns of axes, of figures, or of the results of diagnosers."""
    return [field.name for field in schema if about(field) == what]


def union(schemas: Sequence[pa.Schema]) -> pa.Schema:
    """Return one schema with the columns of all, in the usual order."""
    order = {"": 0, "axis": 1, "figure": 3, "diagnosis": 4}
    fields = {field.name: field for schema in schemas for field in schema}
    fixed = ["point", *named(schemas[0], "axis"), *FIXED]
    rest = sorted(fields.keys() - set(fixed), key=lambda name: (order[about(fields[name])], name))
    return pa.schema([fields[name] for name in (*fixed, *rest)])


def fitted(table: pa.Table, schema: pa.Schema) -> pa.Table:
    """Return a table with the columns of a schema, null where it has none."""
    have = set(table.column_names)
    return pa.table(
        [table[field.name] if field.name in have else pa.nulls(table.num_rows, field.type) for field in schema],
        schema=schema,
    )
