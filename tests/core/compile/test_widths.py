"""Code beside the steps for 8 and for 16 boards: both from one shelf, each with the bits of a board alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core import kernel_cache
from core.board import fold
from core.board.lane_traces import at_a_line
from core.compile import code
from core.compile.folding import folds_of_tick
from core.compile.instructions import address_of, call
from core.compile.keeping import SLICE, keeps, sorts
from core.ports import RESERVED

WIDTHS = (8, 16)
SIGNALS = 5


class MemoryShelf(dict[str, bytes]):
    """A shelf in memory."""

    put = dict.__setitem__


@pytest.fixture
def two_widths(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return the addresses of a function for each width, from a shelf that is empty at first."""
    monkeypatch.setattr(kernel_cache, "_shelves", [MemoryShelf()])
    monkeypatch.setattr(code, "compiled_here", [])
    return lambda write, *arguments: {width: code.helper(write, width, *arguments) for width in WIDTHS}


def signals(width: int) -> Any:
    """Return signals of boards side by side."""
    return np.random.default_rng(width).normal(size=(RESERVED + SIGNALS, width))


def test_the_fold_of_each_board_is_its_fold_alone(two_widths: Any) -> None:
    addresses = two_widths(folds_of_tick, (fold.A, fold.B), fold.SHIFTS, fold.NONE, RESERVED)
    places, sizes = np.arange(RESERVED, RESERVED + SIGNALS), np.array([SIGNALS, SIGNALS])
    for width, address in addresses.items():
        numbers, folds = signals(width), np.repeat(fold.begin(SIGNALS)[:, :, None], width, axis=2)
        for _ in range(2):
            call(address, *map(address_of, (numbers, folds, places, sizes)))
        for lane in range(width):
            alone = fold.begin(SIGNALS)
            for _ in range(2):
                fold.fold(alone, numbers[RESERVED:, lane].copy().view(np.uint64))
            assert (folds[:, :, lane] == alone).all(), (width, lane)


def test_signals_and_sums_are_kept_of_each_board(two_widths: Any) -> None:
    places, ends = np.array([RESERVED + 3, RESERVED, RESERVED + 1, RESERVED + 2]), np.array([2, 0, 1, 4])
    for width, address in two_widths(keeps).items():
        numbers, room = signals(width), np.zeros((2, width))
        call(address, *map(address_of, (numbers, room, places, ends)))
        one, a, b, c = numbers[places]
        assert (room == [one, a + b + c]).all(), width


def test_kept_signals_are_sorted_by_board(two_widths: Any) -> None:
    nothing, shape = np.zeros(1, dtype=np.int64), np.array([2, 2 * SLICE])
    for width, address in two_widths(sorts).items():
        rows, trace = np.random.default_rng(width).normal(size=(SLICE, 2, width)), at_a_line((2, width, 2 * SLICE))
        trace[:] = 0.0
        call(address, address_of(rows), address_of(trace) + 8 * SLICE, *map(address_of, (nothing, shape)))
        assert (trace[:, :, SLICE:] == rows.transpose(1, 2, 0)).all() and not trace[:, :, :SLICE].any(), width
