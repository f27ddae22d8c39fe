"""Statements of translated steps."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from typing import Any

from core.compile.arrays import ArrayPlace, ArrayView
from core.compile.expressions import Expressions
from core.compile.frames import returns, tree_of
from core.compile.numbers import BOOL, CompiledNumber, Unsupported, is_number
from core.compile.places import Place, PortsView, RecordsView, RecordView, VectorView
from core.record import SCALAR

SMALL = 12
"""Nodes of a branch that costs less than to look whether it is taken."""


class Statements(Expressions):
    """Translates assignments, conditions and returns."""

    def body(self, statements: Sequence[ast.stmt]) -> bool:
        """Translate statements; say whether the code never gets behind them."""
        return any(self.statement(statement) for statement in statements)

    def statement(self, node: ast.stmt) -> bool:
        """Translate a statement; say whether the code never gets behind it."""
        with self.told(node):
            return self._statement(node)

    def _statement(self, node: ast.stmt) -> bool:
        if isinstance(node, ast.Assign):
            value = self.value(node.value)
            for target in node.targets:
                self.store(target, value)
        elif isinstance(node, ast.AnnAssign):
            if node.value is not None:
                self.store(node.target, self.value(node.value))
        elif isinstance(node, ast.AugAssign):
            self._augment(node)
        elif isinstance(node, ast.Expr):
            if not isinstance(node.value, ast.Constant):
                self.value(node.value)
        elif isinstance(node, ast.If):
            return self._if(node)
        elif isinstance(node, ast.For):
            self._for(node)
        elif isinstance(node, ast.While):
            self._while(node)
        elif isinstance(node, ast.Return):
            return self._return(node)
        elif isinstance(node, ast.Break | ast.Continue):
            return self._leave(node)
        elif not isinstance(node, ast.Pass):
            raise Unsupported(f"a statement {type(node).__name__}")
        return False

    def store(self, target: ast.expr, value: Any) -> None:
        """Write a value to the target of an assignment."""
        if isinstance(target, ast.Name):
            self.assign(target.id, value)
        elif isinstance(target, ast.Tuple):
            if not isinstance(value, tuple) or len(value) != len(target.elts):
                raise Unsupported("an assignment of several values")
            # all values are known before the first is written
            for part, single in zip(target.elts, value, strict=True):
                self.store(part, single)
        else:
            self._write(self._place(target), value)

    def _write(self, place: Any, value: Any) -> None:
        if isinstance(place, RecordView):
            if not isinstance(value, RecordView) or place.layout is None:
                raise Unsupported("a record can only be another's copy")
            for i in range(place.layout.size):
                source = self.memory.read(Place(*self.memory.moved(value, i)), self.mask)
                self.memory.write(Place(*self.memory.moved(place, i)), source, self.mask)
        elif isinstance(place, ArrayView):
            self.arrays.fill(place, value)
        elif isinstance(place, ArrayPlace):
            self.arrays.write(place, value)
        elif isinstance(place, Place):
            self.memory.write(place, value, self.mask)
        else:
            raise Unsupported("an assignment to this")

    def _augment(self, node: ast.AugAssign) -> None:
        if isinstance(node.target, ast.Name):
            before = self.name(node.target.id)
            self.assign(node.target.id, self.arithmetic.binary(type(node.op), before, self.value(node.value)))
            return
        place = self._place(node.target)
        if isinstance(place, ArrayView):
            raise Unsupported("arithmetic on an array")
        before = self.arrays.read(place) if isinstance(place, ArrayPlace) else self.memory.read(place, self.mask)
        self._write(place, self.arithmetic.binary(type(node.op), before, self.value(node.value)))

    def _place(self, node: ast.expr) -> Any:
        """Return the place of a number that is written."""
        if isinstance(node, ast.Attribute):
            owner = self.value(node.value)
            if isinstance(owner, PortsView):
                place, seen = self.memory.port(owner, node.attr)
                if seen is False:
                    return place
            elif isinstance(owner, RecordView):
                found, place = self.memory.field(owner, node.attr)
                if found.kind == SCALAR and not found.is_choice:
                    return place
                if found.inner is not None:
                    return self.memory.attribute(owner, node.attr, self.mask)
        elif isinstance(node, ast.Subscript):
            owner = self.value(node.value)
            index = self.value(node.slice)
            if isinstance(owner, ArrayView):
                return self.arrays.part(owner, index if isinstance(index, tuple) else (index,))
            if isinstance(owner, VectorView | RecordsView):
                return self.memory.item(owner, index)
        raise Unsupported(f"an assignment to {ast.unparse(node)}")

    def _if(self, node: ast.If) -> bool:
        condition = self.value(node.test)
        if not isinstance(condition, CompiledNumber):
            return self.body(node.body if condition else node.orelse)
        condition = self.arithmetic.truth(condition)
        if condition.is_lanes:
            self._masked(condition, node.body)
            if node.orelse:
                self._masked(self.arithmetic.opposite(condition), node.orelse)
            return False
        before = self.mask, self.frame.mask
        yes, no, behind = (self.builder.append_basic_block() for _ in range(3))
        self.builder.cbranch(condition.value, yes, no)
        ends = []
        for block, statements in ((yes, node.body), (no, node.orelse)):
            self.builder.position_at_end(block)
            self.mask, self.frame.mask = before
            ends.append(self.body(statements))
            if not ends[-1]:
                self.builder.branch(behind)
        self.builder.position_at_end(behind)
        if all(ends):
            self.builder.unreachable()
            return True
        self.rejoin(before, [node])
        return False

    def _masked(self, condition: CompiledNumber, statements: Sequence[ast.stmt]) -> None:
        """Translate statements for the boards for which a condition holds."""
        frame, before = self.frame, (self.mask, self.frame.mask)
        self.mask, frame.mask = self.within(self.mask, condition), self.within(frame.mask, condition)
        behind = None
        if sum(1 for statement in statements for _ in ast.walk(statement)) > SMALL:
            inside, behind = self.builder.append_basic_block(), self.builder.append_basic_block()
            self.builder.cbranch(self.arithmetic.any(self.mask), inside, behind)
            self.builder.position_at_end(inside)
        frame.branches += 1
        self.body(statements)
        frame.branches -= 1
        if behind is not None:
            self.builder.branch(behind)
            self.builder.position_at_end(behind)
        self.rejoin(before, statements)

    def _leave(self, node: ast.stmt) -> bool:
        loop = self.frame.loops[-1]
        if self.frame.branches == loop.branches and not loop.is_uneven:
            self.builder.branch(loop.again if isinstance(node, ast.Continue) else loop.behind)
            return True
        slot, mask = loop.skipped if isinstance(node, ast.Continue) else loop.out, self.frame.mask
        assert slot is not None and mask is not None
        self.builder.store(self.builder.or_(self.builder.load(slot), self.arithmetic.spread(mask).value), slot)
        return False

    def _return(self, node: ast.Return) -> bool:
        frame = self.frame
        value = self.value(node.value) if node.value is not None else None
        if returns(tree_of(frame.function)) == 1 and frame.branches == 0 and not frame.loops:
            frame.result = (value,)
        elif isinstance(value, tuple):
            frame.result = len(value)
            for i, part in enumerate(value):
                self.assign(f"return {i}", part)
        elif is_number(value):
            frame.result = "one"
            self.assign("return", value)
        elif value is not None:
            raise Unsupported("a return of anything but numbers")
        if frame.branches == 0:
            self.builder.branch(frame.exit)
            return True
        if frame.returned is None:  # known at the next translation
            self.kinds[f"{frame.path}:returned"] = BOOL, True
            self.is_complete = False
            return False
        assert frame.mask is not None
        gone = self.builder.or_(self.builder.load(frame.returned), frame.mask.value)
        self.builder.store(gone, frame.returned)
        return False

    def _for(self, node: ast.For) -> None:
        raise NotImplementedError

    def _while(self, node: ast.While) -> None:
        raise NotImplementedError
