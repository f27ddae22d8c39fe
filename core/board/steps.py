"""Addresses of the steps of a board: in machine code, or behind the wall for a unit that a document carries."""

from __future__ import annotations

from core.board import program
from core.board.wiring import Wiring
from core.own.apart import compiled_apart
from core.ports import INPUT, Port
from core.wall import wall
from core.wall.crossing import PortSignal, Sizes


def address(wiring: Wiring, row: int, width: int = 1) -> int:
    """Return the address of the step of a row, for so many boards side by side."""
    block = wiring.instances[row].block
    return _behind(wiring, row, width) if block.text and wall.is_demanded() else program.address(block, width)


def _behind(wiring: Wiring, row: int, width: int) -> int:
    """Return the address of the way through the wall to the step of a row."""
    instance = wiring.instances[row]
    ports = tuple(_seen(port, len(port.names(instance.params))) for port in instance.block.Ports.declared)
    sizes = Sizes(len(wiring.packed(row)), len(wiring.state_of(instance.key)), ports)
    return wall.address(compiled_apart(instance.block), sizes, width)


def _seen(port: Port, size: int) -> PortSignal:
    """Return the numbers that a step sees behind a port; a fault writes to signals it reads, maybe by two ports."""
    if port.kind != INPUT:
        return PortSignal(port.name, size, True)
    changes = port.source.startswith("effects.")
    return PortSignal(port.source if changes else port.name, 1, changes)
