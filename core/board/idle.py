"""Blocks that need not run while their signals are not watched: they have no effect to the end."""

from __future__ import annotations

import re

from core.board.board import Board
from core.board.document import SUPERVISOR
from core.board.ensemble import Ensemble
from core.board.instances import weighing_blocks
from core.board.pending import PendingQueue
from core.board.wiring import needed


def leave_out_idle(board: Board) -> None:
    """Leave out the blocks whose signals neither the loop nor people read; no bit of a digest changes.

    Call it at the first tick, when all commands of the run wait.
    """
    for one in [board, *(board.twins.values() if isinstance(board, Ensemble) else ())]:
        wiring, idle = one.wiring, idle_blocks(one, board.pending, board.estimates)
        wiring.left_out = {row for row, instance in enumerate(wiring.instances) if instance.key in idle}
        wiring.is_changed = True
        one.link()


def looking_on(board: Board) -> set[str]:
    """Return the blocks without effect: idle blocks, and sensors that rest to the end."""
    idle = idle_blocks(board, board.pending, board.estimates)
    return idle | ({*board.spec.sensors} - needed(board.spec, sorted(_named(board.pending))))


def idle_blocks(board: Board, pending: PendingQueue, wants_estimates: bool) -> set[str]:
    """Return the blocks that nothing reads.

    These are controllers that drive neither now nor by a command that waits, and weighted estimates without a reader.
    """
    spec, wiring, named = board.spec, board.wiring, _named(pending)
    idle = {*spec.controllers} - {*spec.driving.values()} - named - _words(spec.document.get(SUPERVISOR, ""))
    if not wants_estimates:
        conditions = " ".join(entry.command.when or "" for entry in pending)
        weighing = weighing_blocks(wiring.instances)
        idle |= weighing - {one.block for one in wiring.signals if one.block in weighing and one.name in conditions}
    places = {wiring.index[signal.name]: signal.block for signal in wiring.signals if signal.block in idle}
    rows = [*enumerate(wiring.instances)]
    while True:  # a block that is read may read another
        running = [row for row, instance in rows if instance.key not in idle]
        inputs = [wiring.ports(row)[: len(wiring.instances[row].block.inputs)].tolist() for row in running]
        read = {places[place] for own in inputs for place in own if place in places} & idle
        if not read:
            return idle
        idle -= read


def _named(pending: PendingQueue) -> set[str]:
    """Return all words of the commands that wait, their conditions included."""
    return _words([entry.command.document() for entry in pending])


def _words(said: object) -> set[str]:
    return {*re.findall(r"\w+", str(said))}
