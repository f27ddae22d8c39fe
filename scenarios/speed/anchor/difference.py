"""The parts in which a board and its twin in C differ."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from core.board.board import Board
from core.board.fold import Words
from scenarios.speed.anchor.twin import Array, Twin


def same(first: Array, second: Array) -> bool:
    """Say whether two arrays have the same bits; every NaN counts as the same number."""
    if first.dtype.kind != "f":
        return np.array_equal(first, second)
    first, second = np.ascontiguousarray(first), np.ascontiguousarray(second)
    is_same = first.view(f"u{first.itemsize}") == second.view(f"u{second.itemsize}")
    return bool((is_same | (np.isnan(first) & np.isnan(second))).all())


def differences(board: Board, twin: Twin) -> Iterator[str]:
    """Name the parts in which a board and a twin differ now."""
    yield from ["ticks"] if twin.has_stopped else []
    ours = {
        "state": board.wiring.s,
        "signals": board.wiring.w,
        "values that the observer saw last": board.observer.seen()[0],
    }
    for (part, numbers), name in zip(ours.items(), ("s", "w", "last"), strict=True):
        yield from [] if same(numbers, twin.arrays[name]) else [part]
    yield from [] if digest(board, twin.arrays["folds"]) == board.digest() else ["digest"]


def digest(board: Board, folds: Words) -> str:
    """Return the digest of a board that has other folds."""
    own, board.folds = board.folds, folds
    found = board.digest()
    board.folds = own
    return found
