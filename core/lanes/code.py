"""Machine code of steps for boards side by side."""

from __future__ import annotations

import hashlib
import inspect
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import llvmlite
import llvmlite.binding as llvm
from llvmlite import ir

from core.block import Block
from core.kernel_cache import get, key, put
from core.lanes.frames import Kinds
from core.lanes.numbers import DOUBLE, I64, WIDTH, Unsupported
from core.lanes.places import PortsView, RecordView
from core.lanes.translate import Translation

MOST_PASSES = 30
NAME = "step"
POINTER, PLACES = DOUBLE.as_pointer(), I64.as_pointer()


_addresses: dict[type[Block], int] = {}


def address(block: type[Block]) -> int:
    """Return where the C function of the step of a block is: pointers to parameters, state, all signals, and places."""
    found = _addresses.get(block)
    if found is None:
        found = _addresses[block] = loaded(kept(block))
    return found


def kept(block: type[Block]) -> bytes:
    """Return the machine code of a step; it is compiled, and put on the shelf, if it is not there."""
    name = f"lanes-{block.__module__}-{_hash(block)}"
    code = get(name)
    if code is None:
        code = compiled(translated(block)[0])
        put(name, code)
    return code


def translated(block: type[Block]) -> tuple[str, bool]:
    """Return the instructions of a step, and whether for all boards at once."""
    try:
        return instructions(block, lanes=True), True
    except Unsupported:
        return instructions(block, lanes=False), False


def instructions(block: type[Block], *, lanes: bool) -> str:
    """Return the instructions of a step for all boards at once, or for one after another.

    Raises
    ------
    Unsupported
        When the step says something that is not known.
    """
    kinds: Kinds = {}
    for _ in range(MOST_PASSES):
        module, is_complete = _written(block, kinds, lanes=lanes)
        if is_complete:
            return str(module)
    raise Unsupported("variables whose kinds never settle")


def _written(block: type[Block], kinds: Kinds, *, lanes: bool) -> tuple[ir.Module, bool]:
    """Return the instructions as far as the kinds of variables are known, and whether that was enough."""
    module, builder, (p, s, w, io) = begun([POINTER, POINTER, POINTER, PLACES])
    start = builder.append_basic_block("start")
    translation = Translation(builder, kinds, lanes=lanes)
    ports = {port.name: (i, _seen(port)) for i, port in enumerate(block.Ports.declared)}

    def board(p: Any, s: Any, w: Any) -> None:
        records = RecordView(p, None, block.Packed.layout), RecordView(s, None, block.State.layout)
        translation.call(block.step, (*records, PortsView(w, io, ports)))

    with builder.goto_block(start):
        if lanes:
            board(p, s, w)
        else:
            with counted(builder, ir.Constant(I64, WIDTH)) as k:  # one board after another
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


def compiled(text: str) -> bytes:
    """Return the machine code of instructions."""
    machine = _machine()
    module = llvm.parse_assembly(text)
    module.verify()
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    # what may run as vectors is vectors already
    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_vectorization = tuning.slp_vectorization = False
    passes = llvm.create_pass_builder(machine, tuning)
    passes.getModulePassManager().run(module, passes)
    return bytes(machine.emit_object(module))


_loaded: list[tuple[Any, ...]] = []
"""What must live as long as the code."""


def loaded(code: bytes) -> int:
    """Return the address of the function in machine code."""
    # an engine of its own for each: the constants of a second file in one engine would be read from the wrong place
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine())
    file = llvm.ObjectFileRef.from_data(code)
    engine.add_object_file(file)
    engine.finalize_object()
    _loaded.append((engine, file, code))
    return int(engine.get_function_address(NAME))


@cache
def _machine() -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_triple(llvm.get_process_triple())
    cpu, features = _processor()
    return target.create_target_machine(cpu=cpu, features=features, opt=3, reloc="pic", jit=True)


@cache
def _processor() -> tuple[str, str]:
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


def _hash(block: type[Block]) -> str:
    """Return a hash of a step, of what it sees, of this compiler, of the boards side by side and of the machine."""
    ports = [(port.name, _seen(port)) for port in block.Ports.declared]
    machine = llvm.get_process_triple(), *_processor()
    parts = key(block.step), block.Packed.layout, block.State.layout, ports, _compiler(), WIDTH, machine
    return hashlib.sha256("\n".join(map(str, parts)).encode()).hexdigest()[:24]


@cache
def _compiler() -> str:
    names = sorted(name for name in sys.modules if name.startswith("core.lanes."))
    text = "".join(inspect.getsource(sys.modules[name]) for name in names)
    return f"{hashlib.sha256(text.encode()).hexdigest()} {llvmlite.__version__}"
