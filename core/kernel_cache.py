"""Keeps compiled kernels, so that each is compiled once.

A kernel is known by a hash of its bytecode, of the constants, layouts and kernels it names, of the compiler and of
the processor. An edit compiles again what it touches and nothing else; an edit of a comment compiles nothing.
"""

from __future__ import annotations

import dis
import hashlib
import inspect
import pickle
import sys
from functools import cache
from types import CodeType, FunctionType, ModuleType
from typing import Any, Protocol

import numba
import numpy as np
from numba.core import serialize
from numba.core.compiler import CompileResult


class Shelf(Protocol):
    """A place for compiled kernels that outlasts the process."""

    def get(self, name: str) -> bytes | None:
        """Return a kernel, if it is there."""

    def put(self, name: str, code: bytes) -> None:
        """Keep a kernel."""


_shelves: list[Shelf] = []


def keep_on(shelf: Shelf) -> None:
    """Name the place of compiled kernels; without one each process compiles its own."""
    _shelves[:] = [shelf]


def get(name: str) -> bytes | None:
    """Return a kernel from the shelf, if there is one and the kernel is on it."""
    return next((code for shelf in _shelves if (code := shelf.get(name)) is not None), None)


def put(name: str, code: bytes) -> None:
    """Keep a kernel on the shelf, if there is one."""
    for shelf in _shelves:
        shelf.put(name, code)


class KernelCache:
    """Compiled code of one kernel; numba asks here before it compiles, and tells what it has compiled."""

    compiled = 0
    """Kernels compiled by this process because no shelf had them."""

    def __init__(self, function: FunctionType) -> None:
        self._function = function

    def load_overload(self, signature: Any, target: Any) -> Any:
        """Return the code compiled for a signature, or nothing."""
        target.refresh()
        code = get(self._name(signature, target))
        try:
            return CompileResult._rebuild(target, *pickle.loads(code)) if code is not None else None
        except (EOFError, pickle.UnpicklingError, ValueError, TypeError, AttributeError):
            return None  # another version wrote it, or half of it is lost: compile again

    def save_overload(self, signature: Any, result: Any) -> None:
        """Keep the code compiled for a signature."""
        KernelCache.compiled += 1
        if not result.library.has_dynamic_globals:
            put(self._name(signature, result.target_context), serialize.dumps(result._reduce()))

    def _name(self, signature: Any, target: Any) -> str:
        versions = numba.__version__, np.__version__, _compiler()
        parts = (key(self._function), *versions, signature, target.codegen().magic_tuple())
        digest = hashlib.sha256("\n".join(map(str, parts)).encode())
        return f"{self._function.__module__}.{self._function.__name__}-{digest.hexdigest()[:24]}"


@cache
def key(function: FunctionType) -> str:
    """Return a hash of a function and of all it names, which another process would find too."""
    digest = hashlib.sha256()
    _digest_function(function, digest, {})
    return digest.hexdigest()


@cache
def _compiler() -> str:
    """Return the text that makes machine code of helpers, beside numba."""
    return "".join(inspect.getsource(sys.modules[name]) for name in ("core.kernel", "core.views"))


def _digest_function(function: FunctionType, digest: Any, seen: dict[int, int]) -> None:
    if id(function) in seen:
        digest.update(f"seen {seen[id(function)]}".encode())
        return
    seen[id(function)] = len(seen)
    _digest_code(function.__code__, digest, function.__doc__)
    names, globals_ = _names(function.__code__), _globals(function.__code__)
    for name in globals_:
        if name in function.__globals__:
            _digest_value(name, function.__globals__[name], names, digest, seen)
    for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
        _digest_value(name, cell.cell_contents, names, digest, seen)


def _digest_value(name: str, value: Any, names: tuple[str, ...], digest: Any, seen: dict[int, int]) -> None:
    function = getattr(value, "py_func", value)
    digest.update(f"\n{name}=".encode())
    if isinstance(function, FunctionType):
        _digest_function(function, digest, seen)
    elif isinstance(value, ModuleType) and value.__name__.startswith("core."):
        for attribute in names:
            if attribute in vars(value):
                _digest_value(attribute, vars(value)[attribute], names, digest, seen)
    elif isinstance(value, np.ndarray):
        digest.update(value.tobytes())
    elif isinstance(value, int | float | str | tuple | np.generic):
        digest.update(repr(value).encode())


def _digest_code(code: CodeType, digest: Any, docstring: str | None = None) -> None:
    digest.update(code.co_code)
    digest.update(repr((code.co_names, code.co_varnames, code.co_freevars, code.co_argcount)).encode())
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            _digest_code(constant, digest)
        elif constant != docstring:
            digest.update(repr(constant).encode())


def _names(code: CodeType) -> tuple[str, ...]:
    """Return every name and attribute that code uses."""
    inner = [name for constant in code.co_consts if isinstance(constant, CodeType) for name in _names(constant)]
    return tuple(dict.fromkeys([*code.co_names, *inner]))


def _globals(code: CodeType) -> tuple[str, ...]:
    """Return every global name that code uses."""
    own = [step.argval for step in dis.get_instructions(code) if step.opname == "LOAD_GLOBAL"]
    inner = [name for constant in code.co_consts if isinstance(constant, CodeType) for name in _globals(constant)]
    return tuple(dict.fromkeys([*own, *inner]))
