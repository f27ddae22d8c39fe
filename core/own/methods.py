"""Methods that pack and begin, before they run: their statements, their expressions, their names."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Mapping
from typing import Any, cast

from core.block import Context, Oscillator
from core.own.evaluate import Evaluator
from core.own.mistakes import Mistakes, bound, nearest
from core.own.offered import MATHEMATICS
from core.own.text import refuse
from core.own.values import Mathematics, public

OSCILLATOR = sorted(public(cast(Any, Oscillator)))
FACTS = {
    "context": sorted(public(cast(Any, Context))),
    **dict.fromkeys(("context.device", "context.model", "device", "model"), OSCILLATOR),
}
"""Names that a unit may read of the facts of the bench, by the way to them."""


def check_method(
    node: ast.FunctionDef, names: Mapping[str, Any], mistakes: Mistakes, facts: Mapping[str, Collection[str]]
) -> None:
    """Collect the statements, expressions and names of a method that it cannot have.

    Parameters
    ----------
    node : ast.FunctionDef
        The method, or a function that it calls.
    names : mapping
        Meanings of names outside functions.
    mistakes : Mistakes
        Takes one error of each statement.
    facts : mapping of str to collection of str
        Names that may be read of the arguments, by the way to them.
    """
    assigned = {name for part in node.body for name in bound(part)}
    own = [*(argument.arg for argument in node.args.args), *sorted(assigned)]
    known = dict.fromkeys([*own, *names, "super"])
    known_facts = {way: read for way, read in facts.items() if way.partition(".")[0] not in assigned}
    known_facts |= {
        name: MATHEMATICS for name, one in names.items() if isinstance(one, Mathematics) and name not in own
    }
    for statement in _statements(node.body):
        with mistakes.apart():
            Evaluator.check_statement(statement)
            for part in _expressions(statement):
                Evaluator.check_expression(part)
                if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Load) and part.id not in known:
                    refuse(part, f"{part.id} is not declared{nearest(part.id, known)}")
                if isinstance(part, ast.Attribute):
                    _check_attribute(part, known_facts)


def _check_attribute(node: ast.Attribute, facts: Mapping[str, Collection[str]]) -> None:
    """Refuse a name that a fact of the bench does not have."""
    parts, owner = list[str](), node.value
    while isinstance(owner, ast.Attribute):
        parts, owner = [owner.attr, *parts], owner.value
    if isinstance(owner, ast.Name):
        way = ".".join([owner.id, *parts])
        if way in facts and node.attr not in facts[way]:
            refuse(node, f"{way} has no {node.attr} that a unit may read{nearest(node.attr, facts[way])}")


def _statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield statements with those inside them."""
    for node in body:
        yield node
        for part in ("body", "orelse"):
            yield from _statements(getattr(node, part, []))


def _expressions(statement: ast.stmt) -> Iterator[ast.expr]:
    """Yield the expressions that a statement computes itself, and none of the statements inside it."""
    parts = [*ast.iter_child_nodes(statement)]
    if isinstance(statement, ast.AnnAssign):
        parts.remove(statement.annotation)
    for part in parts:
        if isinstance(part, ast.expr):
            yield from (one for one in ast.walk(part) if isinstance(one, ast.expr))
