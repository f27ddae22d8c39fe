"""Expressions of a step: each is checked, and written anew in the plainest way.

Numbers are float64 throughout; a whole number combined with a float becomes a float. Whole numbers are constants and
counters of loops, and are allowed in an index as long as their bounds prove that it exists. An index computed from data
is ``int(...)``: it is checked while the step runs, and for a missing item the step reads NaN and writes nothing.
"""

from __future__ import annotations

import ast
import math
from collections import Counter
from collections.abc import Callable
from typing import Any

from core.own.guarded import item
from core.own.kinds import (
    NUMBER,
    TRUTH,
    Count,
    Kind,
    Nothing,
    NumberKind,
    Numbers,
    RecordKind,
    RecordsKind,
    Several,
    Signals,
    Truth,
    Whole,
    names_of,
    of_field,
    of_port,
)
from core.own.mistakes import BROKEN, Broken, follows, nearest
from core.own.text import refuse
from core.own.values import MOST_INTEGER, Mathematics

Checked = tuple[Kind, ast.expr]
COMPARED = (ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq)
ARITHMETIC = (ast.Add, ast.Sub, ast.Mult, ast.Div)
OTHER_WAYS: dict[type[ast.expr], str] = {
    **dict.fromkeys((ast.List, ast.Tuple, ast.Set, ast.Dict), "; keep several numbers in a Vector of State or Packed"),
    **dict.fromkeys((ast.ListComp, ast.GeneratorExp), "; write a loop, and add up in a name"),
    **dict.fromkeys((ast.Lambda,), "; write a function above the class, marked @kernel"),
    **dict.fromkeys((ast.JoinedStr,), "; a text is for titles and refusals"),
}
"""Ways out of expressions that a step does not have."""
ITEM, PUT = "_item", "_put"
"""Names of the functions that read and write a vector at an index from data."""


def named(name: str) -> ast.expr:
    """Return a name that is read."""
    return ast.Name(name, ast.Load())


def called(name: str, *arguments: ast.expr) -> ast.expr:
    """Return a call of a function by its name."""
    return ast.Call(named(name), list(arguments), [])


