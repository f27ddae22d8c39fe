"""What need not run in a board whose signals nobody watches: controllers that look on to the end."""

from __future__ import annotations

from core.board.board import Board
from core.board.commands import Set, Switch


def leave_out_idle(board: Board) -> None:
    """Leave out the controllers that never drive and whose signals no other block reads; no bit of a digest changes.

    Call it at the first tick, when all commands of the run wait.
    """
    wiring, idle = board.wiring, idle_controllers(board)
    wiring.left_out = {row for row, instance in enumerate(wiring.instances) if instance.key in idle}
    wiring.is_changed = True
    board.link()


def idle_controllers(board: Board) -> set[str]:
    """Return the controllers that drive neither now nor by a command that waits, and that no other block reads."""
    spec, wiring = board.spec, board.wiring
    used = {*spec.driving.values()}
    for entry in board.pending:
        if isinstance(entry.command, Switch):
            used.add(entry.command.switch)
        elif isinstance(entry.command, Set):
            used |= {str(value) for value in entry.command.set.values()}
    idle = {*spec.controllers} - used
    places = {wiring.index[signal.name]: signal.block for signal in board.signals if signal.block in idle}
    for row, instance in enumerate(wiring.instances):
        if instance.key not in idle:
            read = wiring.ports(row)[: len(instance.block.inputs)].tolist()
            idle -= {places[place] for place in read if place in places}
    return idle
