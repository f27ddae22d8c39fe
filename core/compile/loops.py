"""Loops of translated steps."""

from __future__ import annotations

import ast
from typing import Any

from llvmlite import ir

from core.compile.frames import LoopFrame, Masks, says
from core.compile.numbers import BOOL, I64, INT, CompiledNumber, Unsupported
from core.compile.statements import Statements


class Loops(Statements):
    """Translates loops; boards may leave one at different moments."""

    def _loop(self, node: ast.For | ast.While, again: Any, behind: Any, *, alike: bool) -> LoopFrame:
        """Return a loop; boards may leave it at different moments if it says so, or if it is not alike for them."""
        out = self.slot() if self.lanes and (not alike or says(node.body, ast.Break)) else None
        skipped = self.slot() if self.lanes and says(node.body, ast.Continue) else None
        return LoopFrame(again, behind, self.frame.branches, out, skipped)

    def _for(self, node: ast.For) -> None:
        first, last, by = self._bounds(node.iter)
        if node.orelse or not isinstance(node.target, ast.Name):
            raise Unsupported("a loop of this kind")
        first, last = self.arithmetic.as_kind(first, INT), self.arithmetic.as_kind(last, INT)
        if first.is_lanes or not isinstance(by, int):
            raise Unsupported("a loop that begins at different numbers")
        build, before = self.builder, (self.mask, self.frame.mask)
        with build.goto_entry_block():
            counter = build.alloca(I64)
        head, inside, step, behind = (build.append_basic_block() for _ in range(4))
        loop = self._loop(node, step, behind, alike=not last.is_lanes)
        build.store(first.value, counter)
        build.branch(head)
        build.position_at_end(head)
        at = CompiledNumber(build.load(counter), INT)
        goes_on = self.arithmetic.compare("<" if by > 0 else ">", at, last)
        build.cbranch(self.arithmetic.any(goes_on), inside, behind)
        build.position_at_end(inside)
        self._round(node, loop, before, goes_on, {node.target.id: at})
        build.position_at_end(step)
        build.store(build.add(build.load(counter), ir.Constant(I64, by)), counter)
        build.branch(head)
        build.position_at_end(behind)
        self.rejoin(before, [node] if says([node], ast.Return) else [])

    def _while(self, node: ast.While) -> None:
        if node.orelse:
            raise Unsupported("a loop of this kind")
        before = self.mask, self.frame.mask
        head, inside, behind = (self.builder.append_basic_block() for _ in range(3))
        loop = self._loop(node, head, behind, alike=False)
        self.builder.branch(head)
        self.builder.position_at_end(head)
        if loop.out is not None:
            self.leave_out(loop.out)
        if says(node.body, ast.Return) and self.frame.returned is not None:
            self.leave_out(self.frame.returned)
        goes_on = self.arithmetic.truth(self.value(node.test))
        if goes_on.is_lanes:
            goes_on = goes_on if self.mask is None else self.arithmetic.both(self.mask, goes_on)
        self.builder.cbranch(self.arithmetic.any(goes_on), inside, behind)
        self.builder.position_at_end(inside)
        if goes_on.is_lanes:
            assert loop.out is not None
            ended = self.arithmetic.opposite(goes_on)
            self.builder.store(self.builder.or_(self.builder.load(loop.out), ended.value), loop.out)
        self._round(node, loop, before, goes_on, {})
        self.builder.position_at_end(behind)
        self.rejoin(before, [node] if says([node], ast.Return) else [])

    def _round(
        self, node: ast.For | ast.While, loop: LoopFrame, before: Masks, goes_on: CompiledNumber, names: Any
    ) -> None:
        """Translate the body of a loop, for the boards that take another round."""
        frame = self.frame
        if loop.skipped is not None:
            self.builder.store(ir.Constant(self.arithmetic.type_of(BOOL, is_lanes=True), None), loop.skipped)
        self.mask, frame.mask = before
        if loop.out is not None:
            self.leave_out(loop.out)
        if frame.returned is not None and says(node.body, ast.Return):
            self.leave_out(frame.returned)
        if goes_on.is_lanes:
            self.mask, frame.mask = self.within(self.mask, goes_on), self.within(frame.mask, goes_on)
        frame.names |= names
        frame.loops.append(loop)
        frame.branches += goes_on.is_lanes
        loop.is_uneven = goes_on.is_lanes
        if not self.body(node.body):
            self.builder.branch(loop.again)
        frame.branches -= goes_on.is_lanes
        frame.loops.pop()
        for name in names:
            frame.names.pop(name, None)

    def _bounds(self, node: ast.expr) -> tuple[Any, Any, Any]:
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "range"):
            raise Unsupported("a loop over anything but a range")
        bounds = [self.value(argument) for argument in node.args]
        if len(bounds) == 1:
            bounds = [0, *bounds]
        first, last, *rest = bounds
        return first, last, rest[0] if rest else 1
