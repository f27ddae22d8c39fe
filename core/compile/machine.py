"""The machine that code is for: its processor, the way from instructions to machine code and into the process."""

from __future__ import annotations

from functools import cache
from typing import Any

import llvmlite
import llvmlite.binding as llvm

from core.compile.numbers import NAME

WIDTH = 16 if llvm.get_host_cpu_features().get("avx512f") else 8
"""Boards side by side: two of the widest vectors or more, so that one computes while another waits for its operands."""


@cache
def target() -> tuple[str, ...]:
    """Return what code is for, and who writes it: the target, the processor, its features, the version of LLVM."""
    features = llvm.get_host_cpu_features().flatten()
    return llvm.get_process_triple(), llvm.get_host_cpu_name(), features, llvmlite.__version__


def compiled(text: str, *, loops: bool = False) -> bytes:
    """Return the machine code of instructions; where asked for, loops become vector code where they can."""
    return bytes(machine().emit_object(improved(text, loops=loops)))


def improved(text: str, *, loops: bool) -> Any:
    """Return the module of instructions as machine code is made of it."""
    module = llvm.parse_assembly(text)
    module.verify()
    module.triple, module.data_layout = machine().triple, str(machine().target_data)
    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_vectorization, tuning.slp_vectorization = loops, False
    passes = llvm.create_pass_builder(machine(), tuning)
    passes.getModulePassManager().run(module, passes)
    return module


_loaded: list[tuple[Any, ...]] = []
"""Engines, files and code of loaded functions: they are needed as long as the process lives."""


def loaded(code: bytes) -> int:
    """Return the address of the function in machine code."""
    # an engine of its own for each: the constants of a second file in one engine would be read from the wrong place
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine())
    file = llvm.ObjectFileRef.from_data(code)
    engine.add_object_file(file)
    engine.finalize_object()
    _loaded.append((engine, file, code))
    return int(engine.get_function_address(NAME))


@cache
def machine() -> Any:
    """Return the compiler for the processor of this machine."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    triple, processor, features, _ = target()
    made = llvm.Target.from_triple(triple)
    return made.create_target_machine(cpu=processor, features=features, opt=3, reloc="pic", jit=True)
