"""Arrays of one and two dimensions and more: views with lengths and strides; their parts are views again.

Indices are not checked. Only a constant index below 0 counts from the end.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from llvmlite import ir

from core.compile.numbers import BOOL, DOUBLE, FLOAT, I64, INT, UINT, Arithmetic, CompiledNumber, Unsupported

SINGLE, BYTE = ir.FloatType(), ir.IntType(8)
ELEMENTS: dict[str, tuple[Any, int]] = {
    "float64": (DOUBLE, FLOAT),
    "float32": (SINGLE, FLOAT),
    "int64": (I64, INT),
    "uint64": (I64, UINT),
    "bool": (BYTE, BOOL),
}
"""Of every kind of element how it is stored, and the kind of number that it is."""


@dataclass(frozen=True)
class ArrayView:
    """An array: where it begins, its elements, its lengths, and how many elements each index moves by."""

    base: Any
    element: str
    lengths: tuple[Any, ...]
    strides: tuple[Any, ...]


@dataclass(frozen=True)
class Bound:
    """``view`` of an array, to be called."""

    view: ArrayView


@dataclass(frozen=True)
class ArrayPlace:
    """An element."""

    at: Any
    element: str


class Arrays:
    """Writes instructions that read and write arrays."""

    def __init__(self, arithmetic: Arithmetic) -> None:
        self._arithmetic, self._build = arithmetic, arithmetic.builder

    def whole(self, value: Any) -> Any:
        """Return a whole number for an instruction."""
        number = self._arithmetic.number(value)
        if number.is_lanes or number.kind == FLOAT:
            raise Unsupported("an index that is no whole number of all boards")
        return self._arithmetic.as_kind(number, INT).value

    def part(self, view: ArrayView, indices: Sequence[Any]) -> ArrayView | ArrayPlace:
        """Return an element, or a view of the elements that indices and slices leave."""
        if len(indices) > len(view.lengths):
            raise Unsupported("more indices than dimensions")
        a, offset, lengths, strides = self._arithmetic, None, [], []
        for i, (length, stride) in enumerate(zip(view.lengths, view.strides, strict=True)):
            index = indices[i] if i < len(indices) else slice(None)
            first = self._from_end(index.start if isinstance(index, slice) else index, length)
            if isinstance(index, slice):
                end = length if index.stop is None else self._from_end(index.stop, length)
                lengths.append(end if first is None else a.binary(ast.Sub, end, first))
                strides.append(stride)
            if first is not None:
                moved = a.times(first, stride)
                offset = moved if offset is None else a.plus(offset, moved)
        at = view.base if offset is None else self._build.gep(view.base, [self.whole(offset)], inbounds=True)
        if not lengths:
            return ArrayPlace(at, view.element)
        return ArrayView(at, view.element, tuple(lengths), tuple(strides))

    def _from_end(self, index: Any, length: Any) -> Any:
        if isinstance(index, int) and index < 0:
            return self._arithmetic.plus(length, index)
        return index

    def read(self, place: ArrayPlace) -> CompiledNumber:
        """Return an element."""
        kind, value = ELEMENTS[place.element][1], self._build.load(place.at)
        if place.element == "float32":
            value = self._build.fpext(value, DOUBLE)
        elif kind == BOOL:
            value = self._build.trunc(value, ir.IntType(1))
        return CompiledNumber(value, kind)

    def write(self, place: ArrayPlace, value: Any) -> None:
        """Write an element."""
        number = self._arithmetic.as_kind(value, ELEMENTS[place.element][1]).value
        if place.element == "float32":
            number = self._build.fptrunc(number, SINGLE)
        elif place.element == "bool":
            number = self._build.zext(number, BYTE)
        self._build.store(number, place.at)

    def fill(self, view: ArrayView, value: Any) -> None:
        """Write a number to all elements, or the elements of another array of the same lengths."""
        with counted(self._build, self.whole(view.lengths[0])) as k:
            index = CompiledNumber(k, INT)
            target = self.part(view, [index])
            source = self.part(value, [index]) if isinstance(value, ArrayView) else value
            if isinstance(target, ArrayView):
                self.fill(target, source)
            else:
                self.write(target, self.read(source) if isinstance(source, ArrayPlace) else source)

    def scratch(self, lengths: Any, element: str, zero: bool) -> ArrayView:
        """Return an array of known lengths, which lives until the function returns."""
        lengths = lengths if isinstance(lengths, tuple) else (lengths,)
        if not all(isinstance(length, int) for length in lengths):
            raise Unsupported("an array whose length is not known", hint="let the caller give it")
        kind, numbers = ELEMENTS[element][0], math.prod(lengths)
        with self._build.goto_entry_block():
            room = self._build.alloca(ir.ArrayType(kind, numbers))
            room.align = 64
            base = self._build.gep(room, [ir.Constant(I64, 0)] * 2)
        view = ArrayView(base, element, lengths, contiguous(self._arithmetic, lengths))
        if zero:
            self.fill(view, 0)
        return view

    def viewed(self, view: ArrayView, element: str) -> ArrayView:
        """Return the same bits as elements of another kind of 64 bits."""
        base = self._build.bitcast(view.base, ELEMENTS[element][0].as_pointer())
        return ArrayView(base, element, view.lengths, view.strides)


def contiguous(arithmetic: Arithmetic, lengths: Sequence[Any]) -> tuple[Any, ...]:
    """Return the strides of an array without gaps."""
    strides: list[Any] = [1]
    for length in reversed(lengths[1:]):
        strides.insert(0, arithmetic.times(length, strides[0]))
    return tuple(strides)


@contextmanager
def counted(builder: ir.IRBuilder, count: Any, step: int = 1) -> Iterator[Any]:
    """Repeat the instructions that are written inside for 0, step, ... below a count."""
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
