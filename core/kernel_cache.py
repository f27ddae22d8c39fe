"""Keeps compiled kernels, so that each is compiled once.

A kernel is known by a hash of its function, of the constants, layouts and kernels it names, of the compiler and of
the processor. On its own machine a function is hashed by its bytecode: after an edit only the edited kernels and their
callers are compiled, after an edit of a comment none. Code that travels is hashed by the text of its functions, which
is the same for every version of Python.
"""

from __future__ import annotations

import dis
import hashlib
from collections.abc import Callable
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


def kept_or_made(name: str, make: Callable[[], bytes]) -> bytes:
    """Return a kernel from the shelf; if it is not there, make it and keep it."""
    code = get(name)
    if code is None:
        code = make()
        put(name, code)
    return code


def marked(name: str, code: bytes) -> bytes:
    """Return the file of a kernel: its mark, then its code."""
    return _mark(name, code) + code


MARK = 32
"""Bytes before the code of a kernel, a hash of its name and of its code."""


def _mark(name: str, code: bytes) -> bytes:
    return hashlib.sha256(name.encode() + b"\0" + code).digest()


Content = Callable[[FunctionType], str]
"""Returns the text by which a function is known."""


def bytecode(function: FunctionType) -> str:
    """Return the bytecode of a function, with its names and its constants but for its docstring."""
    return "\n".join(_parts(function.__code__, function.__doc__))


def _parts(code: CodeType, docstring: str | None = None) -> list[str]:
    found = [code.co_code.hex(), repr((code.co_names, code.co_varnames, code.co_freevars, code.co_argcount))]
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            found += _parts(constant)
        elif constant != docstring:
            found.append(repr(constant))
    return found


@cache
def key(function: FunctionType, content: Content = bytecode) -> str:
    """Return a hash of a function and of all it names, which another process would find too."""
    digest = hashlib.sha256()
    _Walk(content, digest).function(function)
    return digest.hexdigest()


class _Walk:
    """A walk from a function to all that it names, in the same order in every version of Python."""

    def __init__(self, content: Content, digest: Any) -> None:
        self._content, self._digest = content, digest
        self._seen: dict[int, int] = {}

    def function(self, function: FunctionType) -> None:
        if id(function) in self._seen:
            self._digest.update(f"seen {self._seen[id(function)]}".encode())
            return
        self._seen[id(function)] = len(self._seen)
        self._digest.update(self._content(function).encode())
        code = function.__code__
        names = _names(code)
        for name in _globals(code):
            if name in function.__globals__:
                self._value(name, function.__globals__[name], names)
        for name, cell in zip(code.co_freevars, function.__closure__ or (), strict=True):
            self._value(name, cell.cell_contents, names)

    def _value(self, name: str, value: Any, names: list[str]) -> None:
        function = getattr(value, "py_func", value)
        self._digest.update(f"\n{name}=".encode())
        if isinstance(function, FunctionType):
            self.function(function)
        elif isinstance(value, ModuleType) and value.__name__.startswith("core."):
            for attribute in names:
                if attribute in vars(value):
                    self._value(attribute, vars(value)[attribute], names)
        elif isinstance(value, np.ndarray):
            self._digest.update(value.tobytes())
        elif isinstance(value, int | float | str | tuple | np.generic):
            self._digest.update(repr(value).encode())


def _names(code: CodeType) -> list[str]:
    """Return every name and attribute that code uses."""
    return sorted({name for one in _nested(code) for name in one.co_names})


def _globals(code: CodeType) -> list[str]:
    """Return every global name that code uses."""
    steps = (step for one in _nested(code) for step in dis.get_instructions(one))
    return sorted({step.argval for step in steps if step.opname == "LOAD_GLOBAL"})


def _nested(code: CodeType) -> list[CodeType]:
    """Return code and the code within it."""
    inner = [one for constant in code.co_consts if isinstance(constant, CodeType) for one in _nested(constant)]
    return [code, *inner]
