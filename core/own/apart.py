"""Compiling user units: first in another process, so that a slow compilation blocks nothing."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from core.block import Block
from core.wall import wall

Compiler = Callable[[str, str], None]
"""Compiles a unit, by name and text, and puts its code where kernels are kept."""

_compilers: list[Compiler] = []


def compile_by(compiler: Compiler | None) -> None:
    """Name who compiles units; without anyone, each process does so itself."""
    _compilers[:] = [] if compiler is None else [compiler]
    _compiled.cache_clear()


def compiled_apart(block: type[Block]) -> type[Block]:
    """Return a block whose code is already in the cache if it is a user unit.

    Raises
    ------
    InputError
        When it takes too long, or too much memory.
    """
    if block.text:
        _compiled(block.name, block.text, wall.is_demanded())
    return block


@cache
def _compiled(name: str, text: str, _behind_wall: bool) -> None:
    for compiler in _compilers:
        compiler(name, text)
