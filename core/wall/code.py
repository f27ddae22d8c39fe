"""WebAssembly of steps: the instructions that machine code is made of, for a machine that has no way out of its memory.

The module has two functions. ``step`` takes the addresses of parameters, state, signals and places; ``room`` says from
where on memory is free. It asks for its memory and the place of its stack, and for no function.
"""

from __future__ import annotations

import inspect
import sys
from functools import cache
from typing import Any

import llvmlite
import llvmlite.binding as llvm

from core.block import Block
from core.compile.code import hash_of, instructions
from core.compile.numbers import NAME
from core.errors import InputError
from core.kernel_cache import get, put

TARGET = "wasm32-unknown-unknown"
FEATURES = "+bulk-memory,+nontrapping-fptoint,+sign-ext,+mutable-globals"
ALIGNMENT = 64

OFFERED = f"""
declare void @{NAME}(ptr, ptr, ptr, ptr)
define void @offered(ptr %p, ptr %s, ptr %w, ptr %io) "wasm-export-name"="step" {{
  call void @{NAME}(ptr %p, ptr %s, ptr %w, ptr %io)
  ret void
}}
"""
ROOM = """
define i32 @room() "wasm-export-name"="room" {{
  ret i32 {free}
}}
"""


def kept(block: type[Block]) -> bytes:
    """Return the WebAssembly of a step; it is compiled, and put on the shelf, if it is not there."""
    name = name_of(block)
    code = get(name)
    if code is None:
        code = compiled(instructions(block, 1, lanes=False))
        put(name, code)
    return code


def compiled(text: str) -> bytes:
    """Return the WebAssembly of the instructions of a step.

    Raises
    ------
    InputError
        When they call a function that is not among them.
    """
    machine = _machine()
    module = _aimed(text, machine)
    module.link_in(_aimed(OFFERED, machine))
    for one in (*module.global_variables, *module.functions):
        if not one.is_declaration and one.name != "offered":
            one.linkage = "internal"  # functions without a caller are left out
    tuning = llvm.create_pipeline_tuning_options(speed_level=2)
    tuning.loop_vectorization = tuning.slp_vectorization = False
    passes = llvm.create_pass_builder(machine, tuning)
    passes.getModulePassManager().run(module, passes)
    for one in module.functions:
        if one.is_declaration and not one.name.startswith("llvm."):
            raise InputError(f"calls {one.name}, which is not there behind the wall")
    sizes = [machine.target_data.get_abi_size(one.global_value_type) for one in module.global_variables]
    free = sum(size + ALIGNMENT for size in sizes)  # as if before each one a whole step of alignment were lost
    module.link_in(_aimed(ROOM.format(free=-(-free // ALIGNMENT) * ALIGNMENT), machine))
    module.verify()
    return bytes(machine.emit_object(module))


def _aimed(text: str, machine: Any) -> Any:
    """Return the module of instructions, for this machine."""
    module = llvm.parse_assembly(text)
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    return module


@cache
def _machine() -> Any:
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    target = llvm.Target.from_triple(TARGET)
    return target.create_target_machine(cpu="generic", features=FEATURES, opt=3, reloc="static")


def name_of(block: type[Block]) -> str:
    """Return the name of a step on the shelf, with a hash of its code, its records and ports, and this compiler."""
    own = inspect.getsource(sys.modules[__name__])
    return f"wall-{block.__module__}-{hash_of(block, own, llvmlite.__version__)}"
