"""Steps behind fences: they run in plain Python on arrays that enforce the permitted access of the block."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from core.block import Block
from core.board import program
from core.board.board import Board
from core.board.spec import Spec
from core.board.wiring import Wiring, signal_name
from core.faults.fault import Fault
from core.plain import plain
from core.ports import TICK, TIME_MS

FENCED_EVERY = 3
"""Of so many ticks one runs behind fences, since they take long; the others are plain."""
ENTRY = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)


class Fence:
    """A part of an array that refuses to be touched where the block has no business."""

    __slots__ = ("array", "label", "readable", "start", "stop", "writable", "written")

    def __init__(self, label: str, array: np.ndarray, readable: set[int], writable: set[int]) -> None:
        self.label, self.array, self.readable, self.writable = label, array, readable, writable
        self.start, self.stop = 0, len(array)
        self.written: set[int] = set()

    def __len__(self) -> int:
        return self.stop - self.start

    def _part(self, part: slice) -> Fence:
        first, last, step = part.indices(self.stop - self.start)
        assert step == 1
        inner = Fence(self.label, self.array, self.readable, self.writable)
        inner.start, inner.stop, inner.written = self.start + first, self.start + last, self.written
        return inner

    def _place(self, index: Any, allowed: set[int], verb: str) -> int:
        if isinstance(index, bool) or not isinstance(index, int | np.integer):
            raise TypeError(f"{self.label}[{index!r}]: not an index")
        place = self.start + int(index)
        if not 0 <= int(index) < len(self) or place not in allowed:
            raise IndexError(f"{verb} {self.label}[{place}], allowed: {sorted(allowed)}")
        return place

    def __getitem__(self, index: Any) -> Any:
        if type(index) is int and 0 <= index < self.stop - self.start and self.start + index in self.readable:
            return self.array[self.start + index]  # the way of nearly all, without a call
        if isinstance(index, slice):
            return self._part(index)
        return self.array[self._place(index, self.readable, "reads")]

    def __setitem__(self, index: Any, value: Any) -> None:
        place = self._place(index, self.writable, "writes")
        self.written.add(place)
        self.array[place] = value


class FencedBoard(Board):
    """A board on which the steps of one block run in plain Python, behind fences, and all others are compiled."""

    def __init__(self, bench: Spec, entry: type[Block]) -> None:
        self.entry = entry
        self.unwritten: dict[str, set[int]] = {}
        super().__init__(bench, compiled=False)

    def link(self) -> None:
        """Bind the steps that run to their arrays."""
        super().link()
        fenced = [self.wiring.instances[row].block is self.entry for row in self.walk.running]
        self.walk.steps = [
            self._fenced(row) if own else _compiled(self.wiring, row)
            for row, own in zip(self.walk.running, fenced, strict=True)
        ]

    def _fenced(self, row: int) -> Callable[[], None]:
        wiring, instance = self.wiring, self.wiring.instances[row]
        block, io = instance.block, wiring.ports(row)
        readable, writable = permitted(wiring, row)
        p, s = wiring.packed(row), wiring.state_of(instance.key)
        w = Fence("w", wiring.w, readable, writable)
        whole = set(range(max(len(p), len(s), len(io))))
        arguments = (
            block.Packed(Fence("p", p, whole, set())),
            block.State(Fence("s", s, whole, whole)),
            block.Ports(w, Fence("io", io, whole, set())),
        )
        missing, unfenced = self.unwritten.setdefault(instance.key, own_of(wiring, row)), wiring.bound(row)

        def step() -> None:
            if wiring.w[TICK] % FENCED_EVERY:
                return unfenced()
            try:
                plain(block.step)(*arguments)
            except (IndexError, TypeError) as error:
                raise AssertionError(f"{instance.key} at tick {int(wiring.w[TICK])}: {error}") from None
            return missing.difference_update(w.written)

        return step


def permitted(wiring: Wiring, row: int) -> tuple[set[int], set[int]]:
    """Return the places among all signals that the step of a row may read, and those that it may write."""
    instance, io = wiring.instances[row], wiring.ports(row)
    names: dict[int, str] = {}
    for name, place in wiring.index.items():  # of a vector and its first component, the vector
        if place not in names or len(name) < len(names[place]):
            names[place] = name
    inputs = _places(wiring, {names[int(place)] for place in io[: len(instance.block.inputs)]})
    own = own_of(wiring, row)
    return {TICK, TIME_MS} | own | inputs, own | (inputs if issubclass(instance.block, Fault) else set())


def own_of(wiring: Wiring, row: int) -> set[int]:
    """Return the places of the outputs and taps of a row."""
    instance = wiring.instances[row]
    outputs = {signal_name(instance, port.name) for port in (*instance.block.outputs, *instance.block.taps)}
    assert len(wiring.ports(row)) == len(instance.block.inputs) + len(outputs), instance.key
    return _places(wiring, outputs)


def _places(wiring: Wiring, names: set[str]) -> set[int]:
    parts = tuple(f"{name}." for name in names)
    return {place for signal, place in wiring.index.items() if signal in names or signal.startswith(parts)}


def _compiled(wiring: Wiring, row: int) -> Callable[[], None]:
    function = ENTRY(program.address(wiring.instances[row].block))
    p, s, io = wiring.packed(row), wiring.state_of(wiring.instances[row].key), wiring.ports(row)
    pointers = tuple(array.ctypes.data for array in (p, s, wiring.w, io))
    return lambda: function(*pointers)
