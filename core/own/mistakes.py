"""The errors of a text: all that do not follow from others, in the order of its lines."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from core.errors import did_you_mean
from core.own.text import UnitError

MOST_MISTAKES = 20
MOST_NAMES = 12
"""Names that an error lists."""


class Broken:
    """Stands for a name whose declaration has an error of its own."""


BROKEN = Broken()


class Follows(UnitError):
    """An error that follows from another one of the same text; people do not see it."""


class Mistakes:
    """Collects errors, so that the check reads a text to its end."""

    def __init__(self) -> None:
        self._found: dict[tuple[int, int], UnitError] = {}
        self._follows: UnitError | None = None

    def __bool__(self) -> bool:
        return bool(self._found) or self._follows is not None

    def add(self, error: UnitError) -> None:
        """Keep an error; of several at one place the first counts."""
        if isinstance(error, Follows):
            self._follows = error
        else:
            self._found.setdefault((error.line, error.column), error)

    @contextmanager
    def apart(self) -> Iterator[None]:
        """Keep the error of a part; the next part is checked too."""
        try:
            yield
        except UnitError as error:
            self.add(error)

    def check(self) -> None:
        """Raise the first error with all others.

        Raises
        ------
        UnitError
            With `others`, in the order of the text.
        """
        if self._found:
            first, *others = (error for _, error in sorted(self._found.items())[:MOST_MISTAKES])
            raise UnitError(first.message, first.line, first.column, tuple(others))
        if self._follows is not None:
            raise self._follows


def follows(node: ast.AST) -> Follows:
    """Return the error of a node that needs a broken name."""
    return Follows("follows from another error", getattr(node, "lineno", 1), getattr(node, "col_offset", 0) + 1)


def bound(node: ast.AST) -> set[str]:
    """Return the names that a statement would bind."""
    if isinstance(node, ast.Import | ast.ImportFrom):
        return {alias.asname or alias.name for alias in node.names}
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return {node.name}
    return {one.id for one in ast.walk(node) if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)}


def nearest(name: str, allowed: Iterable[str], elsewhere: Iterable[str] = ()) -> str:
    """Return the way out of a wrong name: the nearest name, else a list of names; nothing without a list.

    Parameters
    ----------
    name : str
        The wrong name.
    allowed : iterable of str
        Names that could be meant.
    elsewhere : iterable of str
        Names of other places, given only where one is near.
    """
    names = [one for one in dict.fromkeys(allowed) if not one.startswith("_")]
    if near := did_you_mean(name, names) or did_you_mean(name, elsewhere):
        return f"; {near}"
    listed = ", ".join(names[:MOST_NAMES]) + (" ..." if len(names) > MOST_NAMES else "")
    return f"; there are {listed}" if names else ""
