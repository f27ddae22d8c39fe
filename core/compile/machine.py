"""Processors that code is for, the way from instructions to machine code and into the process."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import llvmlite
import llvmlite.binding as llvm

from core.compile.numbers import NAME

WIDTH = 16 if llvm.get_host_cpu_features().get("avx512f") else 8
"""Boards side by side: two of the widest vectors or more, so that one computes while another waits for its operands."""


@dataclass(frozen=True)
class Target:
    """What code is for: a system, a processor with its features; and the version of the compiler."""

    triple: str
    processor: str
    features: str = ""
    compiler: str = llvmlite.__version__


X86, ARM = "x86_64-unknown-linux-gnu", "aarch64-unknown-linux-gnu"
V2 = {"cx16", "popcnt", "sahf", "sse3", "sse4.1", "sse4.2", "ssse3"}
V3 = V2 | {"avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"}
LEVELS: dict[Target, set[str]] = {
    Target(X86, "x86-64-v3"): V3,
    Target(X86, "x86-64-v2"): V2,
    Target(ARM, "generic"): {"neon"},
}
"""Processors for which code may be made before it is known on which machine it runs, with the features they need."""


@cache
def native() -> Target:
    """Return the processor of this machine."""
    return Target(llvm.get_process_triple(), llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten())


@cache
def levels() -> list[Target]:
    """Return the levels that this machine has, the best first."""
    return levels_of(native().triple, {name for name, is_there in llvm.get_host_cpu_features().items() if is_there})


def levels_of(triple: str, features: set[str]) -> list[Target]:
    """Return the levels that a machine has by its system and its features, the best first."""
    return [one for one, needed in LEVELS.items() if _system(one.triple) == _system(triple) and needed <= features]


def _system(triple: str) -> tuple[str, str]:
    """Return the processor and the system of a triple, without the vendor."""
    architecture, _, *rest = triple.split("-")
    return architecture, "-".join(rest)


def compiled(text: str, target: Target | None = None, *, loops: bool = False, joins: bool = False) -> bytes:
    """Return the machine code of instructions; where asked for, it is vector code where that is possible.

    Parameters
    ----------
    text : str
        The instructions.
    target : Target, optional
        The processor; by default the one of this machine.
    loops, joins : bool
        Whether rounds of a loop become vector code, and whether instructions that follow one another do.
    """
    target = target or native()
    return bytes(machine(target).emit_object(improved(text, target, loops=loops, joins=joins)))


def improved(text: str, target: Target, *, loops: bool, joins: bool = False) -> Any:
    """Return the module of instructions as machine code is made of it."""
    module, writer = llvm.parse_assembly(text), machine(target)
    module.verify()
    module.triple, module.data_layout = writer.triple, str(writer.target_data)
    tuning = llvm.create_pipeline_tuning_options(speed_level=3)
    tuning.loop_vectorization, tuning.slp_vectorization = loops, joins
    passes = llvm.create_pass_builder(writer, tuning)
    passes.getModulePassManager().run(module, passes)
    return module


class LoadedCode:
    """Machine code in this process, as long as this object lives.

    Parameters
    ----------
    code : bytes
        The machine code of a function.
    """

    def __init__(self, code: bytes) -> None:
        # an engine of its own for each: the constants of a second file in one engine would be read from the wrong
        # place; and for each engine a compiler of its own, which ends with it
        self._engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine(native()))
        self._file, self._code = llvm.ObjectFileRef.from_data(code), code
        self._engine.add_object_file(self._file)
        self._engine.finalize_object()
        self.address = int(self._engine.get_function_address(NAME))
        """Where the function is."""


_loaded: list[LoadedCode] = []
"""Code that is needed as long as the process lives."""


def loaded(code: bytes) -> int:
    """Return the address of the function in machine code; it stays there."""
    _loaded.append(LoadedCode(code))
    return _loaded[-1].address


@cache
def machine(target: Target) -> Any:
    """Return the compiler for a processor."""
    return _machine(target)


def _machine(target: Target) -> Any:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    if target != native():
        llvm.initialize_all_targets()
        llvm.initialize_all_asmprinters()
    made = llvm.Target.from_triple(target.triple)
    return made.create_target_machine(cpu=target.processor, features=target.features, opt=3, reloc="pic", jit=True)
