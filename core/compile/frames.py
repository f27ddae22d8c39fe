"""Calls while a step is translated: names, the boards that have returned, loops."""

from __future__ import annotations

import ast
import inspect
import linecache
import textwrap
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from functools import cache
from types import CodeType, FunctionType
from typing import Any

from core.compile.numbers import CompiledNumber, Unsupported

AGAIN = "end this process and start it again"
Kinds = dict[str, tuple[int, bool]]
"""Of every variable of every call its kind, and whether each board has its own."""


@cache
def tree_of(function: FunctionType) -> ast.FunctionDef:
    """Return the syntax tree of a function."""
    (tree,) = ast.parse(textwrap.dedent(text_of(function))).body
    if not isinstance(tree, ast.FunctionDef):
        raise Unsupported(f"{function.__name__} is no function with statements")
    return tree


@cache
def text_of(function: FunctionType) -> str:
    """Return the text of a function.

    Raises
    ------
    Unsupported
        When it cannot be read, or has changed since the function was loaded.
    """
    try:
        text = inspect.getsource(function)
    except OSError:
        raise Unsupported(f"{function.__name__} has no text that can be read") from None
    file = function.__code__.co_filename
    if _mark(function.__code__) not in _marks(file, "".join(linecache.getlines(file))):
        raise Unsupported(f"the text of {function.__name__} has changed since it was loaded", file, AGAIN)
    return text


@cache
def _marks(file: str, text: str) -> frozenset[Hashable]:
    """Return the marks of all functions of a text."""
    found, left = [], [compile(text, file, "exec", dont_inherit=True)]
    while left:
        code = left.pop()
        found.append(_mark(code))
        left += [one for one in code.co_consts if isinstance(one, CodeType)]
    return frozenset(found)


def _mark(code: CodeType) -> Hashable:
    """Return the parts of the code of a function that change with its text."""
    constants = tuple(repr(one) for one in code.co_consts if not isinstance(one, CodeType))
    return code.co_name, code.co_firstlineno, code.co_code, code.co_names, code.co_varnames, constants


@cache
def stored(tree: ast.FunctionDef) -> frozenset[str]:
    """Return the names that a function assigns to."""
    return frozenset(
        node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    )


@cache
def returns(tree: ast.AST) -> int:
    """Return how often a tree says return."""
    return sum(isinstance(node, ast.Return) for node in ast.walk(tree))


Masks = tuple[CompiledNumber | None, CompiledNumber | None]


def says(statements: Sequence[ast.AST], kind: type[ast.AST]) -> bool:
    """Say whether statements hold one of a kind."""
    return any(isinstance(node, kind) for statement in statements for node in ast.walk(statement))


@dataclass
class LoopFrame:
    """A loop: its next round and its end, the branches around it, the boards that have left or skip a round."""

    again: Any
    behind: Any
    branches: int
    out: Any = None
    skipped: Any = None
    is_uneven: bool = False


@dataclass
class CallFrame:
    """One call: names with their values, the boards that have returned, the mask within the call."""

    function: FunctionType
    path: str
    names: dict[str, Any]
    exit: Any
    mask: CompiledNumber | None = None
    returned: Any = None
    result: Any = None
    calls: int = 0
    branches: int = 0
    variables: dict[str, Any] = field(default_factory=dict)
    loops: list[LoopFrame] = field(default_factory=list)
