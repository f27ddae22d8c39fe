"""Steps behind fences: each runs in plain Python on arrays that know what the block may touch."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from typing import Any

import numpy as np

from core.block import Block
from core.board import program
from core.board.instances import Instance
from core.board.spec import Spec
from core.board.wiring import Wiring, signal_name
from core.faults.fault import Fault
from core.plain import plain
from core.ports import TICK, TIME_MS

ENTRY = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)


class Fence:
    """A part of an array that refuses to be touched where the block has no business."""

    def __init__(self, label: str, array: np.ndarray, readable: set[int], writable: set[int]) -> None:
        self.label, self.array, self.readable, self.writable = label, array, readable, writable
        self.start, self.stop = 0, len(array)
        self.written: set[int] = set()

    def __len__(self) -> int:
        return self.stop - self.start

    def _part(self, part: slice) -> Fence:
        first, last, step = part.indices(len(self))
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
        if isinstance(index, slice):
            return self._part(index)
        return self.array[self._place(index, self.readable, "reads")]

    def __setitem__(self, index: Any, value: Any) -> None:
        place = self._place(index, self.writable, "writes")
        self.written.add(place)
        self.array[place] = value


class Fenced:
    """One block of a wiring, run behind fences."""

    def __init__(self, wiring: Wiring, row: int, names: dict[int, str]) -> None:
        self.instance, self.names = wiring.instances[row], names
        block, io = self.instance.block, wiring.ports(row)
        p, s = wiring.packed(row), wiring.state_of(self.instance.key)
        inputs = {names[int(place)] for place in io[: len(block.inputs)]}
        outputs = {signal_name(self.instance, port.name) for port in (*block.outputs, *block.taps)}
        assert len(io) == len(block.inputs) + len(outputs), self.instance.key
        self.outputs = _places(wiring, outputs)
        readable = {TICK, TIME_MS} | self.outputs | _places(wiring, inputs)
        writable = self.outputs | (_places(wiring, inputs) if issubclass(block, Fault) else set())
        self.w = Fence("w", wiring.w, readable, writable)
        arguments = (
            block.Packed(Fence("p", p, set(range(len(p))), set())),
            block.State(Fence("s", s, set(range(len(s))), set(range(len(s))))),
            block.Ports(self.w, Fence("io", io, set(range(len(io))), set())),
        )
        self._run = lambda: plain(block.step)(*arguments)

    def run(self, tick: int) -> None:
        try:
            self._run()
        except (IndexError, TypeError) as error:
            raise AssertionError(f"{self.instance.key} at tick {tick}: {error}") from None

    def never_written(self) -> list[str]:
        return [self.names[place] for place in self.outputs - self.w.written]


@np.errstate(all="ignore")  # numbers overflow as quietly as in compiled code
def run_behind_fences(spec: Spec, wiring: Wiring, entry: type[Block], ticks: int) -> None:
    """Run a bench with the steps of one block behind fences and all others compiled."""
    names: dict[int, str] = {}
    for name, place in wiring.index.items():
        # of a vector and its first component, the vector
        if place not in names or len(name) < len(names[place]):
            names[place] = name
    fenced = {row: Fenced(wiring, row, names) for row, _ in _rows_of(wiring, entry)}
    assert fenced, f"{entry.family}/{entry.name} is not on the bench"
    compiled = {row: _bound(wiring, row) for row in range(len(wiring.instances)) if row not in fenced}
    for tick in range(ticks):
        wiring.w[TICK], wiring.w[TIME_MS] = tick, tick * spec.dt_ms
        for row, instance in enumerate(wiring.instances):
            if tick % instance.every == 0:
                if row in fenced:
                    fenced[row].run(tick)
                else:
                    compiled[row]()
    for row in fenced.values():
        assert not row.never_written(), row.instance.key


def _rows_of(wiring: Wiring, entry: type[Block]) -> Iterator[tuple[int, Instance]]:
    return ((row, instance) for row, instance in enumerate(wiring.instances) if instance.block is entry)


def _places(wiring: Wiring, names: set[str]) -> set[int]:
    return {
        place
        for signal, place in wiring.index.items()
        if any(signal == name or signal.startswith(f"{name}.") for name in names)
    }


def _bound(wiring: Wiring, row: int) -> Any:
    function = ENTRY(program.address(wiring.instances[row].block))
    p, s, io = wiring.packed(row), wiring.state_of(wiring.instances[row].key), wiring.ports(row)
    pointers = tuple(array.ctypes.data for array in (p, s, wiring.w, io))
    return lambda: function(*pointers)
