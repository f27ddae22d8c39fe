"""The machine that WebAssembly runs on, and the way from instructions to a module of it."""

from __future__ import annotations

from functools import cache
from typing import Any

import llvmlite.binding as llvm

TARGET = "wasm32-unknown-unknown"
FEATURES = "+bulk-memory,+nontrapping-fptoint,+sign-ext,+mutable-globals"
VECTORS = "+simd128"
"""The feature of code with vectors, which the wall does not admit."""
ALIGNMENT = 64
ROOM = """
define i32 @room() "wasm-export-name"="room" {{
  ret i32 {free}
}}
"""


def aimed(text: str) -> Any:
    """Return the module of instructions, for this machine."""
    module = llvm.parse_assembly(text)
    module.triple, module.data_layout = machine().triple, str(machine().target_data)
    return module


def improve(module: Any, kept: set[str], *, vectors: bool = False) -> None:
    """Leave out all functions that none of the kept ones calls, and make the others quicker; no bit changes."""
    for one in (*module.global_variables, *module.functions):
        if not one.is_declaration and one.name not in kept:
            one.linkage = "internal"
    tuning = llvm.create_pipeline_tuning_options(speed_level=3 if vectors else 2)
    tuning.loop_vectorization = tuning.slp_vectorization = vectors
    passes = llvm.create_pass_builder(machine(vectors=vectors), tuning)
    passes.getModulePassManager().run(module, passes)


def asked_for(module: Any) -> list[str]:
    """Return the functions that a module calls and does not have."""
    return [one.name for one in module.functions if one.is_declaration and not one.name.startswith("llvm.")]


def emitted(module: Any, *, vectors: bool = False) -> bytes:
    """Return the WebAssembly of a module, which then also says from where on its memory is free.

    An object file with one module of instructions needs no linker: its calls are direct, and none of its data moves.
    """
    sizes = [machine().target_data.get_abi_size(one.global_value_type) for one in module.global_variables]
    free = sum(size + ALIGNMENT for size in sizes)  # as if before each one a whole step of alignment were lost
    module.link_in(aimed(ROOM.format(free=-(-free // ALIGNMENT) * ALIGNMENT)))
    module.verify()
    return bytes(machine(vectors=vectors).emit_object(module))


@cache
def machine(*, vectors: bool = False) -> Any:
    """Return the compiler for this machine, with vectors or without."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    target = llvm.Target.from_triple(TARGET)
    return target.create_target_machine(
        cpu="generic", features=f"{FEATURES},{VECTORS}" if vectors else FEATURES, opt=3, reloc="static"
    )
