"""Machine code of steps, for one board or for boards side by side."""

from __future__ import annotations

import hashlib
import inspect
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from llvmlite import ir

from core.compile.arrays import counted
from core.compile.frames import Kinds, text_of
from core.compile.machine import Target, compiled, levels, loaded, native
from core.compile.numbers import DOUBLE, I64, NAME, Unsupported
from core.compile.places import PortsView, RecordView
from core.compile.translate import Translation
from core.kernel_cache import Content, bytecode, compiled_here, get, key, put

MOST_PASSES = 30
OTHERS = {"core.compile.folding", "core.compile.keeping", "core.compile.segment"}
"""Modules beside the translator, which some processes load and some do not."""
POINTER, PLACES = DOUBLE.as_pointer(), I64.as_pointer()


Block = Any
"""A class with a step and the records and ports that it sees."""

_addresses: dict[tuple[Block, int], int] = {}


@dataclass(frozen=True)
class Piece:
    """A function that can become machine code.

    Attributes
    ----------
    name : str
        Its name on the shelf, without the part that differs with the code and the processor.
    hash : callable
        Returns a hash of all that the code depends on but the processor, by what functions are known by.
    write : callable
        Returns its instructions.
    loops, joins : bool
        Whether its loops, and instructions that follow one another, become vector code where they can.
    """

    name: str
    hash: Callable[[Content], str]
    write: Callable[[], str]
    loops: bool
    joins: bool = False

    def name_for(self, target: Target) -> str:
        """Return its name on the shelf for a processor.

        Code for a level comes from another machine, perhaps from another version of Python, so it is known by text.
        """
        content = bytecode if target == native() else text_of
        return f"{self.name}-{digest(self.hash(content), target)}"

    def kept(self) -> bytes:
        """Return its machine code from the shelf: for this very processor, else for a level that the processor has.

        Where the shelf has neither, the code is compiled for this processor and put there.
        """
        for target in (native(), *levels()):
            code = get(self.name_for(target))
            if code is not None:
                if target != native():
                    borrowed.add(self.name)
                return code
        name, code = self.name_for(native()), compiled(self.write(), loops=self.loops, joins=self.joins)
        compiled_here.append(name)
        put(name, code)
        return code


borrowed: set[str] = set()
"""Names of pieces whose code in this process was for a level of the processor when it was loaded first."""


def address(block: Block, width: int = 1) -> int:
    """Return the address of the C function of a step; it takes pointers to parameters, state, signals and places."""
    found = _addresses.get((block, width))
    if found is None:
        found = _addresses[block, width] = loaded(step(block, width).kept())
    return found


def renew() -> None:
    """Load the code of steps for this processor in place of code for a level, now that the shelf may have it."""
    for block, width in list(_addresses):
        piece = step(block, width)
        if piece.name in borrowed:
            _addresses[block, width] = loaded(piece.kept())


def helper(write: Callable[..., ir.Module], *arguments: Any) -> int:
    """Return the address of a C function beside the steps, by the function that writes its module.

    The arguments are part of its name on the shelf: whatever the module depends on is one of them, the number of boards
    too.
    """
    own = inspect.getsource(sys.modules[write.__module__])
    piece = Piece(
        f"{write.__name__}-{write.__module__}",
        lambda _: digest(own, compiler(), arguments),
        lambda: str(write(*arguments)),
        loops=False,
    )
    return loaded(piece.kept())


def step(block: Block, width: int = 1) -> Piece:
    """Return the step of a block, for so many boards."""
    name = f"step-{width}-{block.__module__}"
    return Piece(
        name,
        lambda content: hash_of(block, width, content=content),
        lambda: translated(block, width)[0],
        loops=width == 1,
    )


def translated(block: Block, width: int) -> tuple[str, bool]:
    """Return the instructions of a step, and whether for all boards at once."""
    try:
        return instructions(block, width, lanes=width > 1), True
    except Unsupported:
        if width == 1:
            raise
        return instructions(block, width, lanes=False), False


def instructions(block: Block, width: int, *, lanes: bool) -> str:
    """Return the instructions of a step for so many boards: for all at once, or for one after another.

    Raises
    ------
    Unsupported
        When the step says something that is not known.
    """
    return str(module_of(block, width, lanes=lanes))


def module_of(block: Block, width: int, *, lanes: bool) -> ir.Module:
    """Return the module with the instructions of a step."""
    return settled(lambda kinds: _written(block, kinds, width, lanes=lanes))


def settled(write: Callable[[Kinds], tuple[ir.Module, bool]]) -> ir.Module:
    """Return a module whose instructions are written again and again until the kinds of all variables are known."""
    kinds: Kinds = {}
    for _ in range(MOST_PASSES):
        module, is_complete = write(kinds)
        if is_complete:
            return module
    raise Unsupported("variables whose kinds never settle")


def _written(block: Block, kinds: Kinds, width: int, *, lanes: bool) -> tuple[ir.Module, bool]:
    """Return the instructions as far as the kinds of variables are known, and whether that was enough."""
    module, builder, (p, s, w, io) = begun([POINTER, POINTER, POINTER, PLACES])
    start = builder.append_basic_block("start")
    translation = Translation(builder, kinds, width, lanes=lanes)
    with builder.goto_block(start):
        if lanes or width == 1:
            call_step(translation, block, p, s, w, io)
        else:
            with counted(builder, ir.Constant(I64, width)) as k:  # one board after another
                own = builder.gep(p, [k]), builder.gep(s, [k]), builder.gep(w, [k])
                call_step(translation, block, *own, io)
        builder.ret_void()
    builder.branch(start)
    return module, translation.is_complete


def call_step(
    translation: Translation, block: Block, p: Any, s: Any, w: Any, io: Any, known: Mapping[int, int] | None = None
) -> None:
    """Write the instructions of a step behind these pointers; ``known`` has the constant places of signals."""
    records = RecordView(p, None, block.Packed.layout), RecordView(s, None, block.State.layout)
    ports = {port.name: (i, _seen(port)) for i, port in enumerate(block.Ports.declared)}
    translation.call(block.step, (*records, PortsView(w, io, ports, known or {})))


def _seen(port: Any) -> Any:
    """Return how a step sees the signal behind a port: as a number, a vector, or records of a layout."""
    return port.record.layout if port.record else port.vector


def begun(kinds: list[Any]) -> tuple[ir.Module, ir.IRBuilder, tuple[Any, ...]]:
    """Return a module with a function of arguments in separate memory, a builder at its start, and the arguments."""
    module = ir.Module(NAME)
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), kinds), NAME)
    for argument in function.args:
        argument.add_attribute("noalias")
    return module, ir.IRBuilder(function.append_basic_block("entry")), function.args


def hash_of(block: Block, *others: Any, content: Content = bytecode) -> str:
    """Return a hash of a step, its records and ports, this compiler, and the other arguments."""
    ports = [(port.name, _seen(port)) for port in block.Ports.declared]
    return digest(key(block.step, content), block.Packed.layout, block.State.layout, ports, compiler(), others)


def digest(*parts: Any) -> str:
    """Return the part of a name on the shelf that differs with anything the code depends on."""
    return hashlib.sha256("\n".join(map(str, parts)).encode()).hexdigest()[:24]


@cache
def compiler() -> str:
    """Return a hash of this compiler."""
    names = sorted(name for name in sys.modules if name.startswith("core.compile.") and name not in OTHERS)
    text = "".join(inspect.getsource(sys.modules[name]) for name in names)
    return hashlib.sha256(text.encode()).hexdigest()
