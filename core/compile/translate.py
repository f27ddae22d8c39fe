"""Translates steps and the helpers they call into instructions, for one board or for boards side by side.

Of Python it knows the notation of steps: assignments, ``if``, loops, ``return``, arithmetic, and calls of other
such functions, which become part of the step. In a condition in which boards differ both branches are translated, each
under a mask of the boards that take it; a branch that no board takes is skipped.
"""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from types import FunctionType
from typing import Any

import numpy as np

from core.compile.arrays import Bound
from core.compile.frames import CallFrame, stored, tree_of
from core.compile.functions import FUNCTIONS
from core.compile.loops import Loops
from core.compile.numbers import Unsupported, is_number

DEEPEST = 40
"""Calls within calls."""


class Translation(Loops):
    """One translation of a step."""

    def call(self, function: Any, arguments: Sequence[Any], named: dict[str, Any] | None = None) -> Any:
        """Translate a call of a function; its statements become part of the code."""
        function = getattr(function, "py_func", function)
        if function in FUNCTIONS:
            return FUNCTIONS[function](self.arithmetic, *arguments, **(named or {}))
        if isinstance(function, Bound):
            return self.arrays.viewed(function.view, np.dtype(*arguments).name)
        if not isinstance(function, FunctionType) or self._depth > DEEPEST:
            raise Unsupported(f"a call of {function}")
        tree = tree_of(function)
        bound = inspect.signature(function).bind(*arguments, **(named or {}))
        bound.apply_defaults()
        outer = getattr(self, "frame", None)
        path = ""
        if outer is not None:
            outer.calls += 1
            path = f"{outer.path}.{outer.calls}"
        frame = CallFrame(function, path, {}, self.builder.append_basic_block(f"exit{path}"))
        mask, self.frame, self._depth = self.mask, frame, self._depth + 1
        if f"{path}:returned" in self.kinds:
            frame.returned = self.slot()
        own = stored(tree)
        for name, value in bound.arguments.items():
            if name in own and is_number(value):
                self.assign(name, value)
            else:
                frame.names[name] = value
        ended = self.body(tree.body)
        if not ended:
            self.builder.branch(frame.exit)
        self.builder.position_at_end(frame.exit)
        result = self._result(frame)
        self._depth, self.mask = self._depth - 1, mask
        if outer is not None:
            self.frame = outer
        return result

    def _result(self, frame: CallFrame) -> Any:
        if isinstance(frame.result, int):
            return tuple(self.name(f"return {i}") for i in range(frame.result))
        if frame.result == "one":
            return self.name("return")
        return frame.result[0] if frame.result else None
