"""Values in declarations: their types, and the operations on them."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, cast

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage
from core.own.offered import MATHEMATICS
from core.own.text import refuse
from core.record import Record

MOST_INTEGER = 2**53

BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
}
COMPARED: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
}
MADE = (bool, enumerate, Equation, float, int, list, Oscillator, range, Stage, tuple, zip)
"""Classes that may be called."""


class Mathematics:
    """The module ``math``, as far as it is offered."""


class Own:
    """The class of the unit, seen from its own methods: its ``Packed`` and its ``State``."""

    def __init__(self, block: type[Block]) -> None:
        self.block = block


class Above:
    """The classes a unit is based on: their ``pack`` and ``state``."""

    def __init__(self, block: type[Block]) -> None:
        self.block = block


@cache
def public(kind: Any) -> frozenset[str]:
    """Return the names of a class of facts that a unit may read: fields and properties, no function."""
    named = {entry.name for entry in fields(kind)} if is_dataclass(kind) else set()
    return frozenset(named | {name for name in dir(kind) if isinstance(getattr(kind, name), property)})


def readable(owner: Any) -> list[str]:
    """Return the names that a unit may read of a value, for an error that lists them."""
    if isinstance(owner, Mathematics):
        return [*MATHEMATICS]
    if isinstance(owner, Own):
        return ["Packed", "State"]
    if isinstance(owner, Record):
        return [field.name for field in owner.layout.fields]
    if isinstance(owner, BlockParams):
        return [*type(owner).model_fields]
    return sorted(public(cast(Any, type(owner)))) if isinstance(owner, Context | Oscillator) else []


def is_scalar(value: Any) -> bool:
    """Say whether a value is a number, a condition, a text or nothing."""
    return value is None or isinstance(value, int | float | str)


def is_number(value: Any) -> bool:
    """Say whether a value is a number, and no condition."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def whole(node: ast.AST, value: int) -> int:
    """Return a whole number, or refuse it when a float64 could not hold it."""
    return value if abs(value) <= MOST_INTEGER else refuse(node, "is a whole number beyond 2^53")


def as_float(node: ast.AST, value: Any) -> float:
    """Return a number to be packed."""
    if not isinstance(value, int | float):
        refuse(node, "is given something that is no number")
    return math.nan if math.isnan(value) else float(value)


def as_read(target: ast.expr) -> ast.expr:
    """Return a written target as a read expression."""
    if isinstance(target, ast.Name):
        return ast.copy_location(ast.Name(target.id, ast.Load()), target)
    return target
