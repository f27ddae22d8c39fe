"""The record of an instrument that a bench plays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.board.board import Board
from scenarios.records.live import LiveRecord

if TYPE_CHECKING:
    from server.bench.replay import TickSource


def live_record(board: TickSource) -> LiveRecord | None:
    """Return the record of an instrument that a board plays, if it does."""
    record = board.spec.record if isinstance(board, Board) else None
    return record if isinstance(record, LiveRecord) else None
