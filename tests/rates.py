"""Generators of rate and read-outs without a board: their steps in a row, one after the other at each tick."""

from __future__ import annotations

from typing import Any

import numpy as np

from core import registry
from core.block import Block, Context, Oscillator
from core.board import fold, program
from core.plain import plain
from core.ports import RESERVED

NONE = Oscillator(mass=1.0, damping=1.0, stiffness=1.0, force=1.0)
OPEN = "estimate"
"""The signal that a read-out uses without a generator."""


def context(dt_ms: float, seed: int = 1, every: int = 1) -> Context:
    return Context(dt_ms=dt_ms * every, every=every, seed=seed, device=NONE, model=NONE)


class Row:
    """Blocks in a row: a generator, a read-out, or both, the second listening to the first."""

    def __init__(
        self,
        *blocks: tuple[str, str, dict[str, Any]],
        dt_ms: float = 1.0,
        seed: int = 1,
        every: int = 1,
        compiled: bool = True,
    ) -> None:
        self.dt_ms, self.compiled, self.tick = dt_ms, compiled, 0
        self.blocks = [registry.block(family, name) for family, name, _ in blocks]
        self.params = [block.Params(**values) for block, (_, _, values) in zip(self.blocks, blocks, strict=True)]
        self.context = context(dt_ms, seed, every)
        self.places: dict[str, int] = {}
        size = RESERVED
        for block, params in zip(self.blocks, self.params, strict=True):
            for port in (*block.outputs, *block.taps):
                self.places[port.name] = size
                size += len(port.names(params))
        self.columns = size - RESERVED
        self.places[OPEN] = size
        self.w = np.zeros(size + 1)
        self.p = [block.packed(params, self.context) for block, params in zip(self.blocks, self.params, strict=True)]
        self.s = [block.initial(params, self.context) for block, params in zip(self.blocks, self.params, strict=True)]
        self.io = [np.array([self._place(port) for port in block.Ports.declared]) for block in self.blocks]

    def _place(self, port: Any) -> int:
        if port.kind == "input":
            return self.places["rate" if "rate" in self.places else OPEN]
        return self.places[port.name]

    def state(self, block: int) -> Any:
        return self.blocks[block].State(self.s[block])

    def value(self, name: str, count: int = 1) -> np.ndarray:
        return self.w[self.places[name] : self.places[name] + count].copy()

    def play(self, ticks: int) -> np.ndarray:
        """Advance and return the signals of the first block, one column each."""
        first = len(self.blocks[0].outputs) + len(self.blocks[0].taps)
        rows = np.zeros((ticks, min(first, self.columns)))
        offsets = [np.cumsum([0, *map(len, part)]) for part in (self.p, self.s, self.io)]
        flat = [np.concatenate(part) for part in (self.p, self.s, self.io)]
        table = np.zeros((len(self.blocks), program.COLUMNS), np.int64)
        table[:, program.EVERY] = self.context.every
        for row, block in enumerate(self.blocks):
            table[row, program.ADDRESS] = program.address(block) if self.compiled else 0
            table[row, 1:4] = [offset[row] for offset in offsets]
        common = (ticks, self.tick, self.dt_ms, table, flat[0], flat[1], self.w, flat[2], rows, np.zeros((ticks, 0)))
        end = (fold.begin(0), len(self.w) - 1, np.zeros((0, 3)))
        if self.compiled:
            program.run(*common, *end)
        else:
            steps = [
                self._plain(block, *parts) for block, parts in zip(self.blocks, self._parts(flat, offsets), strict=True)
            ]
            program.run_uncompiled(steps, *common, *end)
        self.s = [flat[1][a:b] for a, b in zip(offsets[1], offsets[1][1:], strict=False)]
        self.tick += ticks
        return rows

    def _parts(self, flat: list[np.ndarray], offsets: list[np.ndarray]) -> Any:
        for row in range(len(self.blocks)):
            yield tuple(part[offset[row] : offset[row + 1]] for part, offset in zip(flat, offsets, strict=True))

    def _plain(self, block: type[Block], p: np.ndarray, s: np.ndarray, io: np.ndarray) -> Any:
        step, x = plain(block.step), block.Ports(self.w, io)
        return lambda: step(block.Packed(p), block.State(s), x)
