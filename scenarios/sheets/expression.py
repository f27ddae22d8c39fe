"""Formulas of a sheet, in its texts too: numbers, names of facts, arithmetic and a few functions; nothing else."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Mapping
from typing import Any

from simpleeval import SimpleEval

from core.errors import InputError, unknown
from core.format import format_short
from scenarios.sheets.sheet import INSERTED

FUNCTIONS: dict[str, Callable[..., float]] = {
    "sqrt": math.sqrt,
    "exp": math.exp,
    "log": math.log,
    "sin": math.sin,
    "cos": math.cos,
    "atan2": math.atan2,
    "hypot": math.hypot,
    "abs": abs,
    "min": min,
    "max": max,
    "degrees": math.degrees,
}
CONSTANTS = {"pi": math.pi}
LONGEST = 300
"""Characters of a formula."""
OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.USub, ast.UAdd)
PARTS = (ast.Expression, ast.BinOp, ast.UnaryOp, ast.Call, ast.Name, ast.Load, ast.Constant, *OPERATORS)
"""The parts that a formula may have."""


def evaluate(formula: float | str, facts: Mapping[str, float], field: str = "") -> float:
    """Return the value of a formula over named facts.

    Raises
    ------
    InputError
        When it is no formula, names a fact that does not exist, or has no finite value.
    """
    if isinstance(formula, int | float):
        return float(formula)
    if len(formula) > LONGEST:
        raise InputError(f"a formula has at most {LONGEST} characters", field)
    names = {**CONSTANTS, **facts}
    evaluator = SimpleEval(functions=FUNCTIONS, names=names)
    try:
        for node in ast.walk(ast.parse(formula.strip(), mode="eval")):
            if not isinstance(node, PARTS):
                raise InputError(f"{formula!r} is more than arithmetic", field)
            if isinstance(node, ast.Name) and node.id not in names and node.id not in FUNCTIONS:
                raise unknown("fact", node.id, sorted(names), field)
        value: Any = evaluator.eval(formula)
        number = float(value)
    except InputError:
        raise
    except Exception as error:  # whatever the formula does: the sheet is to blame
        raise InputError(f"{formula!r} cannot be computed: {error or type(error).__name__}", field) from None
    if isinstance(value, bool) or not math.isfinite(number):
        raise InputError(f"{formula!r} is no finite number", field)
    return number


def inserted(text: str, facts: Mapping[str, float], field: str = "text", missing: str | None = None) -> str:
    """Return a text with its numbers put in.

    Parameters
    ----------
    text : str
        The text.
    facts : mapping
        Facts in its formulas.
    field : str
        Its place, for errors.
    missing : str, optional
        Replaces a number without a value, such as the result of a step left out; without it such a number is an error.
    """

    def number(found: re.Match[str]) -> str:
        try:
            return format_short(evaluate(found[1], facts, field), found[2] or "", 4)
        except InputError:
            if missing is None:
                raise
            return missing

    return INSERTED.sub(number, text)
