"""Floating-point operations of a diagnoser, counted by running its step on numbers that count."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from pydantic import BaseModel

from core import elementary
from core.block import Block, FloatArray
from core.board import program
from core.board.board import Board
from core.diagnose.hypothesis import names_of
from core.errors import InputError, unknown
from core.plain import rebound
from core.ports import TICK, TIME_MS
from core.wall import wall

SAMPLES = 4
"""Samples counted, after a first sample that does not count."""


class Tally:
    """The operations and functions counted so far."""

    def __init__(self) -> None:
        self.operations = 0
        self.functions = 0


class Counted(float):
    """A number that counts the additions, multiplications and divisions it takes part in."""

    tally: Tally

    def __new__(cls, value: float, tally: Tally) -> Counted:
        """Return a number that counts for a tally."""
        made = super().__new__(cls, value)
        made.tally = tally
        return made

    def _made(self, value: float) -> Counted:
        self.tally.operations += 1
        return Counted(value, self.tally)

    def __add__(self, other: float) -> Counted:
        return self._made(float(self) + float(other))

    def __sub__(self, other: float) -> Counted:
        return self._made(float(self) - float(other))

    def __rsub__(self, other: float) -> Counted:
        return self._made(float(other) - float(self))

    def __mul__(self, other: float) -> Counted:
        return self._made(float(self) * float(other))

    def __truediv__(self, other: float) -> Counted:
        return self._made(float(self) / float(other) if float(other) != 0.0 else math.nan)

    def __rtruediv__(self, other: float) -> Counted:
        return self._made(float(other) / float(self) if float(self) != 0.0 else math.nan)

    def __neg__(self) -> Counted:
        return Counted(-float(self), self.tally)

    def __abs__(self) -> Counted:
        return Counted(abs(float(self)), self.tally)

    __radd__ = __add__
    __rmul__ = __mul__


EXPONENTIAL, *OTHERS = (
    getattr(function, "py_func", function)
    for function in (elementary.exp, elementary.log, elementary.sin, elementary.cos, elementary.atan2)
)
COUNTED = (EXPONENTIAL, *OTHERS, math.sqrt)
"""Functions that are counted; the cost of others, such as rounding, is not known."""


class _Mathematics:
    """Roots, counted, and the rest of ``math``."""

    def __init__(self, tally: Tally) -> None:
        self._tally = tally

    def __getattr__(self, name: str) -> Any:
        return counted(getattr(math, name), self._tally)


def counted(function: Any, tally: Tally) -> Any:
    """Return a function that counts its calls, or the value itself if ``COUNTED`` does not have it."""
    if not any(function is one for one in COUNTED):
        return function

    def call(*args: float) -> Counted:
        tally.functions += 1
        return Counted(function(*args), tally)

    return call


def plain_step(block: type[Block], tally: Tally) -> Any:
    """Return a step as plain Python with counted mathematics.

    Raises
    ------
    InputError
        For a unit that a document carries, where units run behind the wall: nothing else runs them there.
    """
    if block.text and wall.is_demanded():
        text = "operations of a unit of one's own are not counted where units run behind a wall"
        raise InputError(text, f"units.{block.name}")

    def swap(value: Any) -> Any:
        name = getattr(value, "__name__", "")
        if value is math:
            return _Mathematics(tally)
        if name == "flush_tiny":
            return lambda number: number
        if name == "whole":  # an operation that only fills up a vector register does not count
            return lambda number: number
        if name == "shrunk":  # an exponential, though it is left out where it would be nothing
            return counted(EXPONENTIAL, tally)
        return counted(value, tally)

    # a conversion to float would lose the count
    return rebound(block.step, swap, {"float": lambda number: number})


class Load(BaseModel):
    """Load of a board by one diagnoser.

    ``functions`` are exponentials, logarithms, roots, sines; each counts as ``function_flops``.
    """

    name: str
    models: int
    operations: float
    functions: float
    per_model: float
    flops_per_second: float
    share: float
    overrun: bool
    models_that_fit: int


class Budget(BaseModel):
    """Load of a board of some speed by all diagnosers in their order; they overrun once their sum exceeds the speed."""

    board_flops: float
    function_flops: float
    share: float
    loads: list[Load]


def count(board: Board, name: str) -> tuple[float, float]:
    """Return the operations and functions of one sample of a diagnoser, from the state it is in.

    A sample is all the ticks from one turn to the next: some diagnosers have something to do between.

    Raises
    ------
    InputError
        When there is no such diagnoser.
    """
    if name not in board.spec.diagnosers:
        raise unknown("diagnoser", name, board.spec.diagnosers, "diagnoser")
    wiring = board.wiring
    row = wiring.row(name)
    block, every = wiring.instances[row].block, wiring.instances[row].every
    tally = Tally()

    def counting(numbers: FloatArray) -> Any:
        made = np.empty(len(numbers), dtype=object)
        made[:] = [Counted(value, tally) for value in numbers]
        return made

    w = counting(wiring.w)
    p, s = block.Packed(counting(wiring.packed(row))), block.State(counting(wiring.state_of(name)))
    x = block.Ports(w, wiring.ports(row))
    step = plain_step(block, tally)
    # the ticks between two turns are all alike
    between = (every - 1) // int(wiring.table[row][program.EVERY])

    def spent(tick: int) -> tuple[int, int]:
        w[TICK], w[TIME_MS] = Counted(tick, tally), Counted(tick * board.dt_ms, tally)
        tally.operations = tally.functions = 0
        step(p, s, x)
        return tally.operations, tally.functions

    operations = functions = 0
    first = -(-board.tick // every) * every
    for turn in range(first, first + (SAMPLES + 1) * every, every):
        for tick, times in ((turn, 1), (turn + 1, between)):
            own = spent(tick) if times else (0, 0)
            if turn > first:
                operations += times * own[0]
                functions += times * own[1]
    return operations / SAMPLES, functions / SAMPLES


def budget(board: Board, board_flops: float, function_flops: float = 20.0) -> Budget:
    """Return the load of a board of so many operations per second by the diagnosers of a bench.

    Raises
    ------
    InputError
        When the board has no speed.
    """
    if not (board_flops > 0.0 and math.isfinite(board_flops)):
        raise InputError("must be a positive number of operations per second", "board_flops")
    loads: list[Load] = []
    used = 0.0
    for name, section in board.spec.diagnosers.items():
        operations, functions = count(board, name)
        cost = operations + function_flops * functions
        models = max(1, len(names_of(section.params)))
        rate = 1e3 / (board.dt_ms * board.spec.turns(section))
        left = max(board_flops - used, 0.0)
        used += cost * rate
        loads.append(
            Load(
                name=name,
                models=models,
                operations=operations,
                functions=functions,
                per_model=operations / models,
                flops_per_second=cost * rate,
                share=cost * rate / board_flops,
                overrun=used > board_flops,
                models_that_fit=min(models, int(left / (cost * rate / models))) if cost else models,
            )
        )
    return Budget(board_flops=board_flops, function_flops=function_flops, share=used / board_flops, loads=loads)
