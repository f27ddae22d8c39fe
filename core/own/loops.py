"""Loops of a step: they count to constants, or through the hypotheses of a bank."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from core.diagnose.lanes import LANE as MOST_HYPOTHESES
from core.own.calls import OwnCalls
from core.own.expressions import called
from core.own.kinds import Count, Whole, is_alike
from core.own.text import refuse
from core.record import Record

MOST_ROUNDS = 4096


class OwnLoops(OwnCalls):
    """Checks loops.

    Attributes
    ----------
    counted : type of Record, optional
        The record into which the framework writes the number of hypotheses.
    """

    counted: type[Record] | None

    def body(self, statements: Sequence[ast.stmt]) -> tuple[list[ast.stmt], bool]:
        """Check statements; return them written anew, and whether all ways through them return."""
        raise NotImplementedError

    def check_name(self, node: ast.AST, name: str) -> None:
        """Refuse a name that no value can have."""
        if name.startswith("_") or name in self.names:
            why = f"{name} is a name of something else" if name in self.names else "begins with _"
            refuse(node, f"{why}; choose another name")

    def counts(self, record: type[Record]) -> bool:
        """Say whether the framework writes the number of hypotheses into this record."""
        return self.counted is not None and issubclass(record, self.counted)

    def loop(self, node: ast.For, made: list[ast.stmt]) -> None:
        """Check a loop and write it anew."""
        if node.orelse or not isinstance(node.target, ast.Name):
            refuse(node, "a loop has one counter and no else; write the statements after it")
        name = node.target.id
        self.check_name(node.target, name)
        if name in self.kinds or self.times[name]:
            refuse(node.target, f"{name} is the counter of a loop and something else; give the loop another counter")
        counter, rounds, over = self._range(node.iter)
        before, factor = dict(self.kinds), self.factor
        self.kinds[name] = counter
        self.factor = factor * max(1, rounds)
        body, _ = self.body(node.body)
        self.factor, inside, self.kinds = factor, self.kinds, before
        for known, kind in inside.items():
            if known in before and not is_alike(before[known], kind):
                refuse(node, f"{known} is one thing or another in it; use two names")
        made.append(ast.For(ast.Name(name, ast.Store()), over, body or [ast.Pass()], []))

    def _range(self, node: ast.expr) -> tuple[Whole, int, ast.expr]:
        """Return the counter of a loop, the number of its turns, and its range written anew."""
        is_range = (
            isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and self.names.get(node.func.id) is range
        )
        if not is_range or node.keywords or not 1 <= len(node.args) <= 3:  # type: ignore[attr-defined]
            refuse(node, "a loop goes over range(...); write for i in range(n), and read an item by [i]")
        ends: list[ast.expr] = node.args  # type: ignore[attr-defined]
        checked = [self.value(end) for end in ends]
        made = called("range", *(part for _, part in checked))
        constants = [0] if len(ends) == 1 else []
        is_counted = False
        for argument, (kind, _) in zip(ends, checked, strict=True):
            if isinstance(kind, Count) and len(constants) == 1:
                is_counted = True
                constants.append(MOST_HYPOTHESES)
            elif isinstance(kind, Whole) and kind.low == kind.high:
                constants.append(kind.low)
            else:
                refuse(
                    argument, "a loop counts to a constant" + ("" if self.counted is None else ", or to int(p.count)")
                )
        if len(constants) == 3 and constants[2] == 0:
            refuse(node, "counts by 0; the third number of range is the distance of two counts")
        rounds = range(*constants)
        if len(rounds) > MOST_ROUNDS:
            refuse(node, f"counts more than {MOST_ROUNDS}; shorten the loop, or go on at the next sample")
        low, high = (min(rounds[0], rounds[-1]), max(rounds[0], rounds[-1])) if rounds else (0, 0)
        if is_counted and (low < 0 or (len(constants) == 3 and constants[2] < 0)):
            refuse(node, "counts hypotheses upwards, from 0 or more")
        return Whole(low, high, is_counted), len(rounds), made
