"""C of the instructions that the compiler writes of a step.

The C is written before any optimisation: the steps are read once, by `core.compile`, and two compilers make machine
code of them. Each instruction becomes one statement, each block a label, each variable a variable. Numbers that are
known beforehand, such as the places of ports, become constants.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from llvmlite import ir

from scenarios.speed.anchor.expressions import TYPES, expression, literal

Known = Mapping[tuple[str, int], float]
"""Numbers in memory that never change, by the argument that points to them and the place behind it."""

HEAD = """
#include <math.h>
#include <stdint.h>
#include <string.h>
/* 0, but gcc does not know: it would skip the whole number on the way from -0.5 to 0, and give -0. */
int64_t nothing;
static inline int64_t bits_of(double number) { int64_t bits; memcpy(&bits, &number, 8); return bits; }
static inline double number_of(int64_t bits) { double number; memcpy(&number, &bits, 8); return number; }
"""


class Writer:
    """Writes one function.

    Parameters
    ----------
    function : ir.Function
        Its arguments are pointers.
    known : mapping
        Numbers that never change.
    arrays : dict
        Text of the arrays of constants, by name; this function adds its own.
    """

    def __init__(self, function: ir.Function, known: Known, arrays: dict[str, str]) -> None:
        self._function, self._known, self._arrays = function, known, arrays
        self._texts: dict[int, str] = {}
        self._whole: dict[int, int] = {}
        self._places: dict[int, tuple[str, int]] = {}
        self._lines: list[str] = []
        self._declared: list[str] = []
        self._blocks = _in_order(function.blocks[0])
        self._labels = {id(block): f"block_{i}" for i, block in enumerate(self._blocks)}

    def text(self, name: str, arguments: tuple[str, ...]) -> str:
        """Return the function as C, with these names for its arguments."""
        parameters = []
        for argument, own in zip(self._function.args, arguments, strict=True):
            self._texts[id(argument)], self._places[id(argument)] = own, (own, 0)
            parameters.append(f"{TYPES[str(argument.type.pointee)]} *restrict {own}")
        for block in self._blocks:
            self._lines.append(f"{self._labels[id(block)]}:;")
            for instruction in block.instructions:
                self._write(instruction, block)
        body = "\n".join(f"    {line}" for line in (*self._declared, *self._lines))
        head = f"static inline __attribute__((always_inline)) void {name}({', '.join(parameters)})"
        return f"{head}\n{{\n{body}\n}}\n"

    def _write(self, one: Any, block: Any) -> None:
        if one.opname in ("br", "unreachable", "ret void"):
            self._leave(one, block)
        elif one.opname == "store":
            value, at = one.operands
            self._lines.append(f"{self._memory(at)} = {self._value(value)};")
        elif one.opname == "alloca":
            self._declare(one)
        elif one.opname == "getelementptr":
            self._point(one)
        elif id(one) not in self._texts and not self._is_known(one):
            name = self._texts[id(one)] = f"t{len(self._declared)}"
            self._declared.append(f"{TYPES[str(one.type)]} {name};")
            if one.opname != "phi":  # its predecessors write it
                made = self._memory(one.operands[0]) if one.opname == "load" else expression(one, self._values(one))
                self._lines.append(f"{name} = {made};")

    def _declare(self, one: Any) -> None:
        name, kind = f"v{len(self._declared)}", one.type.pointee
        if isinstance(kind, ir.ArrayType):
            self._declared.append(f"{TYPES[str(kind.element)]} {name}[{kind.count}] __attribute__((aligned(64)));")
            self._texts[id(one)] = name
        else:
            self._declared.append(f"{TYPES[str(kind)]} {name};")
            self._texts[id(one)] = f"&{name}"

    def _point(self, one: Any) -> None:
        index, base = one.indices[-1], id(one.pointer)
        known, place = self._number(index), self._places.get(base)
        if known is not None and place is not None:
            self._places[id(one)] = place[0], place[1] + known
            self._texts[id(one)] = f"({place[0]} + {place[1] + known})"
        else:
            self._texts[id(one)] = f"({self._pointer(one.pointer)} + {self._value(index)})"

    def _is_known(self, one: Any) -> bool:
        """Say whether a number is known now; it needs no statement then."""
        if one.opname == "load":
            place = self._places.get(id(one.operands[0]))
            if place is None or place not in self._known:
                return False
            value = self._known[place]
            if isinstance(value, int):
                self._whole[id(one)] = value
        elif one.opname in ("add", "sub", "mul"):
            first, second = map(self._number, one.operands)
            if first is None or second is None:
                return False
            sums = {"add": first + second, "sub": first - second, "mul": first * second}
            value = self._whole[id(one)] = sums[one.opname]
        else:
            return False
        self._texts[id(one)] = literal(value, str(one.type))
        return True

    def _number(self, value: Any) -> int | None:
        """Return a whole number if it is known now."""
        if isinstance(value, ir.Constant) and isinstance(value.constant, int):
            return value.constant
        return self._whole.get(id(value))

    def _value(self, value: Any) -> str:
        if isinstance(value, ir.Constant):
            return literal(0 if value.constant in (None, ir.Undefined) else value.constant, str(value.type))
        return self._texts[id(value)]

    def _values(self, one: Any) -> list[str]:
        return [self._value(value) for value in (one.args if one.opname == "call" else one.operands)]

    def _pointer(self, value: Any) -> str:
        if not isinstance(value, ir.GlobalVariable):
            return self._texts[id(value)]
        name: str = value.name.replace(".", "_")
        numbers = ", ".join(literal(one.constant, "double") for one in self._elements(value))
        self._arrays[name] = f"static const double {name}[] = {{{numbers}}};"
        return name

    def _elements(self, array: Any) -> list[Any]:
        kind = array.initializer.type.element
        return [one if isinstance(one, ir.Constant) else ir.Constant(kind, one) for one in array.initializer.constant]

    def _memory(self, pointer: Any) -> str:
        text = self._pointer(pointer)
        return text[1:] if text.startswith("&") else f"*{text}"

    def _leave(self, one: Any, block: Any) -> None:
        if one.opname == "ret void":
            self._lines.append("return;")
        elif one.opname == "unreachable":
            self._lines.append("__builtin_unreachable();")
        else:
            *condition, first, last = one.operands if len(one.operands) == 3 else (*one.operands, one.operands[0])
            for target in dict.fromkeys((first, last)):
                self._pass_on(block, target)
            if condition:
                self._lines.append(f"if ({self._value(condition[0])}) goto {self._labels[id(first)]};")
            self._lines.append(f"goto {self._labels[id(last)]};")

    def _pass_on(self, block: Any, target: Any) -> None:
        """Write the numbers that another block takes from this one."""
        for one in target.instructions:
            if one.opname == "phi":
                if id(one) not in self._texts:
                    self._write(one, target)
                self._lines += [
                    f"{self._texts[id(one)]} = {self._value(value)};" for value, of in one.incomings if of is block
                ]


def _in_order(entry: Any) -> list[Any]:
    """Return the blocks that are reached, each after the blocks that every way to it passes."""
    found, seen, ways = [], {id(entry)}, [(entry, iter(_next(entry)))]
    while ways:
        block, others = ways[-1]
        other = next((one for one in others if id(one) not in seen), None)
        if other is None:
            found.append(block)
            ways.pop()
        else:
            seen.add(id(other))
            ways.append((other, iter(_next(other))))
    return found[::-1]


def _next(block: Any) -> list[Any]:
    return [one for one in block.terminator.operands if isinstance(one, ir.Block)]
