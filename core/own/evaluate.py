"""Works out the declarations and packed numbers of a unit: numbers, texts, records, in a bounded number of operations.

It walks the syntax tree. Every kind of node, every attribute and every function is one of a list; nothing leads from a
value to anything else.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Sequence
from typing import Any, cast

import numpy as np

from core.block import Block, BlockParams, Context, Oscillator
from core.errors import InputError
from core.kernel import is_kernel
from core.own.kinds import NumberKind, signature
from core.own.mistakes import BROKEN, follows, nearest
from core.own.offered import MATHEMATICS, PYTHON
from core.own.text import refuse
from core.own.values import (
    BINARY,
    COMPARED,
    MADE,
    Above,
    Mathematics,
    Own,
    as_float,
    as_read,
    is_number,
    is_scalar,
    public,
    readable,
    whole,
)
from core.plain import plain
from core.record import RECORD, SCALAR, Field, Record, Records

MOST_OPERATIONS = 100_000
"""Operations of all declarations of a unit, and of one call of a method: some tenths of a second."""
MOST_ITEMS = 10_000
DEEPEST_CALLS = 10
COST_OF_CALL = 30
"""Operations of a call of a library function; its arguments and results count in addition."""
COST_OF_BASE = 1_000
"""Operations that the ``pack`` or ``state`` of a base counts as."""


class Evaluator:
    """Evaluates expressions and runs methods.

    Parameters
    ----------
    names : dict
        Meanings of names outside functions.
    """

    def __init__(self, names: dict[str, Any]) -> None:
        self.names = names
        self._left, self._deep = MOST_OPERATIONS, 0

    def constant(self, node: ast.expr) -> Any:
        """Return the value of an expression of a declaration; all of a unit share one count."""
        return self.value(node, {})

    def call(self, function: ast.FunctionDef, arguments: Sequence[Any], block: type[Block]) -> Any:
        """Run a method of the unit and return its result."""
        self._left = MOST_OPERATIONS
        local = {argument.arg: value for argument, value in zip(function.args.args, arguments, strict=True)}
        _, result = self._run(function.body, {**local, "super": lambda: Above(block)})
        return result

    def _run(self, body: Sequence[ast.stmt], local: dict[str, Any]) -> tuple[bool, Any]:
        """Run statements; return whether they returned, and their value."""
        for node in body:
            self._count(node)
            if isinstance(node, ast.Return):
                return True, self.value(node.value, local) if node.value is not None else None
            if isinstance(node, ast.If):
                ended, result = self._run(node.body if self.value(node.test, local) else node.orelse, local)
                if ended:
                    return True, result
            elif isinstance(node, ast.For) and not node.orelse:
                for item in self._items(self.value(node.iter, local), node):
                    self._store(node.target, item, local)
                    ended, result = self._run(node.body, local)
                    if ended:
                        return True, result
            elif isinstance(node, ast.Assign):
                value = self.value(node.value, local)
                for target in node.targets:
                    self._store(target, value, local)
            elif isinstance(node, ast.AnnAssign) and node.value is not None:
                self._store(node.target, self.value(node.value, local), local)
            elif isinstance(node, ast.AugAssign):
                before = self.value(as_read(node.target), local)
                self._store(node.target, self._binary(node, node.op, before, self.value(node.value, local)), local)
            elif isinstance(node, ast.Expr):
                self.value(node.value, local)
            else:
                self.check_statement(node)
        return False, None

    @staticmethod
    def check_statement(node: ast.stmt) -> None:
        """Refuse a statement that no method has."""
        allowed = ast.Return | ast.If | ast.For | ast.Assign | ast.AugAssign | ast.Expr | ast.Pass
        if isinstance(node, ast.For) and node.orelse:
            refuse(node, "a loop has no else; write the statements after it")
        if not (isinstance(node, allowed) or (isinstance(node, ast.AnnAssign) and node.value is not None)):
            name = type(node).__name__
            refuse(node, f"a statement {name} cannot stand here; a method has assignments, if, for and return")

    @classmethod
    def check_expression(cls, node: ast.expr) -> None:
        """Refuse an expression that no method has."""
        if not hasattr(cls, f"_{type(node).__name__.lower()}"):
            name = type(node).__name__
            refuse(node, f"an expression {name} cannot stand here; a method has numbers, texts, lists and calls")

    def value(self, node: ast.expr, local: dict[str, Any]) -> Any:
        """Return the value of an expression."""
        self._count(node)
        self.check_expression(node)
        method = getattr(self, f"_{type(node).__name__.lower()}")
        try:
            return method(node, local)
        except InputError:
            raise
        except (ArithmeticError, ValueError, TypeError, IndexError, AttributeError) as error:
            refuse(node, f"cannot be worked out: {error}")

    def _count(self, node: ast.AST, operations: int = 1) -> None:
        was_spent = self._left < 0
        self._left -= operations
        if was_spent:
            raise follows(node)
        if self._left < 0:
            refuse(node, f"takes more than {MOST_OPERATIONS} operations; shorten its lists and loops")

    def _weigh(self, node: ast.AST, *values: Any) -> None:
        """Count the items of lists, also of lists in lists: a list may be in another many times."""
        inside = [*values]
        while inside:
            one = inside.pop()
            if isinstance(one, list | tuple):
                self._count(node, len(one))
                inside.extend(one)
            elif isinstance(one, str | np.ndarray | Records):
                self._count(node, len(one) // 8)
            elif isinstance(one, Record):
                self._count(node, one.layout.size // 8)

    def _constant(self, node: ast.Constant, local: dict[str, Any]) -> Any:
        if isinstance(node.value, bool | float | str) or node.value is None:
            return node.value
        return whole(node, node.value) if isinstance(node.value, int) else refuse(node, "is no number and no text")

    def _name(self, node: ast.Name, local: dict[str, Any]) -> Any:
        if node.id in local:
            return local[node.id]
        if (known := self.names.get(node.id)) is BROKEN:
            raise follows(node)
        if node.id in self.names:
            return known
        return refuse(node, f"{node.id} is not declared{nearest(node.id, (*local, *self.names))}")

    def _attribute(self, node: ast.Attribute, local: dict[str, Any]) -> Any:
        owner, name = self.value(node.value, local), node.attr
        if isinstance(owner, Mathematics) and name in MATHEMATICS:
            return MATHEMATICS[name]
        if isinstance(owner, Own) and name in ("Packed", "State"):
            return getattr(owner.block, name)
        if isinstance(owner, Above) and name in ("pack", "state"):
            base = getattr(super(owner.block, owner.block), name)
            self._count(node, COST_OF_BASE)
            return lambda params, context: base(params, context)
        if isinstance(owner, type) and issubclass(owner, Record) and name in ("blank", "zeros"):
            made = getattr(owner, name)
            return lambda: made()
        if isinstance(owner, Record) and self._field(node, owner, name) is not None:
            return getattr(owner, name)
        if isinstance(owner, BlockParams) and name in type(owner).model_fields:
            return getattr(owner, name)
        if isinstance(owner, Context | Oscillator) and name in public(cast(Any, type(owner))):
            fact = getattr(owner, name)
            if fact is None or isinstance(fact, int | float | str | tuple | Oscillator | BlockParams):
                return fact
        return refuse(node, f"has no {name} that a unit may read{nearest(name, readable(owner))}")

    def _field(self, node: ast.AST, owner: Record, name: str) -> Field | None:
        """Return a field of a record, or nothing."""
        self._count(node, len(owner.layout.fields) // 8)
        return next((field for field in owner.layout.fields if field.name == name), None)

    def _subscript(self, node: ast.Subscript, local: dict[str, Any]) -> Any:
        owner, index = self.value(node.value, local), self.value(node.slice, local)
        self._check_index(node, owner, index)
        return owner[index]

    def _tuple(self, node: ast.Tuple, local: dict[str, Any]) -> Any:
        return tuple(self._list(node, local))

    def _list(self, node: ast.List | ast.Tuple, local: dict[str, Any]) -> list[Any]:
        found: list[Any] = []
        for part in node.elts:
            if isinstance(part, ast.Starred):
                found += self._items(self.value(part.value, local), part)
            else:
                found.append(self.value(part, local))
        return found

    def _starred(self, node: ast.Starred, local: dict[str, Any]) -> Any:
        refuse(node, "a star stands in a list or a tuple alone, and never in a call")

    def _listcomp(self, node: ast.ListComp | ast.GeneratorExp, local: dict[str, Any]) -> Any:
        if len(node.generators) != 1 or node.generators[0].is_async:
            refuse(node, "has more than one for")
        generator, found = node.generators[0], []
        self._count(node, len(local) // 8)
        inner = dict(local)
        for item in self._items(self.value(generator.iter, local), node):
            self._store(generator.target, item, inner)
            if all(self.value(test, inner) for test in generator.ifs):
                found.append(self.value(node.elt, inner))
        return found

    _generatorexp = _listcomp

    def _binop(self, node: ast.BinOp, local: dict[str, Any]) -> Any:
        return self._binary(node, node.op, self.value(node.left, local), self.value(node.right, local))

    def _binary(self, node: ast.AST, sign: ast.operator, left: Any, right: Any) -> Any:
        if type(sign) not in BINARY or not (is_number(left) and is_number(right)):
            refuse(node, "is no arithmetic of two numbers")
        if isinstance(sign, ast.Pow) and abs(right) > MOST_ITEMS:
            refuse(node, "has an exponent that is too large")
        if isinstance(sign, ast.Pow) and isinstance(left, int):
            left = float(left)
        result = BINARY[type(sign)](left, right)
        return whole(node, result) if isinstance(result, int) else result

    def _unaryop(self, node: ast.UnaryOp, local: dict[str, Any]) -> Any:
        value = self.value(node.operand, local)
        if isinstance(node.op, ast.Not):
            return not value
        if isinstance(node.op, ast.Invert) or not is_number(value):
            refuse(node, "is no sign of a number")
        return -value if isinstance(node.op, ast.USub) else +value

    def _boolop(self, node: ast.BoolOp, local: dict[str, Any]) -> Any:
        value: Any = None
        for part in node.values:
            value = self.value(part, local)
            if bool(value) is isinstance(node.op, ast.Or):
                break
        return value

    def _compare(self, node: ast.Compare, local: dict[str, Any]) -> Any:
        left = self.value(node.left, local)
        for sign, part in zip(node.ops, node.comparators, strict=True):
            right = self.value(part, local)
            if type(sign) not in COMPARED:
                refuse(node, f"a comparison {type(sign).__name__} cannot stand here")
            is_alike = isinstance(sign, ast.Is | ast.IsNot)
            is_same = isinstance(sign, ast.Eq | ast.NotEq) and is_scalar(left) and is_scalar(right)
            if not (is_alike or is_same or (is_number(left) and is_number(right))):
                refuse(node, "compares something that is no number")
            if not COMPARED[type(sign)](left, right):
                return False
            left = right
        return True

    def _ifexp(self, node: ast.IfExp, local: dict[str, Any]) -> Any:
        return self.value(node.body if self.value(node.test, local) else node.orelse, local)

    def _call(self, node: ast.Call, local: dict[str, Any]) -> Any:
        function = self.value(node.func, local)
        if any(isinstance(argument, ast.Starred) for argument in node.args) or any(not k.arg for k in node.keywords):
            refuse(node, "passes on a list of arguments")
        arguments = [self.value(argument, local) for argument in node.args]
        named = {str(keyword.arg): self.value(keyword.value, local) for keyword in node.keywords}
        if isinstance(function, ast.FunctionDef) and not named:
            return self._own(node, function, arguments)
        if not callable(function) or (isinstance(function, type) and function not in MADE):
            refuse(node, "is called and is no function")
        self._weigh(node, *arguments, *named.values())
        if function in PYTHON:
            return self._python(node, function, arguments, named)
        self._count(node, COST_OF_CALL)
        if is_kernel(function):
            return self._kernel(node, function, arguments, named)
        if inspect.isfunction(function):
            given = inspect.signature(function).bind(*arguments, **named).arguments
            for name, value in given.items():
                if function.__annotations__.get(name) in ("float", "int") and not isinstance(value, int | float):
                    refuse(node, f"{name} must be a number")
        result = function(*arguments, **named)
        self._weigh(node, result)
        return whole(node, result) if isinstance(result, int) and not isinstance(result, bool) else result

    def _python(self, node: ast.Call, function: Any, arguments: list[Any], named: dict[str, Any]) -> Any:
        """Call a function of Python itself; it takes numbers, or lists that have been counted."""
        least, most = PYTHON[function]
        is_strict = function is zip and [*named] == ["strict"]
        if not least <= len(arguments) <= most or (named and not is_strict):
            refuse(node, f"{function.__name__} is given {len(arguments) + len(named)} arguments that do not go with it")
        if function in (list, tuple, zip, enumerate):
            lists = [self._items(one, node) for one in (arguments[:1] if function is enumerate else arguments)]
            made = function(*lists, *arguments[len(lists) :], **named)
            return made if isinstance(made, tuple) else self._items(made, node)
        if function in (min, max, sum):
            is_of_list = function is sum or len(arguments) == 1
            numbers = [*self._items(arguments[0], node), *arguments[1:]] if is_of_list else arguments
            if not all(isinstance(one, int | float) for one in numbers):
                refuse(node, f"{function.__name__} takes numbers")
        elif function not in (len, bool) and not all(map(is_scalar, arguments)):
            refuse(node, f"{function.__name__} takes a number")
        elif function in (int, float, round, abs, range) and any(isinstance(one, str) for one in arguments):
            refuse(node, f"{function.__name__} takes no text")
        result = function(*arguments)
        if function is range:
            return self._items(result, node)
        return whole(node, result) if isinstance(result, int) and not isinstance(result, bool) else result

    def _kernel(self, node: ast.Call, function: Any, arguments: list[Any], named: dict[str, Any]) -> Any:
        """Call a kernel of the library as plain Python: here nothing is compiled."""
        taken, _ = signature(function)
        if named or len(arguments) != len(taken):
            refuse(node, f"takes {len(taken)} arguments by their place")
        given = []
        for value, kind in zip(arguments, taken, strict=True):
            fits = isinstance(value, int | float) if isinstance(kind, NumberKind) else isinstance(value, kind)  # type: ignore[arg-type]
            if not fits:
                refuse(node, "is given something of another kind")
            given.append(float(value) if isinstance(kind, NumberKind) else value)
        with np.errstate(all="ignore"):
            return plain(function)(*given)

    def _own(self, node: ast.Call, function: ast.FunctionDef, arguments: Sequence[Any]) -> Any:
        """Call a function of the unit."""
        if len(arguments) != len(function.args.args) or self._deep >= DEEPEST_CALLS:
            refuse(node, f"{function.name} is given {len(arguments)} arguments, or calls too deeply")
        self._deep += 1
        local = {argument.arg: value for argument, value in zip(function.args.args, arguments, strict=True)}
        _, result = self._run(function.body, local)
        self._deep -= 1
        return result

    def _items(self, value: Any, node: ast.AST) -> Sequence[Any]:
        """Return the items of a list, each of them counted."""
        if isinstance(value, zip | enumerate):  # of lists that are counted
            value = list(value)
        if not isinstance(value, list | tuple | range | np.ndarray | Records):
            refuse(node, "goes over something that is no list")
        if len(value) > MOST_ITEMS:
            refuse(node, f"has more than {MOST_ITEMS} items")
        self._count(node, len(value))
        return list(value)

    def _store(self, target: ast.expr, value: Any, local: dict[str, Any]) -> None:
        if isinstance(target, ast.Name):
            local[target.id] = value
        elif isinstance(target, ast.Tuple):
            values = self._items(value, target)
            if len(values) != len(target.elts):
                refuse(target, f"takes {len(target.elts)} values and is given {len(values)}")
            for part, one in zip(target.elts, values, strict=True):
                self._store(part, one, local)
        elif isinstance(target, ast.Attribute):
            owner = self.value(target.value, local)
            field = self._field(target, owner, target.attr) if isinstance(owner, Record) else None
            if field is None:
                names = [one.name for one in owner.layout.fields] if isinstance(owner, Record) else ()
                refuse(target, f"has no {target.attr} that a unit may write{nearest(target.attr, names)}")
            if field.kind not in (SCALAR, RECORD) or isinstance(value, Record) != (field.kind == RECORD):
                refuse(target, "is given something of another kind")
            self._weigh(target, value)
            setattr(owner, target.attr, value if isinstance(value, Record) else as_float(target, value))
        elif isinstance(target, ast.Subscript):
            owner, index = self.value(target.value, local), self.value(target.slice, local)
            if not isinstance(owner, np.ndarray):
                refuse(target, "is no vector")
            self._check_index(target, owner, index)
            owner[index] = as_float(target, value)
        else:
            refuse(target, "cannot be assigned to")

    def _check_index(self, node: ast.AST, owner: Any, index: Any) -> None:
        if not isinstance(owner, list | tuple | np.ndarray | Records) or isinstance(index, bool):
            refuse(node, "is no vector and no list")
        if not isinstance(index, int) or not 0 <= index < len(owner):
            refuse(node, f"has no item {index!r}; there are {len(owner)}, from 0")
