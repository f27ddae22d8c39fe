"""Compiles steps and the helpers they call.

A step is written ``step(p, s, x)`` over named records; the loop of the board calls a C function of four pointers. That
function is made here, so no unit has to know of it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any, TypeVar, cast

import numba
from numba import types
from numba.core.ccallback import CFunc
from numba.core.compiler import Compiler
from numba.core.dispatcher import Dispatcher

from core.kernel_cache import KernelCache
from core.ports import BlockPorts
from core.record import Layout, Record
from core.views import DOUBLES, INTEGERS, ports_at, record_at

F = TypeVar("F", bound=Callable[..., Any])
Step = Callable[[Any, Any, Any], None]

SMALL = 1e-100
"""Numbers smaller than this count as nothing."""

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
_SIGNATURE: Any = ((DOUBLES, DOUBLES, DOUBLES, INTEGERS), types.void)


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


class _Apart(Compiler):
    """Compiles a step knowing that its parameters, state, signals and ports lie apart, so that it may use vectors."""

    def __init__(self, typing: Any, target: Any, library: Any, args: Any, result: Any, flags: Any, local: Any) -> None:
        flags.noalias = True
        super().__init__(typing, target, library, args, result, flags, local)


def compiled_step(step: Step, packed: type[Record], state: type[Record], ports: type[BlockPorts]) -> Any:
    """Return the C function of a step: pointers to its two records, to all signals, and to the places of its ports."""
    return _compiled(step, packed.layout, state.layout, _seen(ports))


@cache
def _compiled(step: Step, packed: Layout, state: Layout, ports: tuple[tuple[str, bool | Layout], ...]) -> Any:
    function = _entry(step, packed, state, ports)
    function._cache = KernelCache(cast(FunctionType, step), f"{packed}{state}{ports}")
    function.compile()
    return function


def step_instructions(
    step: Step, packed: type[Record], state: type[Record], ports: type[BlockPorts]
) -> tuple[str, str]:
    """Return the instructions that the C function of a step is compiled from, and its name among them."""
    function = _entry(step, packed.layout, state.layout, _seen(ports))
    function.compile()
    return str(function.inspect_llvm()), str(function.native_name)


def _seen(ports: type[BlockPorts]) -> tuple[tuple[str, bool | Layout], ...]:
    """Return of every port its name, and whether it is a vector or of which records."""
    return tuple((port.name, port.record.layout if port.record else port.vector) for port in ports.declared)


def _entry(step: Step, packed: Layout, state: Layout, ports: tuple[tuple[str, bool | Layout], ...]) -> Any:
    """Return the C function of a step, still to be compiled."""
    body: Any = numba.njit(error_model="numpy", inline="always")(step)
    parameters_at, state_at, signals_at = record_at(packed), record_at(state), ports_at(ports)

    def entry(p: Any, s: Any, w: Any, io: Any) -> None:
        body(parameters_at(p), state_at(s), signals_at(w, io))

    options: dict[str, Any] = {"nopython": True, "error_model": "numpy"}
    return CFunc(entry, _SIGNATURE, locals={}, options=options, pipeline_class=_Apart)
