"""The way through the wall: a C function with the arguments of any step, which lets WebAssembly compute in copies.

It copies the inputs of the step into the memory of an instance, calls the step, and copies back the numbers that the
step may write, as many as the bench has. A call that fails puts out NaN and leaves the state; the guard trips when NaN
reaches the drive. Boards of one structure side by side are computed one after another.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir

from core.compile.arrays import counted
from core.compile.code import PLACES, POINTER, begun
from core.compile.machine import compiled, loaded
from core.compile.numbers import DOUBLE, I64
from core.ports import RESERVED
from core.wall.host import FUEL, WalledInstance, function_address

BUSY, CONTEXT, MEMORY, FUNCTION, STACK = range(5)
"""Columns of the table of instances: whether one is in use, its store, its memory, its step, the place of its stack."""


class PortSignal(NamedTuple):
    """The signal behind a port: its name, its length, and whether the step may write it."""

    signal: str
    size: int
    is_written: bool


class Sizes(NamedTuple):
    """How many numbers a step sees on a bench: parameters, state, behind each port."""

    parameters: int
    state: int
    ports: tuple[PortSignal, ...]

    @property
    def signals(self) -> int:
        """How many signals it sees at most."""
        return RESERVED + sum(port.size for port in self.ports)

    @property
    def total(self) -> int:
        """All numbers it needs in memory, the places of its ports included."""
        return self.parameters + self.state + self.signals + len(self.ports)

    def offsets(self, room: int) -> list[int]:
        """Return the addresses of parameters, state, signals and places in memory."""
        numbers = 0, self.parameters, self.state, self.signals
        return [room + 8 * sum(numbers[: i + 1]) for i in range(len(numbers))]

    def places(self) -> list[int]:
        """Return the place of each port among the signals in memory; ports of one signal have one place."""
        found: dict[str, int] = {}
        at = RESERVED
        for port in self.ports:
            if port.signal not in found:
                found[port.signal], at = at, at + port.size
        return [found[port.signal] for port in self.ports]


class Crossing:
    """A way to the instances of one step; each call takes a free instance.

    Parameters
    ----------
    instances : sequence of Instance
        Alike.
    sizes : Sizes
        Of the bench.
    width : int
        Boards side by side.
    """

    def __init__(self, instances: Sequence[WalledInstance], sizes: Sizes, width: int) -> None:
        self._sizes, self._width, self._instances = sizes, width, instances
        self._room, self._top = instances[0].room, instances[0].stack_top
        self._cells = np.array([[0, a.context, a.memory, a.function, a.stack] for a in instances], dtype=np.int64)
        *_, io = sizes.offsets(self._room)
        places = np.array(sizes.places(), dtype=np.int64)
        for one in instances:
            ctypes.memmove(one.memory + io, places.ctypes.data, places.nbytes)
        self.address = loaded(compiled(self._instructions()))
        """Of the C function."""

    def _instructions(self) -> str:
        """Return the instructions of the C function; addresses of this process are among them."""
        module, builder, (p, s, w, io) = begun([POINTER, POINTER, POINTER, PLACES])
        start = builder.append_basic_block("start")
        arguments = builder.alloca(ir.ArrayType(I64, 2 * 4))  # each of 16 bytes
        trap, value = builder.alloca(I64), builder.alloca(ir.ArrayType(I64, 4))
        self._builder, self._io = builder, io
        with builder.goto_block(start):
            cell = self._taken()
            with counted(builder, _integer(self._width)) as k:
                self._across([builder.gep(one, [k]) for one in (p, s, w)], cell, arguments, trap, value)
            busy = self._at(cell, BUSY)
            builder.store_atomic(_integer(0), busy, "release", 8)
            builder.ret_void()
        builder.branch(start)
        return str(module)

    def _taken(self) -> Any:
        """Take an instance that is free, and return the address of its row; wait where all are in use."""
        builder = self._builder
        first, again, mine = builder.block, builder.append_basic_block("again"), builder.append_basic_block("mine")
        builder.branch(again)
        builder.position_at_end(again)
        row = builder.phi(I64)
        row.add_incoming(_integer(0), first)
        rows, columns = self._cells.shape
        cell = builder.add(_integer(self._cells.ctypes.data), builder.mul(row, _integer(8 * columns)))
        took = builder.cmpxchg(self._at(cell, BUSY), _integer(0), _integer(1), "acquire")
        after = builder.urem(builder.add(row, _integer(1)), _integer(rows))
        row.add_incoming(after, again)
        builder.cbranch(builder.extract_value(took, 1), mine, again)
        builder.position_at_end(mine)
        return cell

    def _across(self, numbers: list[Any], cell: Any, arguments: Any, trap: Any, value: Any) -> None:
        """Compute a sample of one board."""
        builder, sizes = self._builder, self._sizes
        p, s, w = numbers
        memory = builder.load(self._at(cell, MEMORY))
        offsets = sizes.offsets(self._room)
        parameters, state, signals = (
            builder.inttoptr(builder.add(memory, _integer(at)), POINTER) for at in offsets[:3]
        )
        self._copy(p, parameters, sizes.parameters, out=False)
        self._copy(s, state, sizes.state, out=False)
        self._copy(w, signals, RESERVED, out=False)
        ports = [
            (self._behind(w, port), builder.gep(signals, [_integer(at)])) for port, at in enumerate(sizes.places())
        ]
        for (outside, inside), port in zip(ports, sizes.ports, strict=True):
            self._copy(outside, inside, port.size, out=False)
        for i, at in enumerate(offsets):
            builder.store(_integer(at), builder.gep(arguments, [_integer(0), _integer(2 * i)]))
        builder.store(_integer(0), trap)
        context = builder.load(self._at(cell, CONTEXT))
        self._call("wasmtime_context_set_fuel", context, _integer(FUEL))
        told = context, builder.load(self._at(cell, FUNCTION)), arguments, _integer(len(offsets)), trap
        error = self._call("wasmtime_func_call_unchecked", *told)
        trapped = builder.load(trap)
        is_right = builder.icmp_signed("==", builder.or_(error, trapped), _integer(0))
        written = [(both, port.size) for both, port in zip(ports, sizes.ports, strict=True) if port.is_written]
        with builder.if_else(is_right, likely=True) as (right, wrong):
            with right:
                self._copy(s, state, sizes.state, out=True)
                for (outside, inside), size in written:
                    self._copy(outside, inside, size, out=True)
            with wrong:
                for (outside, _), size in written:
                    with counted(builder, _integer(size * self._width), self._width) as i:
                        builder.store(ir.Constant(DOUBLE, math.nan), builder.gep(outside, [i]))
                self._drop("wasm_trap_delete", trapped)
                self._drop("wasmtime_error_delete", error)
                self._lift_stack(context, cell, value)

    def _lift_stack(self, context: Any, cell: Any, value: Any) -> None:
        """Put the stack of an instance back: a call that failed has left it where it was."""
        for i, word in enumerate((0, self._top)):  # a value: its kind, which is 0 for i32, and the number
            self._builder.store(_integer(word), self._builder.gep(value, [_integer(0), _integer(i)]))
        place = self._builder.load(self._at(cell, STACK))
        self._drop("wasmtime_error_delete", self._call("wasmtime_global_set", context, place, value))

    def _drop(self, name: str, made: Any) -> None:
        """Delete the object that a call has made, if there is one."""
        with self._builder.if_then(self._builder.icmp_signed("!=", made, _integer(0))):
            self._call(name, made)

    def _copy(self, outside: Any, inside: Any, size: int, *, out: bool) -> None:
        """Copy numbers of a board in or out; they may be interleaved with the numbers of other boards."""
        with counted(self._builder, _integer(size)) as i:
            far = self._builder.gep(outside, [self._builder.mul(i, _integer(self._width))])
            near = self._builder.gep(inside, [i])
            source, target = (near, far) if out else (far, near)
            self._builder.store(self._builder.load(source), target)

    def _behind(self, w: Any, port: int) -> Any:
        """Return the address of the signal behind a port of the bench."""
        place = self._builder.load(self._builder.gep(self._io, [_integer(port)]))
        return self._builder.gep(w, [self._builder.mul(place, _integer(self._width))])

    def _at(self, cell: Any, column: int) -> Any:
        """Return the address of a column of a row of the table of instances."""
        return self._builder.inttoptr(self._builder.add(cell, _integer(8 * column)), I64.as_pointer())

    def _call(self, name: str, *arguments: Any) -> Any:
        """Call a function of the machine; all it takes and gives are 64 bits."""
        kind = ir.FunctionType(I64, [one.type for one in arguments])
        where = self._builder.inttoptr(_integer(function_address(name)), kind.as_pointer())
        return self._builder.call(where, arguments)


def _integer(value: int) -> Any:
    return ir.Constant(I64, value)
