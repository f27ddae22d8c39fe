"""Statements of a step: checked, and written anew.

The language is total. Loops count to constants, functions call only those above them, and a bound of all operations is
known before anything runs.
"""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Sequence
from typing import Any

from core.own.expressions import PUT, Checked, called, is_int_of_data, named
from core.own.guarded import put
from core.own.kinds import (
    NOTHING,
    NUMBER,
    Count,
    Kind,
    NumberKind,
    Numbers,
    RecordKind,
    RecordsKind,
    Several,
    Truth,
    Whole,
    is_alike,
)
from core.own.loops import OwnLoops
from core.own.mistakes import BROKEN, Broken, Mistakes, bound, follows
from core.own.text import UnitError, refuse
from core.own.values import as_read
from core.record import Record

MOST_OPERATIONS = 50_000
"""Operations of a sample, all branches counted: some tens of microseconds."""
MOST_FUNCTIONS = 60


class OwnSteps(OwnLoops):
    """Checks functions: the step, and those it calls.

    Parameters
    ----------
    names : dict
        Meanings of names outside functions.
    counted : type of Record, optional
        The record into which the framework writes the number of hypotheses.
    mistakes : Mistakes
        Takes the errors of statements; the statements behind an error are checked too.
    """

    def __init__(self, names: dict[str, Any], counted: type[Record] | None, mistakes: Mistakes) -> None:
        super().__init__(names, {})
        self.counted, self._mistakes = counted, mistakes
        self.written: list[ast.FunctionDef] = []
        self.last_cost = 0
        self._returned: Kind | None = None
        self._known: dict[tuple[str, tuple[Kind, ...]], tuple[str, Kind, int]] = {}
        self._open: list[str] = []
        self._is_too_long = False

    @property
    def called(self) -> set[str]:
        """Functions of the unit that a step calls."""
        return {name for name, _ in self._known}

    def count(self, node: ast.AST, operations: int = 1) -> None:
        """Count operations, as often as the loops around them go."""
        self.cost += operations * self.factor
        if self.cost > MOST_OPERATIONS:
            if self._is_too_long:
                raise follows(node)
            self._is_too_long = True
            refuse(node, f"takes more than {MOST_OPERATIONS} operations a sample; shorten the loops around it")

    def function(self, node: ast.FunctionDef, kinds: Sequence[Kind], name: str) -> Kind:
        """Check a function with arguments of these kinds, write it anew under a name, return its kind."""
        arguments = node.args
        if arguments.vararg or arguments.kwarg or arguments.kwonlyargs or arguments.posonlyargs or arguments.defaults:
            refuse(node, "takes arguments by their place, without defaults")
        if len(arguments.args) != len(kinds):
            refuse(node, f"takes {len(arguments.args)} arguments and is given {len(kinds)}")
        outer = self.kinds, self.cost, self.factor, self.times, self._returned
        try:
            return self._function_of(node, kinds, name)
        finally:
            self.kinds, cost, self.factor, self.times, self._returned = outer
            self.last_cost, self.cost = self.cost - cost, cost

    def _function_of(self, node: ast.FunctionDef, kinds: Sequence[Kind], name: str) -> Kind:
        """Check a function with a state of its own."""
        taken = [argument.arg for argument in node.args.args]
        for argument in node.args.args:
            self.check_name(argument, argument.arg)
        self.kinds, self.factor = dict(zip(taken, kinds, strict=True)), 1
        self.times, self._returned = _assigned(node), None
        simple = NumberKind | Truth | Broken
        if any(self.times[name] and not isinstance(self.kinds[name], simple) for name in taken):
            refuse(node, "assigns to an argument that is no number; assign to a name of its own")
        body, ends = self.body(node.body)
        result = self._returned or NOTHING
        if not is_alike(result, NOTHING) and not ends:
            refuse(node, "returns a value on some ways through it, and on others nothing; end it with a return")
        made = ast.FunctionDef(name, _arguments(taken), body or [ast.Pass()], [])
        self.written.append(made)
        return result

    def own_call(self, node: ast.Call, function: ast.FunctionDef, arguments: Sequence[Checked]) -> Checked:
        """Check a call of a function of the unit, once for each kind of arguments."""
        kinds, parts = [], []
        for argument, (kind, made) in zip(node.args, arguments, strict=True):
            is_number = isinstance(kind, Whole | Count)
            kinds.append(NUMBER if is_number else kind)
            parts.append(self.as_number(argument, (kind, made)) if is_number else made)
        key = function.name, tuple(kinds)
        if function.name in self._open:
            refuse(node, f"{function.name} calls itself; write a loop over range(...)")
        if key not in self._known:
            if len(self._known) >= MOST_FUNCTIONS:
                refuse(node, f"there are more than {MOST_FUNCTIONS} functions")
            name = f"_{function.name}_{len(self._known)}"  # no name of a unit's own begins so
            self._open.append(function.name)
            self._known[key] = name, BROKEN, 0  # unless its check comes to its end
            try:
                result = self.function(function, kinds, name)
            finally:
                self._open.pop()
            self._known[key] = name, result, self.last_cost
        name, result, cost = self._known[key]
        self.count(node, cost)
        if isinstance(result, Broken):
            raise follows(node)
        return result, called(name, *parts)

    def body(self, statements: Sequence[ast.stmt]) -> tuple[list[ast.stmt], bool]:
        """Check statements; return them written anew, and whether all ways through them return."""
        made: list[ast.stmt] = []
        for position, node in enumerate(statements):
            try:
                self.count(node)
                ends = not _is_text(node) and self._statement(node, made)
                if ends and position + 1 < len(statements):
                    refuse(statements[position + 1], "is never reached; leave it out")
            except UnitError as error:
                self._mistakes.add(error)
                ends = self._spoil(node)
            if ends:
                return made, True
        return made, False

    def _spoil(self, node: ast.stmt) -> bool:
        """Mark the names that a statement with an error binds as broken; say whether it returns."""
        for name in bound(node):
            self.kinds.setdefault(name, BROKEN)
        if any(isinstance(part, ast.Return) for part in ast.walk(node)):
            self._returned = BROKEN
        return isinstance(node, ast.Return)

    def _statement(self, node: ast.stmt, made: list[ast.stmt]) -> bool:
        if isinstance(node, ast.Assign):
            if len(node.targets) != 1:
                refuse(node, "assigns to one name at a time; write two statements")
            self._assign(node.targets[0], node.value, made)
        elif isinstance(node, ast.AnnAssign) and node.value is not None:
            self._assign(node.target, node.value, made)
        elif isinstance(node, ast.AugAssign):
            self._change(node, made)
        elif isinstance(node, ast.If):
            return self._if(node, made)
        elif isinstance(node, ast.For):
            self.loop(node, made)
        elif isinstance(node, ast.Return):
            self._return(node, made)
            return True
        elif isinstance(node, ast.Expr):
            kind, value = self.value(node.value)
            if kind != NOTHING:
                refuse(node, "computes a value that nobody keeps; assign it, or leave it out")
            made.append(ast.Expr(value))
        elif not isinstance(node, ast.Pass):
            text = f"a step has no statement {type(node).__name__}: it has assignments, if, for and return"
            refuse(node, text + ("; write for i in range(n) with an if inside" if isinstance(node, ast.While) else ""))
        return False

    def _assign(self, target: ast.expr, value: ast.expr, made: list[ast.stmt]) -> None:
        if isinstance(target, ast.Tuple):
            self._assign_several(target, value, made)
        elif isinstance(target, ast.Name):
            made.append(self._bind(target, *self.value(value)))
        else:
            self._write(target, self.number(value), made)

    def _change(self, node: ast.AugAssign, made: list[ast.stmt]) -> None:
        """Check ``+=`` and its like; an index from data is worked out once, before the value."""
        target = node.target
        if isinstance(target, ast.Subscript) and is_int_of_data(target.slice):
            name = self._between(made)
            index = self.number(target.slice.args[0])  # type: ignore[attr-defined]
            made.append(ast.Assign([ast.Name(name, ast.Store())], index))
            self.kinds[name] = NUMBER
            kept = ast.copy_location(called("int", named(name)), target)
            target = ast.copy_location(ast.Subscript(target.value, kept, ast.Store()), target)
            ast.fix_missing_locations(target)
        operation = ast.BinOp(as_read(target), node.op, node.value)
        self._assign(target, ast.copy_location(operation, node), made)

    def _between(self, made: list[ast.stmt]) -> str:
        """Return a name for a number that is needed by the statements that come next."""
        return f"_{len(made)}"

    def _assign_several(self, target: ast.Tuple, value: ast.expr, made: list[ast.stmt]) -> None:
        """Assign several numbers: all are known before the first is written."""
        if isinstance(value, ast.Tuple):
            parts: list[ast.expr] = [self.number(part) for part in value.elts]
            known: ast.expr = ast.Tuple(parts, ast.Load())
            count = len(parts)
        else:
            kind, known = self.value(value)
            count = kind.count if isinstance(kind, Several) else 1
        if count != len(target.elts):
            refuse(target, f"takes {len(target.elts)} values and is given {count}")
        between = [f"_{len(made)}_{i}" for i in range(count)]
        made.append(ast.Assign([ast.Tuple([ast.Name(name, ast.Store()) for name in between], ast.Store())], known))
        for part, name in zip(target.elts, between, strict=True):
            if isinstance(part, ast.Name):
                made.append(self._bind(part, NUMBER, named(name)))
            else:
                self._write(part, named(name), made)

    def _bind(self, target: ast.Name, kind: Kind, value: ast.expr) -> ast.stmt:
        """Give a name a value; all but numbers and conditions get one name for good."""
        self.check_name(target, target.id)
        is_once = self.times[target.id] == 1
        if isinstance(kind, Whole | Count) and not is_once:
            value, kind = self.as_number(target, (kind, value)), NUMBER
        before = self.kinds.get(target.id)
        if not is_once and not isinstance(kind, NumberKind | Truth):
            refuse(target, f"{target.id} is assigned more than once, and is no number; use two names")
        if before is not None and not is_alike(before, kind):
            refuse(target, f"{target.id} is something else above; use another name")
        if isinstance(kind, Several) or kind == NOTHING:
            refuse(target, "is no single value; assign several numbers to as many names")
        self.kinds[target.id] = kind
        return ast.Assign([ast.Name(target.id, ast.Store())], value)

    def _write(self, target: ast.expr, value: ast.expr, made: list[ast.stmt]) -> None:
        """Write a number to a field, a port or an item of a vector."""
        if isinstance(target, ast.Attribute):
            kind, is_written, owner = self.member(target)
            place: ast.expr = ast.Attribute(owner, target.attr, ast.Store())
        elif isinstance(target, ast.Subscript):
            kind, vector, owner, index, is_known = self.item(target)
            is_written = vector.is_written
            place = ast.Subscript(owner, index, ast.Store())
        else:
            refuse(target, "cannot be assigned to")
        if not is_written:
            ways = "; it writes fields of s, and outputs and taps of x" + (
                ", of a vector an item, such as [0]" if isinstance(kind, Numbers) else ""
            )
            refuse(target, f"a step may not write {ast.unparse(target)}{ways}")
        if not isinstance(kind, NumberKind):
            refuse(target, "is no single number; write an item or a field of it")
        if isinstance(target, ast.Attribute) or is_known:
            made.append(ast.Assign([place], value))
            return
        if not isinstance(value, ast.Name | ast.Constant):  # Python works out the value before the index
            name = self._between(made)
            made.append(ast.Assign([ast.Name(name, ast.Store())], value))
            value = named(name)
        self.used[PUT] = put
        made.append(ast.Expr(called(PUT, owner, ast.Constant(float(vector.count)), index, value)))

    def _if(self, node: ast.If, made: list[ast.stmt]) -> bool:
        test = self.truth(node.test)
        before = dict(self.kinds)
        yes, yes_ends = self.body(node.body)
        after_yes, self.kinds = self.kinds, dict(before)
        no, no_ends = self.body(node.orelse)
        after_no = self.kinds
        made.append(ast.If(test, yes or [ast.Pass()], no))
        if yes_ends or no_ends:
            self.kinds = after_no if yes_ends else after_yes
        else:
            for name in after_yes.keys() & after_no.keys():
                if not is_alike(after_yes[name], after_no[name]):
                    refuse(node, f"{name} is one thing or another behind it; use two names")
            self.kinds = {name: kind for name, kind in after_yes.items() if name in after_no}
        return yes_ends and no_ends and bool(node.orelse)

    def _return(self, node: ast.Return, made: list[ast.stmt]) -> None:
        kind: Kind = NOTHING
        value: ast.expr | None = None
        if isinstance(node.value, ast.Tuple):
            kind = Several(len(node.value.elts))
            value = ast.Tuple([self.number(part) for part in node.value.elts], ast.Load())
        elif node.value is not None:
            kind, value = self.value(node.value)
            if isinstance(kind, Whole | Count):
                kind, value = NUMBER, self.as_number(node.value, (kind, value))
        if isinstance(kind, Numbers | RecordKind | RecordsKind) or (
            self._returned is not None and not is_alike(self._returned, kind)
        ):
            refuse(node, "returns numbers, the same on all ways; return the fields one by one")
        self._returned = self._returned if isinstance(self._returned, Broken) else kind
        made.append(ast.Return(value))


def _assigned(node: ast.FunctionDef) -> Counter[str]:
    """Return how often each name is assigned to, the counters of loops left out."""
    found: Counter[str] = Counter()
    counters = {id(part.target) for part in ast.walk(node) if isinstance(part, ast.For)}
    for part in ast.walk(node):
        if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store) and id(part) not in counters:
            found[part.id] += 1
    return found


def _is_text(node: ast.stmt) -> bool:
    """Say whether a statement is a docstring."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _arguments(names: Sequence[str]) -> ast.arguments:
    return ast.arguments([], [ast.arg(name) for name in names], None, [], [], None, [])
