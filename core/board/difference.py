"""One way to change a board: by the difference of two benches."""

from __future__ import annotations

from collections.abc import Iterable

from core.board import program
from core.board.instances import Instance, instances, usual_params
from core.board.spec import Spec
from core.board.wiring import Wiring, engage, every_of, ports_of, unread


def change(wiring: Wiring, before: Spec, spec: Spec) -> bool:
    """Turn the wiring of a bench into the wiring of another with the same blocks, in place; say whether it worked.

    It is not possible where a block reads more or fewer numbers than before, or where a stage of the board comes or
    goes.

    Only rows whose parameters or context differ are packed again; states stay. When a block refuses its parameters
    nothing has changed.

    Raises
    ------
    InputError
        As ``Block.pack``.
    """
    order, rows = _after(wiring, before, spec)
    if any(order[row].block is not wiring.instances[row].block for row in rows):
        return False
    other = {
        place
        for place in {(order[row].every, order[row].axis) for row in rows}
        if spec.context(*place) is not before.context(*place) and spec.context(*place) != before.context(*place)
    }
    packed = {
        row: order[row].packed(spec.context(order[row].every, order[row].axis))
        for row in rows
        if (order[row].every, order[row].axis) in other or order[row] != wiring.instances[row]
    }
    if any(len(numbers) != len(wiring.packed(row)) for row, numbers in packed.items()):
        return False
    for row, numbers in packed.items():
        wiring.packed(row)[:] = numbers
        every, absent = every_of(order[row]), order[row].block.rests(order[row].params)
        if (wiring.table[row, program.EVERY], wiring.absent[row]) != (every, absent):
            wiring.table[row, program.EVERY], wiring.absent[row], wiring.is_changed = every, absent, True
    wiring.instances = order
    if spec.driving != before.driving or spec.measuring != before.measuring:
        for row, instance in enumerate(order):
            if any(port.source.startswith("@") for port in instance.block.inputs):
                wiring.ports(row)[:] = ports_of(spec, instance, wiring.index)
        engage(spec, wiring.index, wiring.w)
    if spec.sensors is not before.sensors or spec.measuring != before.measuring:
        wiring.unread, wiring.is_changed = unread(spec, order), True
    return True


def _after(wiring: Wiring, before: Spec, spec: Spec) -> tuple[list[Instance], Iterable[int]]:
    """Return the blocks of a bench, and the rows that may differ: most often only the row of a fault."""
    if spec.document is not before.document:
        order = instances(spec)
        return order, range(len(order))
    order = [*wiring.instances]
    rows = [wiring.rows[f"faults.{name}"] for name in {**before.faults, **spec.faults}]
    for row in rows:
        key, prefix, block, _, every, axis = order[row]
        order[row] = Instance(key, prefix, block, spec.faults.get(block.name) or usual_params(block), every, axis)
    return order, rows
