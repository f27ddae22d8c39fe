"""Kernels: functions that steps call, and that Python calls by itself as machine code."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import update_wrapper
from types import FunctionType
from typing import Any, TypeVar, cast
from weakref import WeakSet

from core.compile import code, entry
from core.compile.instructions import whole
from core.record import Record

__all__ = ["SMALL", "Kernel", "flush_tiny", "inlined", "is_kernel", "kernel", "renew", "used", "whole"]

F = TypeVar("F", bound=Callable[..., Any])

SMALL = 1e-100
"""Numbers smaller than this count as nothing."""


def _nothing(*_arguments: Any) -> Any:
    return NotImplemented


class Kernel:
    """A function that is machine code where Python calls it, and part of the step where a step does."""

    def __init__(self, function: FunctionType) -> None:
        update_wrapper(self, function)
        self.py_func = function
        self._last: Callable[..., Any] = _nothing
        self._made: dict[entry.Kinds, Callable[..., Any]] = {}
        _kernels.add(self)

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Call the function; it is compiled when it is called first with such arguments."""
        if named:
            arguments = inspect.signature(self.py_func).bind(*arguments, **named).args
        found = self._last(*arguments)
        if found is not NotImplemented:
            return found
        kinds = tuple(map(entry.kind_of, arguments))
        made = self._made.get(kinds)
        if made is None:
            made = self._made[kinds] = entry.made(self.py_func, kinds)
        if any(isinstance(kind, type) for kind in kinds):
            return made(*(one.address if isinstance(one, Record) else one for one in arguments))
        found = made(*arguments)
        if found is NotImplemented:  # an integer of another class, say
            return made(*map(entry.plain, arguments))
        self._last = made
        return found

    @property
    def kinds(self) -> list[entry.Kinds]:
        """The kinds of arguments that it has been called with."""
        return list(self._made)

    def renew(self) -> None:
        """Load its code for this processor in place of code for a level, now that the shelf may have it."""
        for kinds in self.kinds:
            if entry.piece(self.py_func, kinds).name in code.borrowed:
                self._made[kinds] = entry.made(self.py_func, kinds)
        self._last = _nothing


_kernels: WeakSet[Kernel] = WeakSet()


def kernel(function: F) -> F:
    """Declare a function that steps may call."""
    return cast(F, Kernel(cast(FunctionType, function)))


inlined = kernel
"""The same, by the name that some units know it by."""


def used() -> list[Kernel]:
    """Return the kernels that Python has called in this process, by module and name."""
    return sorted(
        (one for one in _kernels if one.kinds), key=lambda one: (one.py_func.__module__, one.py_func.__name__)
    )


def renew() -> None:
    """Load all code for this processor in place of code for a level; boards take it when they are linked or renewed."""
    code.renew()
    for one in used():
        one.renew()


def is_kernel(function: object) -> bool:
    """Say whether a step may call a function."""
    return isinstance(function, Kernel)


@kernel
def flush_tiny(value: float) -> float:
    """Return ``value``, or zero once it is too small to matter.

    A state that decays for ever becomes a subnormal number, and a processor is ten times slower with such numbers. NaN
    passes through so that the guard can trip.
    """
    return 0.0 if abs(value) < SMALL else value
