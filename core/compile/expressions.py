"""Expressions of translated steps."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np
from llvmlite import ir

from core.compile.arrays import ArrayPlace, ArrayView, Bound
from core.compile.numbers import DOUBLE, FLOAT, I64, INT, SIGNS, CompiledNumber, Unsupported, is_number
from core.compile.places import Place, PortsView, RecordsView, RecordView, VectorView
from core.compile.variables import Variables

NEEDED = ast.Call, ast.Subscript, ast.Mod, ast.FloorDiv
"""Expressions that are computed only where needed: they may write, read beyond an end, or divide by 0."""


class Expressions(Variables):
    """Translates expressions."""

    def call(self, function: Any, arguments: Sequence[Any], named: dict[str, Any] | None = None) -> Any:
        """Translate a call of a function."""
        raise NotImplementedError

    @contextmanager
    def told(self, node: ast.expr | ast.stmt) -> Iterator[None]:
        """Add the place in the text to an error about the notation."""
        try:
            yield
        except Unsupported as error:
            raise error.at(self.frame.function, node) from None
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            raise Unsupported(str(error)).at(self.frame.function, node) from None

    def value(self, node: ast.expr) -> Any:
        """Translate an expression."""
        method = getattr(self, f"_{type(node).__name__.lower()}", None)
        with self.told(node):
            if method is None:
                raise Unsupported(f"an expression {type(node).__name__}")
            return method(node)

    def _constant(self, node: ast.Constant) -> Any:
        return node.value

    def _name(self, node: ast.Name) -> Any:
        return self.name(node.id)

    def _tuple(self, node: ast.Tuple) -> Any:
        return tuple(self.value(part) for part in node.elts)

    def _attribute(self, node: ast.Attribute) -> Any:
        owner = self.value(node.value)
        if isinstance(owner, PortsView):
            place, seen = self.memory.port(owner, node.attr)
            if seen is True:
                return VectorView(place.base)
            if seen is False or seen == "shared":
                return self.memory.read(place, self.mask, shared=seen == "shared")
            return RecordsView(place.base, None, seen)
        if isinstance(owner, RecordView):
            return self.memory.attribute(owner, node.attr, self.mask)
        if isinstance(owner, ArrayView) and node.attr in ("shape", "view"):
            return owner.lengths if node.attr == "shape" else Bound(owner)
        if isinstance(owner, CompiledNumber | Place | ArrayView):
            raise Unsupported(f"an attribute {node.attr}")
        return getattr(owner, node.attr)

    def _subscript(self, node: ast.Subscript) -> Any:
        owner, index = self.value(node.value), self.value(node.slice)
        if isinstance(owner, tuple) and isinstance(index, int):
            return owner[index]
        if isinstance(owner, VectorView):
            return self.memory.read(self.memory.item(owner, index), self.mask)
        if isinstance(owner, ArrayView):
            part = self.arrays.part(owner, index if isinstance(index, tuple) else (index,))
            return self.arrays.read(part) if isinstance(part, ArrayPlace) else part
        if isinstance(owner, RecordsView):
            return self.memory.item(owner, index)
        if isinstance(owner, np.ndarray):
            return self._constant_at(owner, index)
        raise Unsupported(f"a part of {ast.unparse(node.value)}")

    def _slice(self, node: ast.Slice) -> slice:
        if node.step is not None:
            raise Unsupported("a slice with a step")
        return slice(*(self.value(part) if part else None for part in (node.lower, node.upper)))

    def _constant_at(self, numbers: Any, index: Any) -> Any:
        """Return a number of an array that never changes."""
        at = self.arithmetic.as_kind(index, INT)
        if at.is_lanes or numbers.ndim != 1:
            raise Unsupported("different numbers of an array")
        kind = ir.ArrayType(DOUBLE, len(numbers))
        name = f"numbers.{id(numbers)}"
        held = self.builder.module.globals.get(name)
        if held is None:
            held = ir.GlobalVariable(self.builder.module, kind, name)
            held.initializer, held.global_constant = ir.Constant(kind, numbers.astype(float).tolist()), True
            held.linkage = "private"
        return CompiledNumber(self.builder.load(self.builder.gep(held, [ir.Constant(I64, 0), at.value])), FLOAT)

    def _binop(self, node: ast.BinOp) -> Any:
        return self.arithmetic.binary(type(node.op), self.value(node.left), self.value(node.right))

    def _unaryop(self, node: ast.UnaryOp) -> Any:
        value = self.value(node.operand)
        if isinstance(node.op, ast.USub):
            return self.arithmetic.negative(value)
        if isinstance(node.op, ast.Not):
            return (
                self.arithmetic.opposite(self.arithmetic.truth(value))
                if isinstance(value, CompiledNumber)
                else not value
            )
        raise Unsupported(f"a sign {type(node.op).__name__}")

    def _compare(self, node: ast.Compare) -> Any:
        left, found = self.value(node.left), None
        for sign, right in zip(node.ops, node.comparators, strict=True):
            if type(sign) not in SIGNS:
                raise Unsupported(f"a comparison {type(sign).__name__}")
            value = self.value(right)
            one = self.arithmetic.compare(SIGNS[type(sign)], left, value)
            found = one if found is None else self._joined(ast.And(), found, one)
            left = value
        return found

    def _boolop(self, node: ast.BoolOp) -> Any:
        found = self.value(node.values[0])
        for part in node.values[1:]:
            if not isinstance(found, CompiledNumber):  # known now, so the rest may not even be meant
                if bool(found) is isinstance(node.op, ast.Or):
                    return found
                found = self.value(part)
            else:
                found = self.arithmetic.truth(found)
                open_ = found if isinstance(node.op, ast.And) else self.arithmetic.opposite(found)
                if self._branches(open_, part):
                    found = self._chosen(open_, partial(self._truth, part), found)
                else:
                    found = self._joined(node.op, found, self._under(open_, part))
        return found

    def _truth(self, node: ast.expr) -> CompiledNumber:
        return self.arithmetic.truth(self.value(node))

    def _branches(self, condition: CompiledNumber, *parts: ast.expr) -> bool:
        """Say whether parts of an expression are computed only where a condition holds, by a branch of the code."""
        return not condition.is_lanes and any(isinstance(one, NEEDED) for part in parts for one in ast.walk(part))

    def _chosen(
        self, condition: CompiledNumber, yes: Callable[[], Any], no: CompiledNumber | Callable[[], Any]
    ) -> CompiledNumber:
        """Return the first or the second number; the code computes only this one."""
        build = self.builder
        ways, behind = (build.append_basic_block(), build.append_basic_block()), build.append_basic_block()
        build.cbranch(condition.value, *ways)
        found, ends = [], []
        for way, make in zip(ways, (yes, no), strict=True):
            build.position_at_end(way)
            value = make if isinstance(make, CompiledNumber) else make()
            if not is_number(value):
                raise Unsupported("a choice between anything but numbers")
            found.append(self.arithmetic.number(value))
            ends.append(build.block)
        kind, is_lanes = self.arithmetic.common(*found)
        slot_type = self.arithmetic.type_of(kind, is_lanes=is_lanes)
        values = []
        for number, end in zip(found, ends, strict=True):
            build.position_at_end(end)
            number = self.arithmetic.as_kind(number, kind)
            values.append((self.arithmetic.spread(number) if is_lanes else number).value)
            build.branch(behind)
        build.position_at_end(behind)
        joined = build.phi(slot_type)
        for value, end in zip(values, ends, strict=True):
            joined.add_incoming(value, end)
        return CompiledNumber(joined, kind)

    def _under(self, condition: CompiledNumber, node: ast.expr) -> Any:
        """Translate an expression that only counts where a condition holds."""
        outer = self.mask
        self.mask = self.within(outer, condition) if condition.is_lanes else outer
        value = self.value(node)
        self.mask = outer
        return value

    def _joined(self, sign: ast.boolop, first: Any, second: Any) -> Any:
        one, other = self.arithmetic.truth(first), self.arithmetic.truth(second)
        return (self.arithmetic.both if isinstance(sign, ast.And) else self.arithmetic.either)(one, other)

    def _ifexp(self, node: ast.IfExp) -> Any:
        condition = self.value(node.test)
        if not isinstance(condition, CompiledNumber):
            return self.value(node.body if condition else node.orelse)
        condition = self.arithmetic.truth(condition)
        if self._branches(condition, node.body, node.orelse):
            return self._chosen(condition, partial(self.value, node.body), partial(self.value, node.orelse))
        yes = self._under(condition, node.body)
        no = self._under(self.arithmetic.opposite(condition), node.orelse)
        if not (is_number(yes) and is_number(no)):
            raise Unsupported("a choice between anything but numbers")
        return self.arithmetic.select(condition, yes, no)

    def _call(self, node: ast.Call) -> Any:
        function = self.value(node.func)
        arguments = [self.value(argument) for argument in node.args]
        named = {keyword.arg: self.value(keyword.value) for keyword in node.keywords if keyword.arg}
        return self.call(function, arguments, named)
