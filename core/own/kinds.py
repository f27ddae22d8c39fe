"""Kinds of values in a step: numbers, truths, whole numbers with their bounds, vectors, records and ports."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, get_args, get_origin, get_type_hints

from core.own.mistakes import Broken
from core.ports import INPUT, BlockPorts
from core.record import RECORD, RECORDS, SCALAR, VECTOR, Field, Record, record_of


@dataclass(frozen=True)
class NumberKind:
    """A float64."""


@dataclass(frozen=True)
class Truth:
    """The kind of a condition."""


@dataclass(frozen=True)
class Whole:
    """A whole number that is a constant, or counts a loop; it may be used in an index.

    Parameters
    ----------
    low, high : int
        A whole number between them, both included.
    counts : bool
        Whether it is below the number of hypotheses of the bank.
    """

    low: int
    high: int
    counts: bool = False


@dataclass(frozen=True)
class Count:
    """The number of hypotheses of the bank."""


@dataclass(frozen=True)
class Numbers:
    """A vector.

    Parameters
    ----------
    count : int
        How many numbers; 0 where it has one for each hypothesis.
    is_written : bool
        Whether the step may write it.
    """

    count: int
    is_written: bool


@dataclass(frozen=True)
class RecordKind:
    """A record."""

    record: type[Record]
    is_written: bool


@dataclass(frozen=True)
class RecordsKind:
    """Several records of one kind."""

    record: type[Record]
    count: int
    is_written: bool


@dataclass(frozen=True)
class Signals:
    """The ports of the unit."""

    ports: type[BlockPorts]


@dataclass(frozen=True)
class Several:
    """The kind of a function that returns several numbers."""

    count: int


@dataclass(frozen=True)
class Nothing:
    """The kind of a function that returns nothing."""


Kind = NumberKind | Truth | Whole | Count | Numbers | RecordKind | RecordsKind | Signals | Several | Nothing | Broken
NUMBER, TRUTH, NOTHING = NumberKind(), Truth(), Nothing()


def is_alike(one: Kind, other: Kind) -> bool:
    """Say whether two kinds are the same, as far as both are known."""
    return one == other or isinstance(one, Broken) or isinstance(other, Broken)


def names_of(kind: Kind) -> list[str]:
    """Return the fields of a record, or the ports of the unit with tick and time."""
    if isinstance(kind, RecordKind):
        return [field.name for field in kind.record.layout.fields]
    return [*(port.name for port in kind.ports.declared), "tick", "time_ms"] if isinstance(kind, Signals) else []


def of_field(owner: RecordKind, name: str) -> tuple[Kind, bool] | None:
    """Return the kind of a field of a record, and whether it may be written; None where there is no such field."""
    field = next((field for field in owner.record.layout.fields if field.name == name), None)
    return None if field is None else (_of(field, owner), owner.is_written and not field.is_choice)


def _of(field: Field, owner: RecordKind) -> Kind:
    if field.kind == SCALAR:
        return NUMBER
    if field.kind == VECTOR:
        return Numbers(field.count, owner.is_written)
    inner = record_of(owner.record._declared[field.name][0])
    assert inner is not None and field.kind in (RECORD, RECORDS)
    return (
        RecordKind(inner, owner.is_written)
        if field.kind == RECORD
        else RecordsKind(inner, field.count, owner.is_written)
    )


def of_port(ports: type[BlockPorts], name: str) -> tuple[Kind, bool] | None:
    """Return the kind of a port and whether the step may write it; None where there is no such port."""
    if name in ("tick", "time_ms"):
        return NUMBER, False
    port = next((port for port in ports.declared if port.name == name), None)
    if port is None:
        return None
    is_written = port.kind != INPUT or port.source.startswith("effects.")
    if port.vector:
        return Numbers(0 if port.each else len(port.labels), is_written), False
    return NUMBER, is_written


@cache
def signature(function: Callable[..., Any]) -> tuple[tuple[Kind | type[Record], ...], Kind]:
    """Return the arguments and the result of a kernel of the library, by its annotations.

    Raises
    ------
    TypeError
        When it takes or returns something else than numbers and records.
    """
    plain: Any = getattr(function, "py_func", function)
    if not inspect.isfunction(plain):  # of Python itself, such as abs
        raise TypeError(f"{plain} has no annotations")
    hints = get_type_hints(plain)
    result = hints.pop("return", None)
    taken: list[Kind | type[Record]] = []
    for hint in hints.values():
        record = record_of(hint)
        if record is None and hint is not float:
            raise TypeError(f"{plain.__name__} takes {hint}")
        taken.append(record or NUMBER)
    if result is float:
        return tuple(taken), NUMBER
    if result is bool:
        return tuple(taken), TRUTH
    if result in (None, type(None)):
        return tuple(taken), NOTHING
    if get_origin(result) is tuple and set(get_args(result)) == {float}:
        return tuple(taken), Several(len(get_args(result)))
    raise TypeError(f"{plain.__name__} returns {result}")
