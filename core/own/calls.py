"""Calls in a step: of functions of the library, of the processor's instructions, of the unit's own functions."""

from __future__ import annotations

import ast
import math
from collections.abc import Sequence
from typing import Any

from core.kernel import is_kernel
from core.own.expressions import Checked, OwnExpressions, called
from core.own.guarded import floored, signed
from core.own.kinds import NUMBER, TRUTH, Count, NumberKind, RecordKind, signature
from core.own.mistakes import BROKEN, follows, nearest
from core.own.offered import MATHEMATICS, OFFERED
from core.own.text import refuse
from core.own.values import Mathematics
from core.record import Record

COST_OF_CALL = 30
"""Operations that a call of an elementary function counts as."""
STEP_FUNCTIONS = ("abs", "min", "max", "math.sqrt", "math.copysign", "math.isfinite")


class OwnCalls(OwnExpressions):
    """Checks calls."""

    def own_call(self, node: ast.Call, function: ast.FunctionDef, arguments: Sequence[Checked]) -> Checked:
        """Check a call of a function of the unit."""
        raise NotImplementedError

    def counts(self, record: type[Record]) -> bool:
        """Say whether the framework writes the number of hypotheses into this record."""
        raise NotImplementedError

    def call(self, node: ast.Call) -> Checked:
        """Check a call; arguments go by their place."""
        name, function = self._function(node)
        if node.keywords or any(isinstance(argument, ast.Starred) for argument in node.args):
            refuse(node, "a step passes arguments by their place; leave out the names and stars")
        if isinstance(function, ast.FunctionDef):
            return self.own_call(node, function, [self.value(argument) for argument in node.args])
        if function is int:
            return self._count_of(node)
        if function in (abs, float, min, max, math.sqrt, math.copysign, math.isfinite, math.floor):
            return self._instruction(node, name, function)
        try:
            taken, result = signature(function)
        except TypeError:
            refuse(node, f"{name} is no function of steps; it belongs into pack")
        if not is_kernel(function):
            refuse(node, f"{name} is for pack, and no function of steps; pack its result into a field of p")
        if len(taken) != len(node.args):
            refuse(node, f"{name} takes {len(taken)} arguments and is given {len(node.args)}")
        self.count(node, COST_OF_CALL)
        self.used[name] = function
        return result, called(name, *(self._taken(part, kind) for part, kind in zip(node.args, taken, strict=True)))

    def _function(self, node: ast.Call) -> tuple[str, Any]:
        """Return the function a call names."""
        if isinstance(node.func, ast.Attribute) and isinstance(node.func.value, ast.Name):
            owner = self.names.get(node.func.value.id)
            if isinstance(owner, Mathematics) and node.func.attr in ("sqrt", "copysign", "isfinite"):
                return f"_{node.func.attr}", getattr(math, node.func.attr)
        if isinstance(node.func, ast.Name) and node.func.id not in self.kinds and node.func.id in self.names:
            function = self.names[node.func.id]
            if function is BROKEN:
                raise follows(node)
            if callable(function) or isinstance(function, ast.FunctionDef):
                return node.func.id, function
        return refuse(node, f"is no function of steps{self._other_function(node.func)}")

    def _other_function(self, node: ast.expr) -> str:
        """Return the way out of a function that is not known: the import that it needs, or the nearest name."""
        name = node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""
        if name in MATHEMATICS:
            return f"; write import math, and math.{name}"
        if home := next((home for home, names in OFFERED.items() if name in names), ""):
            return f"; write from {home} import {name}, and {name}(...)"
        known = [one for one, value in self.names.items() if is_kernel(value) or isinstance(value, ast.FunctionDef)]
        return nearest(name, (*known, *STEP_FUNCTIONS))

    def _instruction(self, node: ast.Call, name: str, function: Any) -> Checked:
        least, most = {min: (2, 8), max: (2, 8), math.copysign: (2, 2)}.get(function, (1, 1))
        if not least <= len(node.args) <= most:
            refuse(node, f"is given {len(node.args)} numbers, and takes {least}" + (f" to {most}" * (most > least)))
        parts = [self.number(part) for part in node.args]
        if function is float:
            return NUMBER, parts[0]
        if function is math.floor:
            name, function = "_floor", floored
        if function is math.copysign:
            function = signed
        self.used[name] = function
        return TRUTH if function is math.isfinite else NUMBER, called(name, *parts)

    def _count_of(self, node: ast.Call) -> Checked:
        """Check ``int(p.count)``, the number of hypotheses of the bank."""
        (argument,) = node.args if len(node.args) == 1 else (node,)
        if isinstance(argument, ast.Attribute) and argument.attr == "count":
            kind, made = self.value(argument.value)
            if isinstance(kind, RecordKind) and self.counts(kind.record):
                return Count(), called("int", ast.Attribute(made, "count", ast.Load()))
        return refuse(node, "int(...) is allowed in an index only, or as int(p.count) of a bank")

    def _taken(self, node: ast.expr, taken: Any) -> ast.expr:
        """Check an argument of a kernel of the library."""
        if isinstance(taken, NumberKind):
            return self.number(node)
        kind, made = self.value(node)
        if not isinstance(kind, RecordKind) or not issubclass(kind.record, taken):
            refuse(node, f"must be a record {taken.__name__}; declare a field of that kind and give it")
        return made
