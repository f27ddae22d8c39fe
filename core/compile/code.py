"""Machine code of steps, for one board or for boards side by side."""

from __future__ import annotations

import hashlib
import inspect
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from llvmlite import ir

from core.block import Block
from core.compile.frames import Kinds
from core.compile.machine import compiled, loaded, target
from core.compile.numbers import DOUBLE, I64, NAME, Unsupported
from core.compile.places import PortsView, RecordView
from core.compile.translate import Translation
from core.kernel_cache import get, key, put

MOST_PASSES = 30
POINTER, PLACES = DOUBLE.as_pointer(), I64.as_pointer()


_addresses: dict[tuple[type[Block], int], int] = {}


def address(block: type[Block], width: int = 1) -> int:
    """Return where the C function of the step of a block is: pointers to parameters, state, all signals, and places."""
    found = _addresses.get((block, width))
    if found is None:
        found = _addresses[block, width] = loaded(kept(block, width))
    return found


def kept(block: type[Block], width: int = 1) -> bytes:
    """Return the machine code of a step; it is compiled, and put on the shelf, if it is not there."""
    name = name_of(block, width)
    code = get(name)
    if code is None:
        code = compiled(translated(block, width)[0], loops=width == 1)
        put(name, code)
    return code


def translated(block: type[Block], width: int) -> tuple[str, bool]:
    """Return the instructions of a step, and whether for all boards at once."""
    try:
        return instructions(block, width, lanes=width > 1), True
    except Unsupported:
        if width == 1:
            raise
        return instructions(block, width, lanes=False), False


def instructions(block: type[Block], width: int, *, lanes: bool) -> str:
    """Return the instructions of a step for so many boards: for all at once, or for one after another.

    Raises
    ------
    Unsupported
        When the step says something that is not known.
    """
    kinds: Kinds = {}
    for _ in range(MOST_PASSES):
        module, is_complete = _written(block, kinds, width, lanes=lanes)
        if is_complete:
            return str(module)
    raise Unsupported("variables whose kinds never settle")


def _written(block: type[Block], kinds: Kinds, width: int, *, lanes: bool) -> tuple[ir.Module, bool]:
    """Return the instructions as far as the kinds of variables are known, and whether that was enough."""
    module, builder, (p, s, w, io) = begun([POINTER, POINTER, POINTER, PLACES])
    start = builder.append_basic_block("start")
    translation = Translation(builder, kinds, width, lanes=lanes)
    ports = {port.name: (i, _seen(port)) for i, port in enumerate(block.Ports.declared)}

    def board(p: Any, s: Any, w: Any) -> None:
        records = RecordView(p, None, block.Packed.layout), RecordView(s, None, block.State.layout)
        translation.call(block.step, (*records, PortsView(w, io, ports)))

    with builder.goto_block(start):
        if lanes or width == 1:
            board(p, s, w)
        else:
            with counted(builder, ir.Constant(I64, width)) as k:  # one board after another
                board(*(builder.gep(base, [k]) for base in (p, s, w)))
        builder.ret_void()
    builder.branch(start)
    return module, translation.is_complete


def _seen(port: Any) -> Any:
    """Return what a step sees behind a port: a number, a vector, or records of a layout."""
    return port.record.layout if port.record else port.vector


def begun(kinds: list[Any]) -> tuple[ir.Module, ir.IRBuilder, tuple[Any, ...]]:
    """Return a module with a function of such arguments, which lie apart, a builder at its beginning, the arguments."""
    module = ir.Module(NAME)
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), kinds), NAME)
    for argument in function.args:
        argument.add_attribute("noalias")
    return module, ir.IRBuilder(function.append_basic_block("entry")), function.args


@contextmanager
def counted(builder: ir.IRBuilder, count: Any, step: int = 1) -> Iterator[Any]:
    """Repeat what is written inside for 0, step, ... below a count."""
    with builder.goto_entry_block():
        counter = builder.alloca(I64)
    builder.store(ir.Constant(I64, 0), counter)
    head, inside, behind = (builder.append_basic_block() for _ in range(3))
    builder.branch(head)
    builder.position_at_end(head)
    at = builder.load(counter)
    builder.cbranch(builder.icmp_signed("<", at, count), inside, behind)
    builder.position_at_end(inside)
    yield at
    builder.store(builder.add(at, ir.Constant(I64, step)), counter)
    builder.branch(head)
    builder.position_at_end(behind)


def name_of(block: type[Block], width: int) -> str:
    """Return the name on the shelf of a step for so many boards, on this machine."""
    return f"step-{width}-{block.__module__}-{hash_of(block, width, *target())}"


def hash_of(block: type[Block], *machine: Any) -> str:
    """Return a hash of a step, of what it sees, of this compiler and of what the code is for."""
    ports = [(port.name, _seen(port)) for port in block.Ports.declared]
    parts = key(block.step), block.Packed.layout, block.State.layout, ports, _compiler(), machine
    return hashlib.sha256("\n".join(map(str, parts)).encode()).hexdigest()[:24]


@cache
def _compiler() -> str:
    names = sorted(name for name in sys.modules if name.startswith("core.compile."))
    text = "".join(inspect.getsource(sys.modules[name]) for name in names)
    return hashlib.sha256(text.encode()).hexdigest()
