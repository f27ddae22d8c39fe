"""WebAssembly of steps: the instructions that machine code is made of, for a machine that has no way out of its memory.

The module has two functions. ``step`` takes the addresses of parameters, state, signals and places; ``room`` says from
where on memory is free. It asks for its memory and the place of its stack, and for no function.
"""

from __future__ import annotations

import inspect
import sys

import llvmlite

from core.block import Block
from core.compile.code import hash_of, instructions
from core.compile.numbers import NAME
from core.errors import InputError
from core.kernel_cache import kept_or_made
from core.wasm import target

OFFERED = f"""
declare void @{NAME}(ptr, ptr, ptr, ptr)
define void @offered(ptr %p, ptr %s, ptr %w, ptr %io) "wasm-export-name"="step" {{
  call void @{NAME}(ptr %p, ptr %s, ptr %w, ptr %io)
  ret void
}}
"""


def kept(block: type[Block]) -> bytes:
    """Return the WebAssembly of a step; it is compiled, and put on the shelf, if it is not there."""
    return kept_or_made(name_of(block), lambda: compiled(instructions(block, 1, lanes=False)))


def compiled(text: str) -> bytes:
    """Return the WebAssembly of the instructions of a step.

    Raises
    ------
    InputError
        When they call a function that is not among them.
    """
    module = target.aimed(text)
    module.link_in(target.aimed(OFFERED))
    target.improve(module, {"offered"})
    for name in target.asked_for(module):
        raise InputError(f"calls {name}, which is not there behind the wall")
    return target.emitted(module)


def name_of(block: type[Block]) -> str:
    """Return the name of a step on the shelf, with a hash of its code, its records and ports, and this compiler."""
    own = inspect.getsource(sys.modules[__name__]), inspect.getsource(target)
    return f"wall-{block.__module__}-{hash_of(block, own, llvmlite.__version__)}"
