"""The kernels of a bench in a file: loop with history and fold, columns of a picture, crossings, folds of blocks."""

from __future__ import annotations

from typing import Any

from core.board import crossing, fold, history, kept
from core.wasm.module import OfferedKernel

WHOLE, NUMBER = "int64", "float64"
NUMBERS, PLACES, WORDS, RING = ((kind, 1) for kind in ("float64", "int64", "uint64", "float32"))
FOLDS, ROWS, TABLE = ("uint64", 2), ("float64", 2), ("int64", 2)
RINGS: tuple[Any, ...] = (("float32", 2),) * 3 + (PLACES,) * 2


def _plain(kernel: Any) -> Any:
    return kernel.py_func


KERNELS = {
    "run": OfferedKernel(
        _plain(kept.run),
        (
            *(WHOLE, WHOLE, NUMBER, TABLE, NUMBERS, NUMBERS, NUMBERS, PLACES, WHOLE, FOLDS, WHOLE, ROWS),
            *(PLACES, NUMBERS, *RINGS, ("bool", 1)),
        ),
    ),
    "cut": OfferedKernel(_plain(history.cut), (*RINGS, PLACES, PLACES, WHOLE, WHOLE, WHOLE, WHOLE, ("float32", 3))),
    "crossings": OfferedKernel(_plain(crossing.crossings), (("float32", 1), ("float32", 2), WHOLE, PLACES, PLACES)),
    "join": OfferedKernel(_plain(fold.join), (FOLDS, PLACES, FOLDS)),
}
"""By the names that the page calls them by."""
