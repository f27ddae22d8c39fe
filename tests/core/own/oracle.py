"""The text of a unit as Python itself runs it, on plain records: the oracle of the rewritten code.

Nothing of what `core.own` makes of the step is used. Python works out values, indices and calls in its own order; only
numbers are doubles that divide by 0 as a processor does, and a vector has NaN where it has no item.
"""

from __future__ import annotations

import ast
import math
from typing import Any

import numpy as np

from core.block import Block
from core.own.declare import Declaration
from core.own.mistakes import Mistakes
from core.own.text import read
from core.own.values import Mathematics
from core.plain import plain


class Doubles(ast.NodeTransformer):
    """Makes numbers doubles of numpy's, and vectors total."""

    def visit_Constant(self, node: ast.Constant) -> ast.expr:
        is_number = isinstance(node.value, int | float) and not isinstance(node.value, bool)
        return _called("_double", node) if is_number else node

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        return _called("_double", node)

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        self.generic_visit(node)
        node.value = _called("_Total", node.value)
        return node


class Total:
    """A vector, or records: NaN where there is no item, and nothing is written there."""

    def __init__(self, inner: Any) -> None:
        self._inner = inner

    def __getitem__(self, index: float) -> Any:
        return self._inner[int(index)] if -1.0 < index < len(self._inner) else np.float64(np.nan)

    def __setitem__(self, index: float, value: float) -> None:
        if -1.0 < index < len(self._inner):
            self._inner[int(index)] = value


class Signals:
    """The ports of a unit, each vector as long as it was declared."""

    def __init__(self, ports: Any) -> None:
        counts = {port.name: len(port.labels) for port in ports.declared if port.vector}
        vars(self).update(_ports=ports, _counts=counts)

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._ports, name)
        return value[: self._counts[name]] if name in self._counts else value

    def __setattr__(self, name: str, value: float) -> None:
        setattr(self._ports, name, value)


def _called(name: str, node: ast.expr) -> ast.expr:
    return ast.Call(ast.Name(name, ast.Load()), [node], [])


def _double(value: Any) -> Any:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return np.float64(value) if is_number else value


def _range(*ends: float) -> list[np.float64]:
    return [np.float64(i) for i in range(*(int(end) for end in ends))]


def oracle(block: type[Block]) -> Any:
    """Return the step of a unit as its text says it."""
    declared = Declaration(read(block.text), "oracle", Mistakes())
    space: dict[str, Any] = {}
    for name, value in declared.names.items():
        if isinstance(value, Mathematics):
            space[name] = np
        elif value is math.floor:
            space[name] = np.floor
        elif not isinstance(value, ast.FunctionDef):
            space[name] = plain(value) if callable(value) and not isinstance(value, type) else _double(value)
    space |= {"_double": _double, "_Total": Total, "range": _range, "int": _double, "float": _double}
    own = [value for value in declared.names.values() if isinstance(value, ast.FunctionDef)]
    functions = [*own, declared.methods["step"]]
    for function in functions:
        function.decorator_list, function.returns = [], None
        for argument in function.args.args:
            argument.annotation = None
    tree = Doubles().visit(ast.Module(functions, []))
    exec(compile(ast.fix_missing_locations(tree), "oracle", "exec"), space)
    return lambda p, s, x: space["step"](p, s, Signals(x))
