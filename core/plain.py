"""Steps and helpers as plain Python: the oracle of the compiled code from the same text."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import CellType, FunctionType, ModuleType
from typing import Any

Swap = Callable[[Any], Any]


class _Module:
    """A module of kernels, all of them plain."""

    def __init__(self, module: ModuleType, swap: Swap, builtins: dict[str, Any] | None) -> None:
        self._module, self._swap, self._builtins = module, swap, builtins

    def __getattr__(self, name: str) -> Any:
        return rebound(getattr(self._module, name), self._swap, self._builtins)


def rebound(value: Any, swap: Swap, builtins: dict[str, Any] | None = None) -> Any:
    """Return a function that calls plain functions only.

    Parameters
    ----------
    value
        A function, compiled or not, or anything a function may name.
    swap : callable
        Gets every named value, and returns its replacement, or the value itself.
    builtins : dict, optional
        Names that hide the names of Python itself.
    """
    value = getattr(value, "py_func", value)
    other = swap(value)
    if other is not value:
        return other
    if isinstance(value, ModuleType) and value.__name__.startswith("core."):
        return _Module(value, swap, builtins)
    if not isinstance(value, FunctionType) or value.__module__.startswith("numpy"):
        return value
    names = {name: value.__globals__[name] for name in value.__code__.co_names if name in value.__globals__}
    plain_names = {name: named if named is value else rebound(named, swap, builtins) for name, named in names.items()}
    cells = tuple(CellType(rebound(cell.cell_contents, swap, builtins)) for cell in value.__closure__ or ())
    scope = {**value.__globals__, **plain_names, **(builtins or {})}
    return FunctionType(value.__code__, scope, value.__name__, value.__defaults__, cells)


@cache
def plain(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function, compiled or not, as plain Python all the way down."""
    made: Callable[..., Any] = rebound(function, lambda value: value)
    return made
