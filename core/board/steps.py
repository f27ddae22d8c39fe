"""Where the step of a row of a board is: in machine code, or behind the wall if it is of a unit of one's own."""

from __future__ import annotations

from core.board import program
from core.board.wiring import Wiring
from core.lanes import code
from core.lanes.numbers import WIDTH
from core.own.apart import compiled_apart
from core.ports import INPUT, Port
from core.wall import wall
from core.wall.crossing import Behind, Sizes


def alone(wiring: Wiring, row: int) -> int:
    """Return the address of the step of a row for one board."""
    block = wiring.instances[row].block
    return _behind(wiring, row, 1) if block.text and wall.is_demanded() else program.address(block)


def abreast(wiring: Wiring, row: int) -> int:
    """Return the address of the step of a row for boards side by side."""
    block = compiled_apart(wiring.instances[row].block)
    return _behind(wiring, row, WIDTH) if block.text and wall.is_demanded() else code.address(block)


def _behind(wiring: Wiring, row: int, width: int) -> int:
    """Return the address of the way through the wall to the step of a row."""
    instance = wiring.instances[row]
    ports = tuple(_seen(port, len(port.names(instance.params))) for port in instance.block.Ports.declared)
    sizes = Sizes(len(wiring.packed(row)), len(wiring.state_of(instance.key)), ports)
    return wall.address(compiled_apart(instance.block), sizes, width)


def _seen(port: Port, size: int) -> Behind:
    """Return what a step sees behind a port; a fault writes to what it reads, maybe by two ports."""
    if port.kind != INPUT:
        return Behind(port.name, size, True)
    changes = port.source.startswith("effects.")
    return Behind(port.source if changes else port.name, 1, changes)
