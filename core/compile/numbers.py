"""Numbers as the compiler sees them, and arithmetic on them with the rules of compiled steps."""

from __future__ import annotations

import ast
import inspect
import operator
from collections.abc import Callable
from dataclasses import dataclass
from types import FunctionType
from typing import Any

import numpy as np
from llvmlite import ir

from core.errors import InputError

NAME = "step"
"""Of the function in machine code."""
BOOL, INT, UINT, FLOAT = 0, 1, 2, 3
"""Kinds of numbers, each wider than the one before."""
DOUBLE, I64, I1 = ir.DoubleType(), ir.IntType(64), ir.IntType(1)
SCALARS = {BOOL: I1, INT: I64, UINT: I64, FLOAT: DOUBLE}


NOTATION = (
    "steps and kernels have assignments, if, while, for over range, arithmetic, comparisons, records, vectors, ports, "
    "and calls of kernels and of abs, min, max, int, float and math.sqrt"
)
"""The way out for a step that says anything else."""


class Unsupported(InputError):
    """Outside the notation; what only boards side by side cannot do runs for one board after another."""

    def at(self, function: FunctionType, node: ast.stmt | ast.expr) -> Unsupported:
        """Return this error with its place in the text of a function, or unchanged if it has a place already."""
        if self.field:
            return self
        text, code = inspect.getsource(function), function.__code__
        line = code.co_firstlineno + node.lineno - 1
        column = len(text) - len(text.lstrip()) + node.col_offset + 1
        return Unsupported(self.message, f"{code.co_filename}:{line}:{column}", self.hint or NOTATION)


@dataclass(frozen=True)
class CompiledNumber:
    """A number while the code runs: one for all boards, or one for each."""

    value: Any
    kind: int

    @property
    def is_lanes(self) -> bool:
        """Whether each board has its own."""
        return isinstance(self.value.type, ir.VectorType)


def is_number(value: Any) -> bool:
    """Say whether something is a number, known now or not."""
    return isinstance(value, CompiledNumber | bool | int | float | np.generic)


