"""Builds the wall, each user unit as WebAssembly in its own memory; checks that such a unit gives the same bits."""

from __future__ import annotations

import inspect
from typing import Any

from core.board.board import Board
from core.control import pid
from core.errors import InputError
from core.wall import wall
from scenarios.kernel_cache import folder

BENCH: dict[str, Any] = {
    "device": {"id": "ch3"},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 159.15494309189535},
    "controller": {"kind": "pid"},
    "sensor": {"kind": "ideal"},
}
TICKS = 200


def build() -> None:
    """Let units run behind the wall in this process, and in its worker processes, from now on.

    Raises
    ------
    InputError
        When the wall cannot be built on this machine, or does not compute alike.
    """
    if folder() is None:
        text = "needs a folder for compiled kernels: the process that compiles units leaves them there"
        raise InputError(text, "units", "set COMBBENCH_KERNEL_CACHE to a folder that can be written")
    wall.demand()
    if _digest(BENCH) != _digest(with_unit()):
        wall.demand(False)
        raise InputError("the wall gives other bits than this processor", "units", "set teacher or off")


def with_unit() -> dict[str, Any]:
    """Return the bench with a copy of its controller as a user unit."""
    return {**BENCH, "units": {"pid": {"source": inspect.getsource(pid)}}}


def _digest(bench: dict[str, Any]) -> str:
    board = Board(bench)
    board.advance(TICKS)
    return board.digest()
