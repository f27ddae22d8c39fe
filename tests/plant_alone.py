"""A plant without a board: its signals in one array, its step compiled or plain."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from core.block import Block, Context
from core.compile import code
from core.plain import plain
from core.ports import RESERVED

ENTRY = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)
NEUTRAL = 1.0


class PlantAlone:
    """A plant and all signals behind its ports, by the names of the ports."""

    def __init__(self, block: type[Block], context: Context, *, compiled: bool = True, **params: Any) -> None:
        values = block.Params.model_validate(params)
        self.p, self.s = block.packed(values, context), block.initial(values, context)
        self.ports = [port.name for port in block.Ports.declared]
        self.w = np.zeros(RESERVED + len(self.ports))
        self.io = np.arange(RESERVED, len(self.w))
        for port in block.inputs:
            if port.name.endswith(("_scale", "_gain")):
                self[port.name] = NEUTRAL
        self.pointers = [array.ctypes.data for array in (self.p, self.s, self.w, self.io)]
        if compiled:
            self.address = code.address(block)
            function = ENTRY(self.address)
            self._run = lambda: function(*self.pointers)
        else:
            step = plain(block.step)
            arguments = block.Packed(self.p), block.State(self.s), block.Ports(self.w, self.io)
            self._run = lambda: step(*arguments)

    def place(self, name: str) -> int:
        return RESERVED + self.ports.index(name)

    def __getitem__(self, name: str) -> float:
        return float(self.w[self.place(name)])

    def __setitem__(self, name: str, value: float) -> None:
        self.w[self.place(name)] = value

    def tick(self) -> None:
        """Run one tick, and move to the next."""
        self._run()
        self.w[0] += 1.0

    def play(self, ticks: int, *names: str, before: Callable[[int], None] | None = None) -> np.ndarray:
        """Run so many ticks and return signals, one row each; ``before`` a tick sets the inputs of its interval."""
        places = [self.place(name) for name in names]
        kept = np.empty((len(names), ticks))
        for i in range(ticks):
            if before is not None:
                before(i)
            self.tick()
            kept[:, i] = self.w[places]
        return kept


def held(plant: PlantAlone, axis: str, start: float, middle: float | None = None, end: float | None = None) -> None:
    """Set the force along an axis; without middle and end it is held."""
    plant[f"force_{axis}"] = start
    plant[f"middle_{axis}"] = start if middle is None else middle
    plant[f"end_{axis}"] = start if end is None else end