PLAIN: dict[type[ast.AST], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.BitXor: operator.xor,
    ast.LShift: operator.lshift,
    ast.RShift: operator.rshift,
}
SIGNS = {ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
ORDER: dict[str, Callable[[Any, Any], Any]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


class Arithmetic:
    """Writes instructions on numbers, of so many boards side by side."""

    def __init__(self, builder: ir.IRBuilder, width: int) -> None:
        self.builder, self.width = builder, width

    def type_of(self, kind: int, *, is_lanes: bool) -> Any:
        """Return the type of a kind of numbers."""
        return ir.VectorType(SCALARS[kind], self.width) if is_lanes else SCALARS[kind]

    def number(self, value: Any) -> CompiledNumber:
        """Return something as a number of the code."""
        if isinstance(value, CompiledNumber):
            return value
        if isinstance(value, bool | np.bool_):
            return CompiledNumber(ir.Constant(I1, int(value)), BOOL)
        if isinstance(value, np.uint64):
            return CompiledNumber(ir.Constant(I64, int(value)), UINT)
        if isinstance(value, int | np.integer):
            return CompiledNumber(ir.Constant(I64, int(value)), INT)
        if isinstance(value, float | np.floating):
            return CompiledNumber(ir.Constant(DOUBLE, float(value)), FLOAT)
        raise Unsupported(f"{value!r} is not a number")

    def spread(self, number: CompiledNumber) -> CompiledNumber:
        """Return a number of all boards as one of each."""
        if number.is_lanes:
            return number
        kind = self.type_of(number.kind, is_lanes=True)
        if isinstance(number.value, ir.Constant):
            return CompiledNumber(ir.Constant(kind, [number.value] * self.width), number.kind)
        first = self.builder.insert_element(ir.Constant(kind, ir.Undefined), number.value, ir.Constant(I64, 0))
        places = ir.Constant(ir.VectorType(ir.IntType(32), self.width), [0] * self.width)
        return CompiledNumber(self.builder.shuffle_vector(first, ir.Constant(kind, ir.Undefined), places), number.kind)

    def as_kind(self, value: Any, kind: int) -> CompiledNumber:
        """Return a number as one of another kind, as Python converts it."""
        number = self.number(value)
        if number.kind == kind:
            return number
        target, build = self.type_of(kind, is_lanes=number.is_lanes), self.builder
        if kind == BOOL:
            zero = ir.Constant(number.value.type, None)
            if number.kind == FLOAT:
                return CompiledNumber(build.fcmp_unordered("!=", number.value, zero), BOOL)
            return CompiledNumber(build.icmp_unsigned("!=", number.value, zero), BOOL)
        if kind == FLOAT:
            change = build.sitofp if number.kind == INT else build.uitofp
        elif number.kind == FLOAT:
            change = build.fptosi if kind == INT else build.fptoui
        elif number.kind == BOOL:
            change = build.zext
        else:
            return CompiledNumber(number.value, kind)
        return CompiledNumber(change(number.value, target), kind)

    def alike(self, *values: Any) -> list[CompiledNumber]:
        """Return numbers of one kind, all of each board or all of every board."""
        kind, is_lanes = self.common(*values)
        numbers = [self.as_kind(value, kind) for value in values]
        return [self.spread(number) for number in numbers] if is_lanes else numbers

    def common(self, *values: Any) -> tuple[int, bool]:
        """Return the kind that numbers have in common, and whether each board has its own."""
        numbers = [self.number(value) for value in values]
        kind = max(number.kind for number in numbers)
        if kind == UINT and any(isinstance(n, CompiledNumber) and n.kind == INT for n in values):
            raise Unsupported("a signed and an unsigned number")
        return kind, any(number.is_lanes for number in numbers)

    def truth(self, value: Any) -> CompiledNumber:
        """Return a number as true or false."""
        return self.as_kind(value, BOOL)

    def select(self, condition: CompiledNumber, yes: Any, no: Any) -> CompiledNumber:
        """Return one of two numbers, in each lane by its own condition."""
        yes, no = self.alike(yes, no)
        if condition.is_lanes:
            yes, no = self.spread(yes), self.spread(no)
        return CompiledNumber(self.builder.select(condition.value, yes.value, no.value), yes.kind)

    def both(self, first: CompiledNumber, second: CompiledNumber) -> CompiledNumber:
        """Return whether two conditions hold."""
        first, second = self.alike(first, second)
        return CompiledNumber(self.builder.and_(first.value, second.value), BOOL)

    def either(self, first: CompiledNumber, second: CompiledNumber) -> CompiledNumber:
        """Return whether one of two conditions holds."""
        first, second = self.alike(first, second)
        return CompiledNumber(self.builder.or_(first.value, second.value), BOOL)

    def opposite(self, condition: CompiledNumber) -> CompiledNumber:
        """Return whether a condition does not hold."""
        return CompiledNumber(self.builder.not_(condition.value), BOOL)

    def any(self, condition: CompiledNumber) -> Any:
        """Return whether a condition holds in some lane, for a branch."""
        if not condition.is_lanes:
            return condition.value
        bits = self.builder.bitcast(condition.value, ir.IntType(self.width))
        return self.builder.icmp_unsigned("!=", bits, ir.Constant(ir.IntType(self.width), 0))

    def negative(self, value: Any) -> Any:
        """Return a number with the other sign."""
        if not isinstance(value, CompiledNumber):
            return -value
        if value.kind == FLOAT:
            return CompiledNumber(self.builder.fneg(value.value), FLOAT)
        value = self.as_kind(value, INT) if value.kind == BOOL else value
        return CompiledNumber(self.builder.neg(value.value), value.kind)

    def compare(self, sign: str, left: Any, right: Any) -> Any:
        """Compare two numbers."""
        if not isinstance(left, CompiledNumber) and not isinstance(right, CompiledNumber):
            return ORDER[sign](left, right)
        left, right = self.alike(left, right)
        if left.kind == FLOAT:
            # of NaN only "not equal" is true
            compare = self.builder.fcmp_unordered if sign == "!=" else self.builder.fcmp_ordered
        else:
            compare = self.builder.icmp_signed if left.kind == INT else self.builder.icmp_unsigned
        return CompiledNumber(compare(sign, left.value, right.value), BOOL)

    def binary(self, sign: type[ast.AST], left: Any, right: Any) -> Any:
        """Do arithmetic on two numbers."""
        if not isinstance(left, CompiledNumber | np.uint64) and not isinstance(right, CompiledNumber | np.uint64):
            if sign is ast.Div and right == 0:  # Python raises an error; a processor gives infinity or NaN
                with np.errstate(all="ignore"):
                    return float(np.float64(left) / np.float64(right))
            return PLAIN[sign](left, right)
        if sign is ast.Pow:
            if right == 2 and not isinstance(right, CompiledNumber):
                return self.binary(ast.Mult, left, left)
            raise Unsupported("a power")
        left, right = self.alike(left, right)
        if left.kind == BOOL:
            if sign in (ast.BitAnd, ast.BitOr, ast.BitXor):
                return self._bits(sign, left, right)
            left, right = self.as_kind(left, INT), self.as_kind(right, INT)
        if sign is ast.Div and left.kind != FLOAT:
            left, right = self.as_kind(left, FLOAT), self.as_kind(right, FLOAT)
        if left.kind == FLOAT:
            return self._real(sign, left, right)
        return self._whole(sign, left, right)

    def plus(self, left: Any, right: Any) -> Any:
        """Add two numbers."""
        return self.binary(ast.Add, left, right)

    def times(self, left: Any, right: Any) -> Any:
        """Multiply two numbers."""
        return self.binary(ast.Mult, left, right)

    def _real(self, sign: type[ast.AST], left: CompiledNumber, right: CompiledNumber) -> CompiledNumber:
        build = self.builder
        simple = {ast.Add: build.fadd, ast.Sub: build.fsub, ast.Mult: build.fmul, ast.Div: build.fdiv}
        if sign in simple:
            return CompiledNumber(simple[sign](left.value, right.value), FLOAT)
        if sign is not ast.Mod:
            raise Unsupported(f"{sign.__name__} of real numbers")
        rest = CompiledNumber(build.frem(left.value, right.value), FLOAT)
        # the remainder has the sign of the divisor
        other = self.binary(ast.BitXor, self.compare("<", rest, 0.0), self.compare("<", right, 0.0))
        moved = self.both(self.compare("!=", rest, 0.0), other)
        whole = self.intrinsic("copysign", 0.0, right)
        rest = self.select(self.compare("==", rest, 0.0), whole, rest)
        return self.select(moved, self.binary(ast.Add, rest, right), rest)

    def _whole(self, sign: type[ast.AST], left: CompiledNumber, right: CompiledNumber) -> CompiledNumber:
        build, kind = self.builder, left.kind
        simple = {ast.Add: build.add, ast.Sub: build.sub, ast.Mult: build.mul, ast.LShift: build.shl}
        if sign in simple:
            return CompiledNumber(simple[sign](left.value, right.value), kind)
        if sign is ast.RShift:
            shift = build.ashr if kind == INT else build.lshr
            return CompiledNumber(shift(left.value, right.value), kind)
        if sign in (ast.Mod, ast.FloorDiv):
            rest = CompiledNumber(build.srem(left.value, right.value), INT)
            other = self.binary(ast.BitXor, self.compare("<", rest, 0), self.compare("<", right, 0))
            moved = self.both(self.compare("!=", rest, 0), other)
            if sign is ast.Mod:
                return self.select(moved, self.binary(ast.Add, rest, right), rest)
            whole = CompiledNumber(build.sdiv(left.value, right.value), INT)
            return self.select(moved, self.binary(ast.Sub, whole, 1), whole)
        return self._bits(sign, left, right)

    def _bits(self, sign: type[ast.AST], left: CompiledNumber, right: CompiledNumber) -> CompiledNumber:
        bits = {ast.BitAnd: self.builder.and_, ast.BitOr: self.builder.or_, ast.BitXor: self.builder.xor}
        if sign not in bits:
            raise Unsupported(f"{sign.__name__} of whole numbers")
        return CompiledNumber(bits[sign](left.value, right.value), left.kind)

    def intrinsic(self, name: str, *values: Any) -> CompiledNumber:
        """Return the result of an instruction on real numbers, such as a square root."""
        numbers = self.alike(*(self.as_kind(value, FLOAT) for value in values))
        kind = numbers[0].value.type
        full = f"llvm.{name}.{f'v{self.width}f64' if numbers[0].is_lanes else 'f64'}"
        module = self.builder.module
        function = module.globals.get(full)
        if function is None:
            function = ir.Function(module, ir.FunctionType(kind, [kind] * len(numbers)), full)
        return CompiledNumber(self.builder.call(function, [number.value for number in numbers]), FLOAT)
