"""The C of a board: its steps with the places of their numbers as constants, and the loop around them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from typing import Any, Self

import numpy as np
from llvmlite import ir

from core.block import BoolArray
from core.board import fold, program, pyramid
from core.board.board import Board
from core.board.wiring import Wiring
from core.compile import code
from core.ports import RESERVED, TICK, TIME_MS
from scenarios.speed.anchor.known import known
from scenarios.speed.anchor.writer import HEAD, Writer

ARGUMENTS = "p", "s", "w", "io"


@dataclass(frozen=True)
class BoardMoment:
    """The numbers of a board at a tick edge, and the rows that run from there on."""

    tick: int
    wiring: Wiring
    running: tuple[int, ...]

    @classmethod
    def of(cls, board: Board) -> Self:
        """Return a copy of the numbers that a board has now."""
        wiring = board.checkpoint().parts["wiring"]
        return cls(board.tick, wiring, tuple(row for row in range(len(wiring.instances)) if row not in wiring.resting))

    @property
    def on(self) -> BoolArray:
        """Whether a row runs, row by row."""
        return np.isin(np.arange(len(self.wiring.instances)), self.running)


def board_text(moments: Sequence[BoardMoment]) -> str:
    """Return the C of a board that has these moments; a number is a constant if it is the same at all of them.

    Numbers count that a step only reads to decide how it runs: the places of ports, choices and lengths.
    """
    wiring, arrays, functions, calls = moments[0].wiring, dict[str, str](), [], []
    for row in sorted({row for moment in moments for row in moment.running}):
        instance, module = wiring.instances[row], translated(wiring.instances[row].block)
        constants = known([moment.wiring for moment in moments], row)
        functions.append(Writer(module.functions[0], constants, arrays).text(f"step_{row}", ARGUMENTS))
        table = wiring.table[row]
        offsets = zip(
            ARGUMENTS, (table[program.P_OFFSET], table[program.S_OFFSET], 0, table[program.IO_OFFSET]), strict=True
        )
        call = f"step_{row}({', '.join(f'{name} + {offset}' for name, offset in offsets)}); /* {instance.key} */"
        conditions = [] if all(row in moment.running for moment in moments) else [f"on[{row}]"]
        conditions += [f"number % {table[program.EVERY]} == 0"] if table[program.EVERY] != 1 else []
        calls.append(f"    if ({' && '.join(conditions)}) {call}" if conditions else f"    {call}")
    defined = "\n".join(f"#define {name} {value}" for name, value in _constants(wiring).items())
    head = (
        "static inline __attribute__((always_inline)) void tick(int64_t number, double *restrict p, "
        "double *restrict s, double *restrict w, int64_t *restrict io, const uint8_t *restrict on)"
    )
    loop = resources.files(__package__).joinpath("board.c").read_text()
    return "\n".join([HEAD, *arrays.values(), *functions, head, "{", *calls, "}", defined, loop])


def _constants(wiring: Wiring) -> dict[str, Any]:
    factors, shifts, (infinite, unsigned, none) = (fold.A, fold.B), fold.SHIFTS, fold.NONE
    return {
        "TICK": TICK,
        "TIME_MS": TIME_MS,
        "RESERVED": RESERVED,
        "TRIP": wiring.trip,
        "STATES": len(wiring.s),
        "OUTPUTS": wiring.signals.outputs,
        "TAPS": len(wiring.signals.taps),
        "LANES": pyramid.LANES,
        "FACTOR": pyramid.FACTOR,
        **{f"FACTOR_{name}": f"UINT64_C({value})" for name, value in zip("AB", factors, strict=True)},
        **{f"SHIFT_{name}": value for name, value in zip("AB", shifts, strict=True)},
        "INFINITE_BITS": f"UINT64_C({infinite})",
        "UNSIGNED": f"UINT64_C({unsigned})",
        "NO_NUMBER": f"UINT64_C({none})",
    }


def translated(block: Any) -> ir.Module:
    """Return the instructions of a step for one board, as they are before any optimisation."""
    return code.module_of(block, 1, lanes=False)
