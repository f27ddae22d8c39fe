"""Floating-point operations of a diagnoser, counted by running its step on numbers that count."""

from __future__ import annotations

import math
from types import FunctionType, ModuleType
from typing import Any

from pydantic import BaseModel

from core.block import TICK, TIME_MS
from core.board import program
from core.board.board import Board
from core.errors import InputError, unknown

SAMPLES = 4
"""Samples counted, after one that is not."""


class Tally:
    """What has been counted."""

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


class _Functions:
    """The mathematical functions, counted."""

    def __init__(self, tally: Tally) -> None:
        self._tally = tally

    def __getattr__(self, name: str) -> Any:
        function = getattr(math, name)
        if name not in ("exp", "log", "sqrt", "sin", "cos", "atan2"):
            return function

        def counted(*args: float) -> Counted:
            self._tally.functions += 1
            return Counted(function(*args), self._tally)

        return counted


class _Module:
    """A module of kernels, all of them plain."""

    def __init__(self, module: ModuleType, tally: Tally) -> None:
        self._module, self._tally = module, tally

    def __getattr__(self, name: str) -> Any:
        return _plain(getattr(self._module, name), self._tally)


def _plain(value: Any, tally: Tally) -> Any:
    """Return a kernel as a plain function whose own kernels are plain too, and counted mathematics."""
    value = getattr(value, "py_func", value)
    if value is math:
        return _Functions(tally)
    if isinstance(value, ModuleType) and value.__name__.startswith("core."):
        return _Module(value, tally)
    if not isinstance(value, FunctionType) or not value.__module__.startswith("core."):
        return value
    own: dict[str, Any] = dict(value.__globals__)
    for name in value.__code__.co_names:
        if name in own:
            own[name] = value if own[name] is value else _plain(own[name], tally)
    if value.__name__ == "settled":
        return lambda number: number
    if value.__name__ == "shrunk":  # an exponential, though it is left out where it would be nothing
        return _Functions(tally).exp
    if value.__name__ == "float":
        return value
    own["float"] = lambda number: number
    return FunctionType(value.__code__, own, value.__name__, value.__defaults__, value.__closure__)


class Load(BaseModel):
    """What a diagnoser costs a board.

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
    """What all diagnosers cost a board of some speed, in their order; those that come too late overrun."""

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
    entry = wiring.table[row]
    tally = Tally()
    p = [Counted(value, tally) for value in wiring.p[entry[program.P_OFFSET] :]]
    s = [Counted(value, tally) for value in wiring.state_of(name)]
    w = [Counted(value, tally) for value in wiring.w]
    io = [int(value) for value in wiring.io[entry[program.IO_OFFSET] :]]
    step = _plain(wiring.instances[row].block.step, tally)
    every = wiring.instances[row].every
    # what is done between two turns is the same at every tick
    between = (every - 1) // int(entry[program.EVERY])

    def spent(tick: int) -> tuple[int, int]:
        w[TICK], w[TIME_MS] = Counted(tick, tally), Counted(tick * board.dt_ms, tally)
        tally.operations = tally.functions = 0
        step(p, s, w, io)
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
    """Return what the diagnosers of a bench would cost a board of so many operations per second.

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
        models = max(1, len(getattr(section.params, "hypotheses", ())))
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