class OwnExpressions:
    """Checks expressions within one function.

    Attributes
    ----------
    kinds : dict
        Kinds of the names that have a value here.
    used : dict
        Functions of the library that the code names.
    times : Counter
        How often each name of the function is assigned to, the counters of loops left out.
    cost : int
        Most operations that the code so far takes.
    """

    def __init__(self, names: dict[str, Any], used: dict[str, Any]) -> None:
        self.names, self.used = names, used
        self.kinds: dict[str, Kind] = {}
        self.times: Counter[str] = Counter()
        self.cost = 0
        self.factor = 1

    def call(self, node: ast.Call) -> Checked:
        """Check a call."""
        raise NotImplementedError

    def count(self, node: ast.AST, operations: int = 1) -> None:
        """Count operations, as often as the loops around them go."""
        raise NotImplementedError

    def number(self, node: ast.expr) -> ast.expr:
        """Check an expression whose value is a number."""
        return self.as_number(node, self.value(node))

    def as_number(self, node: ast.expr, checked: Checked) -> ast.expr:
        """Return a checked expression as a number."""
        kind, made = checked
        if isinstance(kind, NumberKind):
            return made
        if isinstance(kind, Whole):
            if kind.low == kind.high and isinstance(made, ast.Constant):
                return ast.Constant(float(kind.low))
            return called("float", made)
        if isinstance(kind, Count):
            return called("float", made)
        return refuse(node, f"is no number{_instead(kind)}")

    def truth(self, node: ast.expr) -> ast.expr:
        """Check an expression that is a condition."""
        kind, made = self.value(node)
        return made if isinstance(kind, Truth) else refuse(node, "is no condition; compare it, such as with != 0.0")

    def value(self, node: ast.expr) -> Checked:
        """Check an expression; return its kind and its new form."""
        self.count(node)
        checks: dict[type[ast.expr], Callable[[Any], Checked]] = {
            ast.Constant: self._constant,
            ast.Name: self._name,
            ast.Attribute: self._attribute,
            ast.Subscript: self._subscript,
            ast.BinOp: self._binop,
            ast.UnaryOp: self._unaryop,
            ast.Compare: self._compare,
            ast.BoolOp: self._boolop,
            ast.IfExp: self._ifexp,
            ast.Call: self.call,
        }
        check = checks.get(type(node))
        if check is None:
            name = type(node).__name__
            text = f"a step has no expression {name}: it has numbers, names, arithmetic, comparisons and calls"
            refuse(node, text + OTHER_WAYS.get(type(node), ""))
        return check(node)

    def _constant(self, node: ast.Constant) -> Checked:
        value = node.value
        if isinstance(value, bool):
            return TRUTH, ast.Constant(value)
        if isinstance(value, float):
            return NUMBER, ast.Constant(value)
        if isinstance(value, int) and abs(value) <= MOST_INTEGER:
            return Whole(value, value), ast.Constant(value)
        return refuse(node, "is no number that a step can have; a text or a list stays in pack")

    def _name(self, node: ast.Name) -> Checked:
        if (kind := self.kinds.get(node.id)) is not None and not isinstance(kind, Broken):
            return kind, named(node.id)
        value = self.names.get(node.id)
        if kind is not None or value is BROKEN:
            raise follows(node)
        if isinstance(value, bool) or (not isinstance(value, int | float)):
            return refuse(node, f"{node.id} has no value here{self._without_value(node.id)}")
        if isinstance(value, int):
            return Whole(value, value), ast.Constant(value)
        if not math.isfinite(value):
            self.used["_inf"] = math.inf
            return NUMBER, named("_inf") if value > 0 else ast.UnaryOp(ast.USub(), named("_inf"))
        return NUMBER, ast.Constant(value)

    def _without_value(self, name: str) -> str:
        """Return the way out for a name without a value: the reason, or the nearest name."""
        if name in self.names:
            return "; a function is called, and a tuple read at a constant index"
        if self.times[name]:
            return "; assign it before this line, on every way to it"
        numbers = (known for known, value in self.names.items() if isinstance(value, int | float))
        fields = (f"{owner}.{field}" for owner, kind in self.kinds.items() for field in names_of(kind))
        return nearest(name, (*self.kinds, *numbers), fields)

    def member(self, node: ast.Attribute) -> tuple[Kind, bool, ast.expr]:
        """Return the kind of a field or port, whether it may be written, and its owner written anew."""
        if isinstance(node.value, ast.Name) and node.value.id not in self.kinds:
            owner = self.names.get(node.value.id)
            if isinstance(owner, Mathematics) and node.attr in ("pi", "inf"):
                return NUMBER, False, node.value
        kind, made = self.value(node.value)
        found = None
        if isinstance(kind, Signals):
            found = of_port(kind.ports, node.attr)
        elif isinstance(kind, RecordKind):
            found = of_field(kind, node.attr)
        if found is None:
            refuse(node, f"has no {node.attr}{nearest(node.attr, names_of(kind))}")
        return (*found, made)

    def _attribute(self, node: ast.Attribute) -> Checked:
        kind, _, owner = self.member(node)
        if isinstance(owner, ast.Name) and owner.id not in self.kinds:
            if node.attr == "pi":
                return NUMBER, ast.Constant(math.pi)
            self.used["_inf"] = math.inf
            return NUMBER, named("_inf")
        return kind, ast.Attribute(owner, node.attr, ast.Load())

    def item(self, node: ast.Subscript) -> tuple[Kind, Numbers | RecordsKind, ast.expr, ast.expr, bool]:
        """Return the item of an index, the vector, both written anew, and whether the item is proved to exist."""
        kind, owner = self.value(node.value)
        if not isinstance(kind, Numbers | RecordsKind):
            refuse(node, "is no vector; declare it as a Vector, or leave the index out")
        is_known = True
        if isinstance(kind, Numbers) and is_int_of_data(node.slice):
            index = self.number(node.slice.args[0])  # type: ignore[attr-defined]
            is_known = False
            if kind.count == 0:
                refuse(node, "has one number for each hypothesis; count them with range(int(p.count))")
        else:
            bounds, index = self.value(node.slice)
            if not isinstance(bounds, Whole):
                refuse(node.slice, "is no index: write a counter of a loop, a constant, or int(...)")
            if kind.count == 0 and not bounds.counts:
                refuse(node.slice, "may be no hypothesis; count them with range(int(p.count))")
            if kind.count and not (bounds.low >= 0 and bounds.high < kind.count):
                refuse(node.slice, f"is from {bounds.low} to {bounds.high}; there are {kind.count} items, from 0")
        inner: Kind = NUMBER if isinstance(kind, Numbers) else RecordKind(kind.record, kind.is_written)
        return inner, kind, owner, index, is_known

    def _subscript(self, node: ast.Subscript) -> Checked:
        if isinstance(node.value, ast.Name) and isinstance(numbers := self.names.get(node.value.id), tuple):
            return self._item_of(node, numbers)
        kind, vector, owner, index, is_known = self.item(node)
        if is_known:
            return kind, ast.Subscript(owner, index, ast.Load())
        self.used[ITEM] = item
        return kind, called(ITEM, owner, ast.Constant(float(vector.count)), index)

    def _item_of(self, node: ast.Subscript, numbers: tuple[Any, ...]) -> Checked:
        """Check an item of a tuple that is a constant of the file; the step gets the number itself."""
        bounds, _ = self.value(node.slice)
        if not isinstance(bounds, Whole) or bounds.low != bounds.high or not 0 <= bounds.low < len(numbers):
            refuse(node, "a tuple is read at a constant index; copy it into a Vector of Packed to count through it")
        number = numbers[bounds.low]
        if isinstance(number, bool) or not isinstance(number, int | float) or not math.isfinite(number):
            refuse(node, "is no number that a step can have")
        return NUMBER, ast.Constant(float(number))

    def _binop(self, node: ast.BinOp) -> Checked:
        first, second = self.value(node.left), self.value(node.right)
        (left, one), (right, other) = first, second
        if isinstance(left, Whole) and isinstance(right, Whole) and not isinstance(node.op, ast.Div):
            return self._whole(node, left, right, one, other)
        if not isinstance(node.op, ARITHMETIC):
            refuse(node, "a step has only + - * / of numbers; write products for a power, floor(...) for a quotient")
        return NUMBER, ast.BinOp(self.as_number(node.left, first), node.op, self.as_number(node.right, second))

    def _whole(self, node: ast.BinOp, left: Whole, right: Whole, one: ast.expr, other: ast.expr) -> Checked:
        ends = [(a, b) for a in (left.low, left.high) for b in (right.low, right.high)]
        if isinstance(node.op, ast.Add):
            results = [a + b for a, b in ends]
        elif isinstance(node.op, ast.Sub):
            results = [a - b for a, b in ends]
        elif isinstance(node.op, ast.Mult):
            results = [a * b for a, b in ends]
        elif isinstance(node.op, ast.FloorDiv | ast.Mod) and right.low == right.high > 0 and left.low >= 0:
            n = right.low
            if isinstance(node.op, ast.FloorDiv):
                results = [left.low // n, left.high // n]
            else:
                results = [0, min(n - 1, left.high)]
        else:
            refuse(node, "whole numbers have + - *, and // and % by a constant above 0")
        if max(map(abs, results)) > MOST_INTEGER:
            refuse(node, "is a whole number beyond 2^53; write it as a float, such as 1e16")
        if left.low == left.high and right.low == right.high:
            return Whole(results[0], results[0]), ast.Constant(results[0])
        stays = isinstance(node.op, ast.Sub) and left.counts and right.low >= 0 and min(results) >= 0
        return Whole(min(results), max(results), stays), ast.BinOp(one, node.op, other)

    def _unaryop(self, node: ast.UnaryOp) -> Checked:
        if isinstance(node.op, ast.Not):
            return TRUTH, ast.UnaryOp(node.op, self.truth(node.operand))
        if isinstance(node.op, ast.Invert):
            refuse(node, "a step has no ~; write not")
        checked = self.value(node.operand)
        kind = checked[0]
        if isinstance(kind, Whole) and kind.low == kind.high:
            value = -kind.low if isinstance(node.op, ast.USub) else kind.low
            return Whole(value, value), ast.Constant(value)
        made = self.as_number(node.operand, checked)
        return NUMBER, ast.UnaryOp(node.op, made) if isinstance(node.op, ast.USub) else made

    def _compare(self, node: ast.Compare) -> Checked:
        if any(not isinstance(sign, COMPARED) for sign in node.ops):
            refuse(node, "a step has only < <= > >= == !=; `is` and `in` compare objects, and a step has numbers")
        parts = [self.number(part) for part in (node.left, *node.comparators)]
        return TRUTH, ast.Compare(parts[0], node.ops, parts[1:])

    def _boolop(self, node: ast.BoolOp) -> Checked:
        return TRUTH, ast.BoolOp(node.op, [self.truth(part) for part in node.values])

    def _ifexp(self, node: ast.IfExp) -> Checked:
        return NUMBER, ast.IfExp(self.truth(node.test), self.number(node.body), self.number(node.orelse))


def _instead(kind: Kind) -> str:
    """Return the way from a value to a number."""
    if isinstance(kind, Truth):
        return ", but a condition; write 1.0 if ... else 0.0"
    if isinstance(kind, Numbers | RecordsKind):
        return ", but a vector; read an item, such as [0]"
    if isinstance(kind, RecordKind | Signals):
        return f"; read a field, such as .{names_of(kind)[0]}" if names_of(kind) else ""
    if isinstance(kind, Several):
        return f", but {kind.count} numbers; assign them to {kind.count} names"
    return "; the function returns nothing" if isinstance(kind, Nothing) else ""


def is_int_of_data(node: ast.expr) -> bool:
    """Say whether an index is ``int(...)``."""
    return (
        isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "int" and len(node.args) == 1
    )
