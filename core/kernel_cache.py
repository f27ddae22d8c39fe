"""Keeps compiled kernels, so that each is compiled once.

A kernel is known by a hash of its bytecode, of the constants, layouts and kernels it names, of the compiler and of
the processor. After an edit only the edited kernels and their callers are compiled; after an edit of a comment none.
"""

from __future__ import annotations

import dis
import hashlib
from functools import cache
from types import CodeType, FunctionType, ModuleType
from typing import Any, Protocol

import numpy as np


class KernelShelf(Protocol):
    """A place for compiled kernels that outlasts the process."""

    def get(self, name: str) -> bytes | None:
        """Return a kernel, or nothing."""

    def put(self, name: str, code: bytes) -> None:
        """Keep a kernel."""


_shelves: list[KernelShelf] = []


def keep_on(*shelves: KernelShelf) -> None:
    """Name the places of compiled kernels; without one each process compiles its own."""
    _shelves[:] = shelves


compiled_here: list[str] = []
"""The names of kernels that this process compiled because no shelf had them."""


def get(name: str) -> bytes | None:
    """Return a kernel from the shelf, if its file is whole and has the mark of this name."""
    for shelf in _shelves:
        file = shelf.get(name) or b""
        mark, code = file[:MARK], file[MARK:]
        if mark == _mark(name, code):
            return code
    return None


def put(name: str, code: bytes) -> None:
    """Keep a kernel on the shelf, if there is one."""
    for shelf in _shelves:
        shelf.put(name, marked(name, code))


def marked(name: str, code: bytes) -> bytes:
    """Return the file of a kernel: its mark, then its code."""
    return _mark(name, code) + code


MARK = 32
"""Bytes before the code of a kernel, a hash of its name and of its code."""


def _mark(name: str, code: bytes) -> bytes:
    return hashlib.sha256(name.encode() + b"\0" + code).digest()


@cache
def key(function: FunctionType) -> str:
    """Return a hash of a function and of all it names, which another process would find too."""
    digest = hashlib.sha256()
    _digest_function(function, digest, {})
    return digest.hexdigest()


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
