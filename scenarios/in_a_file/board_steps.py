"""The steps that the code of a file has: all blocks of its boards, and the segments that run as one function."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from core.board.board import Board
from core.board.segments import parts
from core.compile.code import Block
from core.compile.segment import Segment

Step = Block | Segment


def steps_of(boards: Iterable[Board]) -> list[Step]:
    """Return the blocks of some boards and the segments of the rows that run now; the number of a step is its place."""
    boards = list(boards)
    blocks = dict.fromkeys(one.block for board in boards for one in board.wiring.instances)
    segments = dict.fromkeys(segment for board in boards for _, segment in _segments(board))
    return [*blocks, *segments]


def segments_of(board: Board, steps: list[Step]) -> list[dict[str, Any]]:
    """Return the rows of each segment of a board, and the number of its step.

    A page runs a segment wherever its rows run one after another. Other rows, which a switch may start, run by
    themselves.
    """
    return [{"rows": rows, "step": steps.index(segment)} for rows, segment in _segments(board)]


def _segments(board: Board) -> list[tuple[list[int], Segment]]:
    running = board.walk.running
    return [(running[one.rows], one.segment.steps) for one in parts(board.wiring, running) if one.segment]
