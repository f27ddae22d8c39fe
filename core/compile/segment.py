"""A segment: several steps of a tick as one function, which knows where their numbers and signals are.

A step by itself gets four addresses and reads from memory where its signals are. In a segment these places are
constants: nothing is looked up, a number that one step writes for the next may stay in a register, and neighbouring
numbers of several steps become vectors. Parameters are read from memory all the same, because they may change at any
tick; to know the choices among them as well gains nothing.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Iterable
from dataclasses import astuple, dataclass
from typing import Any

from llvmlite import ir

from core.compile.code import PLACES, POINTER, Block, Piece, begun, call_step, digest, hash_of, settled
from core.compile.frames import Kinds
from core.compile.machine import native
from core.compile.numbers import I64
from core.compile.translate import Translation
from core.kernel_cache import Content, get
from core.ports import TICK


@dataclass(frozen=True)
class SegmentStep:
    """A step in a segment.

    Attributes
    ----------
    block : type
        The block.
    every : int
        Ticks between two calls.
    p, s, io : int
        Where its parameters, its state and the places of its ports begin.
    ports : tuple
        The numbers of the ports that always have the same signal, each with the place of the signal.
    """

    block: Block
    every: int
    p: int
    s: int
    io: int
    ports: tuple[tuple[int, int], ...]


Segment = tuple[SegmentStep, ...]


def piece(segment: Segment) -> Piece:
    """Return the function of a segment; it takes pointers to all parameters, states, signals and places of a board."""
    own = inspect.getsource(sys.modules[__name__])

    def mark(content: Content) -> str:
        return digest(own, *((hash_of(step.block, content=content), *astuple(step)[1:]) for step in segment))

    return Piece("segment", mark, lambda: instructions(segment), loops=True, joins=True)


def code_of(segment: Segment) -> bytes:
    """Return the machine code of a segment, compiled here where no shelf has it."""
    return piece(segment).kept()


def kept_code_of(segment: Segment) -> bytes | None:
    """Return the machine code of a segment if a shelf has it."""
    return get(piece(segment).name_for(native()))


def instructions(segment: Segment) -> str:
    """Return the instructions of a segment."""
    kinds: list[Kinds] = [{} for _ in segment]
    return str(settled(lambda _: _written(segment, kinds)))


def _written(segment: Segment, kinds: Iterable[Kinds]) -> tuple[ir.Module, bool]:
    """Return the instructions as far as the kinds of variables are known, and whether that was enough."""
    module, builder, arrays = begun([POINTER, POINTER, POINTER, PLACES])
    start, is_complete = builder.append_basic_block("start"), True
    with builder.goto_block(start):
        tick = builder.fptosi(builder.load(_at(builder, arrays[2], TICK)), I64)
        for step, known in zip(segment, kinds, strict=True):
            translation = Translation(builder, known, 1, lanes=False)
            if step.every == 1:
                _call(translation, step, arrays)
            else:
                rest = builder.srem(tick, ir.Constant(I64, step.every))
                with builder.if_then(builder.icmp_signed("==", rest, ir.Constant(I64, 0))):
                    _call(translation, step, arrays)
            is_complete &= translation.is_complete
        builder.ret_void()
    builder.branch(start)
    return module, is_complete


def _call(translation: Translation, step: SegmentStep, arrays: tuple[Any, ...]) -> None:
    """Write the instructions of a step."""
    build, (p, s, w, io) = translation.builder, arrays
    own = _at(build, p, step.p), _at(build, s, step.s), w, _at(build, io, step.io)
    call_step(translation, step.block, *own, dict(step.ports))


def _at(builder: ir.IRBuilder, base: Any, place: int) -> Any:
    return builder.gep(base, [ir.Constant(I64, place)], inbounds=True)
