"""Variables of translated steps, and the masks under which they are written."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Sequence
from typing import Any

from llvmlite import ir

from core.compile.arrays import Arrays
from core.compile.frames import CallFrame, Kinds, Masks, says
from core.compile.numbers import BOOL, Arithmetic, CompiledNumber, Unsupported, is_number
from core.compile.places import Memory


class Variables:
    """Names and their values, and the boards for which the code runs at this point.

    Parameters
    ----------
    builder : ir.IRBuilder
        Where the instructions go.
    kinds : dict
        The kind of each variable that earlier translations have found; ``is_complete`` tells whether all are known.
    width : int
        Boards side by side.
    lanes : bool
        Whether for all of them at once; else for one of them.
    """

    def __init__(self, builder: ir.IRBuilder, kinds: Kinds, width: int, *, lanes: bool) -> None:
        self.builder, self.kinds, self.lanes = builder, kinds, lanes
        self.is_complete = True
        self.arithmetic = Arithmetic(builder, width)
        self.memory = Memory(self.arithmetic, lanes=lanes)
        self.arrays = Arrays(self.arithmetic)
        self.mask: CompiledNumber | None = None
        self.frame: CallFrame
        self._depth = 0

    def assign(self, name: str, value: Any) -> None:
        """Bind a name; a number goes into a variable."""
        frame = self.frame
        if not is_number(value):
            frame.names[name] = value
            return
        number = self.arithmetic.number(value)
        path = f"{frame.path}:{name}"
        kind, is_lanes = self.kinds.get(path, (number.kind, False))
        wider = max(kind, number.kind), is_lanes or number.is_lanes or (frame.mask is not None and self.lanes)
        if self.kinds.get(path) != wider:
            self.is_complete = self.is_complete and path not in self.kinds
            self.kinds[path] = wider
        kind, is_lanes = wider
        number = self.arithmetic.as_kind(number, kind)
        number = self.arithmetic.spread(number) if is_lanes else number
        slot = frame.variables.get(name)
        if slot is None or slot.type.pointee != self.arithmetic.type_of(kind, is_lanes=is_lanes):
            with self.builder.goto_entry_block():
                slot = self.builder.alloca(self.arithmetic.type_of(kind, is_lanes=is_lanes))
            frame.variables[name] = slot
        frame.names.pop(name, None)
        value = number.value
        if frame.mask is not None and is_lanes:
            value = self.builder.select(frame.mask.value, value, self.builder.load(slot))
        self.builder.store(value, slot)

    def name(self, name: str) -> Any:
        """Return the value or the object of a name."""
        frame = self.frame
        if name in frame.names:
            return frame.names[name]
        if name in frame.variables:
            return CompiledNumber(self.builder.load(frame.variables[name]), self.kinds[f"{frame.path}:{name}"][0])
        function = frame.function
        free = dict(zip(function.__code__.co_freevars, function.__closure__ or (), strict=True))
        if name in free:
            return free[name].cell_contents
        if name in function.__globals__:
            return function.__globals__[name]
        if hasattr(builtins, name):
            return getattr(builtins, name)
        raise Unsupported(f"{name} is not known at this place")

    def within(self, mask: CompiledNumber | None, condition: CompiledNumber) -> CompiledNumber:
        """Return the mask of the boards in another for which a condition holds."""
        return condition if mask is None else self.arithmetic.both(mask, condition)

    def rejoin(self, before: Masks, statements: Sequence[ast.stmt]) -> None:
        """Go on under the masks of before, without the boards that have left meanwhile."""
        self.mask, self.frame.mask = before
        gone = [self.frame.returned] if says(statements, ast.Return) else []
        if self.frame.loops:
            loop = self.frame.loops[-1]
            gone += [loop.out] if says(statements, ast.Break) else []
            gone += [loop.skipped] if says(statements, ast.Continue) else []
        for slot in gone:
            if slot is not None:
                self.leave_out(slot)

    def leave_out(self, slot: Any) -> None:
        """Take the boards that have left out of the masks."""
        left = self.arithmetic.opposite(CompiledNumber(self.builder.load(slot), BOOL))
        self.mask, self.frame.mask = self.within(self.mask, left), self.within(self.frame.mask, left)

    def slot(self, value: Any = None) -> Any:
        """Return a variable with true or false for each board, false at first."""
        nobody = ir.Constant(self.arithmetic.type_of(BOOL, is_lanes=True), None)
        with self.builder.goto_entry_block():
            slot = self.builder.alloca(nobody.type)
        self.builder.store(nobody if value is None else value, slot)
        return slot
