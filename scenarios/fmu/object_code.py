"""The steps of blocks as an object file for a linker, from the one compiler."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import llvmlite.binding as llvm

from core.block import Block
from core.compile.code import instructions
from core.compile.machine import Target, improved
from core.compile.numbers import NAME


def object_of(blocks: Sequence[type[Block]], target: Target) -> bytes:
    """Return an object file with a C function for the step of each block, ``step_0`` and so on."""
    whole: Any = llvm.parse_assembly("")
    writer = _writer(target)
    whole.triple, whole.data_layout = writer.triple, str(writer.target_data)
    for number, block in enumerate(blocks):
        module = improved(instructions(block, 1, lanes=False), target, loops=True)
        module.get_function(NAME).name = f"step_{number}"
        whole.link_in(module)
    whole.verify()
    return bytes(writer.emit_object(whole))


def _writer(target: Target) -> Any:
    """Return the compiler for code that a linker takes, at any address."""
    made = llvm.Target.from_triple(target.triple)
    return made.create_target_machine(cpu=target.processor, features=target.features, opt=3, reloc="pic")
