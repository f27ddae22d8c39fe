"""The record of an instrument that a bench plays."""

from __future__ import annotations

from typing import TYPE_CHECKING

from core.board.board import Board
from scenarios.records.live import LiveRecord

if TYPE_CHECKING:
    from server.bench.bench import LiveBench
    from server.bench.replay import TickSource


def live_record(board: TickSource) -> LiveRecord | None:
    """Return the record of an instrument that a board plays, if it does."""
    record = board.spec.record if isinstance(board, Board) else None
    return record if isinstance(record, LiveRecord) else None


def tell_end(bench: LiveBench) -> None:
    """Note on a bench that has come back why its record grows no longer, unless its log says it."""
    record = live_record(bench.board)
    if record is None or record.is_growing:
        return
    if all(event.text != record.last_line for event in bench.events.after(0)[1]):
        bench.note("instrument", "instrument", record.last_line)
