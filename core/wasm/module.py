"""A module in WebAssembly: kernels that it offers, and the steps and segments that these call by their numbers.

A kernel that it offers takes the place of its results first. Of its arguments a number is a double, and an array the
place of its first element followed by its lengths. Results are doubles too: all whole numbers of a board are exact.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from types import FunctionType
from typing import Any

import llvmlite
import llvmlite.binding as llvm
from llvmlite import ir

from core.compile import code, segment
from core.compile.arrays import ELEMENTS, ArrayView, contiguous
from core.compile.code import Block, compiler, digest, settled
from core.compile.instructions import call
from core.compile.numbers import BOOL, DOUBLE, FLOAT, I64, INT, NAME, CompiledNumber
from core.compile.segment import Segment
from core.compile.translate import Translation
from core.errors import InputError
from core.kernel_cache import bytecode, kept_or_made, key
from core.wasm import target

LENT = {"fmod"}
"""Functions that the machine gives: the rest of a division of doubles, which is exact everywhere."""
WORD = ir.IntType(32)
STEP = "step_of_number"


@dataclass(frozen=True)
class OfferedKernel:
    """A kernel and the kinds of its arguments: ``float64``, ``int64`` or, of an array, its elements and dimensions."""

    function: FunctionType
    kinds: tuple[str | tuple[str, int], ...]


class NumberedTranslation(Translation):
    """One translation of a kernel in which the address of a step is its number."""

    def call(self, function: Any, arguments: Sequence[Any], named: dict[str, Any] | None = None) -> Any:
        """Translate a call of a function; where it runs a step, a call of the function that knows all steps."""
        if function is not call:
            return super().call(function, arguments, named)
        module = self.builder.module
        step = module.globals.get(STEP) or ir.Function(module, ir.FunctionType(ir.VoidType(), [I64] * 5), STEP)
        self.builder.call(step, [self.arithmetic.as_kind(one, INT).value for one in arguments])
        return None


@dataclass(frozen=True)
class _ModulePart:
    """A function of a module: its name on the shelf, its instructions, and how they name it."""

    kept_as: str
    write: Callable[[], str]
    function: str = NAME

    def get(self) -> Any:
        """Return a module with this function alone, from the shelf if the shelf has it."""
        # a new part is read back too: its order in memory differs, and so might the code of the module
        return llvm.parse_bitcode(kept_or_made(self.kept_as, self._improved))

    def _improved(self) -> bytes:
        part = target.aimed(self.write())
        target.improve(part, {self.function}, vectors=True)
        return bytes(part.as_bitcode())


def module_of(kernels: Mapping[str, OfferedKernel], steps: Sequence[Block | Segment]) -> bytes:
    """Return the module of some kernels, steps and segments; the module and its parts are kept on the shelf.

    Raises
    ------
    InputError
        When a step calls a function that the machine does not have.
    """
    own = [_part_of(step) for step in steps]
    offered = [_offered(name, kernel) for name, kernel in kernels.items()]
    name = f"wasm-{digest(*(part.kept_as for part in (*own, *offered)))}"
    return kept_or_made(name, lambda: _joined(offered, steps, own))


def _part_of(step: Block | Segment) -> _ModulePart:
    piece = segment.piece(step) if isinstance(step, tuple) else code.step(step)
    return _ModulePart(f"wasm-{piece.name}-{digest(piece.hash(bytecode), _own())}", piece.write)


def _offered(name: str, kernel: OfferedKernel) -> _ModulePart:
    content = digest(key(kernel.function), name, kernel.kinds, compiler(), _own())
    return _ModulePart(f"wasm-{name}-{content}", partial(instructions, name, kernel), name)


def _joined(offered: Sequence[_ModulePart], steps: Sequence[Block | Segment], parts: Sequence[_ModulePart]) -> bytes:
    """Return the module of some kernels and of the steps that they call by their numbers, each a function."""
    module = target.aimed(_dispatch(len(steps)))
    for number, (step, part) in enumerate(zip(steps, parts, strict=True)):
        function = part.get()
        if missing := {*target.asked_for(function)} - LENT:
            name = "a segment" if isinstance(step, tuple) else step.name
            raise InputError(f"{name} calls {', '.join(sorted(missing))}, which no browser has")
        function.get_function(NAME).name = f"{NAME}_{number}"
        module.link_in(function)
    for part in offered:
        module.link_in(part.get())
    # not improved as a whole: all steps in one function take seconds to compile, here and in the browser
    return target.emitted(module, vectors=True)


@cache
def _own() -> str:
    """Return a hash of this way to WebAssembly, and the version of the compiler."""
    return digest(*(inspect.getsource(module) for module in (sys.modules[__name__], target)), llvmlite.__version__)


def _dispatch(steps: int) -> str:
    """Return the function that calls a step by its number."""
    numbers = range(steps)
    declared = "\n".join(f"declare void @{NAME}_{k}(ptr, ptr, ptr, ptr)" for k in numbers)
    cases = "\n".join(f"    i64 {k}, label %step{k}" for k in numbers)
    calls = "\n".join(
        f"step{k}:\n  call void @{NAME}_{k}(ptr %p, ptr %s, ptr %w, ptr %io)\n  br label %end" for k in numbers
    )
    pointers = "\n".join(f"  %{one} = inttoptr i64 %{one}_at to ptr" for one in ("p", "s", "w", "io"))
    return f"""
{declared}
define void @{STEP}(i64 %number, i64 %p_at, i64 %s_at, i64 %w_at, i64 %io_at) {{
{pointers}
  switch i64 %number, label %end [
{cases}
  ]
{calls}
end:
  ret void
}}
"""


def instructions(name: str, kernel: OfferedKernel) -> str:
    """Return the instructions of a kernel that the module offers by this name."""
    text = str(settled(lambda known: _written(name, kernel, known)))
    head, mark, rest = text.partition(f'define void @"{name}"')
    signature, brace, body = rest.partition("\n{")
    return f'{head}{mark}{signature} "wasm-export-name"="{name}"{brace}{body}'


def _written(name: str, kernel: OfferedKernel, known: Any) -> tuple[ir.Module, bool]:
    module = ir.Module(name)
    taken: list[Any] = [DOUBLE.as_pointer()]
    for kind in kernel.kinds:
        taken += [ELEMENTS[kind[0]][0].as_pointer(), *[WORD] * kind[1]] if isinstance(kind, tuple) else [DOUBLE]
    offered = ir.Function(module, ir.FunctionType(ir.VoidType(), taken), name)
    builder = ir.IRBuilder(offered.append_basic_block("entry"))
    start = builder.append_basic_block("start")
    with builder.goto_block(start):
        translation = NumberedTranslation(builder, known, 1, lanes=False)
        given = iter(offered.args[1:])
        result = translation.call(kernel.function, [_taken(builder, kind, given, translation) for kind in kernel.kinds])
        results = result if isinstance(result, tuple) else () if result is None else (result,)
        for i, one in enumerate(results):
            number = translation.arithmetic.as_kind(one, FLOAT).value
            builder.store(number, builder.gep(offered.args[0], [ir.Constant(I64, i)]))
        builder.ret_void()
    builder.branch(start)
    return module, translation.is_complete


def _taken(builder: ir.IRBuilder, kind: Any, given: Any, translation: Translation) -> Any:
    """Return an argument as the translation sees it."""
    if not isinstance(kind, tuple):
        number = CompiledNumber(next(given), FLOAT)
        return number if kind == "float64" else translation.arithmetic.as_kind(number, BOOL if kind == "bool" else INT)
    element, dimensions = kind
    base = next(given)
    lengths = tuple(CompiledNumber(builder.sext(next(given), I64), INT) for _ in range(dimensions))
    return ArrayView(base, element, lengths, contiguous(translation.arithmetic, lengths))
