"""Compiles helpers: what steps call, and what Python calls by itself."""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any, TypeVar, cast

import numba
from numba.core.dispatcher import Dispatcher

from core import views  # noqa: F401  (numba learns what records are)
from core.kernel_cache import KernelCache

F = TypeVar("F", bound=Callable[..., Any])

SMALL = 1e-100
"""Numbers smaller than this count as nothing."""

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}


def kernel(function: F) -> F:
    """Compile a helper that steps call: strict arithmetic, no GIL, kept."""
    return _kept(function, numba.njit(**_OPTIONS)(function))


def inlined(function: F) -> F:
    """Compile a helper into whatever calls it: for the few whose call would cost as much as their work."""
    return _kept(function, numba.njit(inline="always", **_OPTIONS)(function))


def _kept(function: F, compiled: Any) -> F:
    if isinstance(compiled, Dispatcher):  # numba gives the function back when it is told not to compile
        vars(compiled)["_cache"] = KernelCache(cast(FunctionType, function))
    return cast(F, compiled)


def is_kernel(function: object) -> bool:
    """Say whether a step may call a function."""
    return isinstance(function, Dispatcher) or bool(getattr(numba.config, "DISABLE_JIT", False))


@inlined
def whole(n: int) -> int:
    """Return how many numbers whole vector registers hold, at least ``n``.

    A loop that fills vectors longer than what is in use may go so far: it has no rest then that goes number by number.
    Nobody reads what it writes behind the n-th. Boards abreast fill registers with boards and go to ``n`` alone.
    """
    return (n + 7) >> 3 << 3


@kernel
def flush_tiny(value: float) -> float:
    """Return ``value``, or zero once it is too small to matter.

    States that decay for ever end as subnormal numbers, on which a processor is ten times slower. NaN passes through
    so that the guard can trip.
    """
    return 0.0 if abs(value) < SMALL else value
