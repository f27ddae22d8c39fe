"""Blocks that need not run while their signals are not watched: controllers and sensors without effect to the end."""

from __future__ import annotations

import re

from core.board.board import Board
from core.board.document import SUPERVISOR
from core.board.ensemble import Ensemble
from core.board.pending import PendingQueue
from core.board.wiring import needed


def leave_out_idle(board: Board) -> None:
    """Leave out the controllers that never drive and whose signals no other block reads; no bit of a digest changes.

    Call it at the first tick, when all commands of the run wait.
    """
    for one in [board, *(board.twins.values() if isinstance(board, Ensemble) else ())]:
        wiring, idle = one.wiring, idle_controllers(one, board.pending)
        wiring.left_out = {row for row, instance in enumerate(wiring.instances) if instance.key in idle}
        wiring.is_changed = True
        one.link()


def looking_on(board: Board) -> set[str]:
    """Return the blocks without effect: idle controllers, and sensors that rest to the end."""
    return idle_controllers(board, board.pending) | (
        {*board.spec.sensors} - needed(board.spec, sorted(_named(board.pending)))
    )


def idle_controllers(board: Board, pending: PendingQueue) -> set[str]:
    """Return the controllers that drive neither now nor by a command that waits, and that nothing else reads."""
    spec, wiring = board.spec, board.wiring
    idle = {*spec.controllers} - {*spec.driving.values()} - _named(pending) - _words(spec.document.get(SUPERVISOR, ""))
    places = {wiring.index[signal.name]: signal.block for signal in wiring.signals if signal.block in idle}
    for row, instance in enumerate(wiring.instances):
        if instance.key not in idle:
            read = wiring.ports(row)[: len(instance.block.inputs)].tolist()
            idle -= {places[place] for place in read if place in places}
    return idle


def _named(pending: PendingQueue) -> set[str]:
    """Return all words of the commands that wait, their conditions included."""
    return _words([entry.command.document() for entry in pending])


def _words(said: object) -> set[str]:
    return {*re.findall(r"\w+", str(said))}
