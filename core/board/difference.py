"""One way to change a board: by the difference of two benches."""

from __future__ import annotations

from core.board import program
from core.board.instances import Instance, instances, usual_params
from core.board.spec import Spec
from core.board.wiring import Wiring, engage, every_of, ports_of, unread


def change(wiring: Wiring, before: Spec, spec: Spec) -> bool:
    """Make the wiring of one bench that of another with the same blocks, in place; say whether that was possible.

    It is not where a block reads more numbers than before.

    Only rows whose parameters or context differ are packed again; states go on. When a block refuses its parameters
    nothing has changed.

    Raises
    ------
    InputError
        As ``Block.pack``.
    """
    order = _after(wiring, before, spec)
    if [entry.block for entry in order] != [entry.block for entry in wiring.instances]:
        return False
    other = {
        every for every in {entry.every for entry in order} if _differs(spec.context(every), before.context(every))
    }
    packed = {
        row: new.block.packed(new.params, spec.context(new.every))
        for row, (new, old) in enumerate(zip(order, wiring.instances, strict=True))
        if new.every in other or _differs(new, old)
    }
    if any(len(numbers) != len(wiring.packed(row)) for row, numbers in packed.items()):
        return False
    for row, numbers in packed.items():
        wiring.packed(row)[:] = numbers
        wiring.table[row, program.EVERY] = every_of(order[row])
    wiring.instances = order
    if spec.active != before.active or spec.measuring != before.measuring:
        for row, instance in enumerate(order):
            if any(port.source.startswith("@") for port in instance.block.inputs):
                wiring.ports(row)[:] = ports_of(spec, instance, wiring.index)
        engage(spec, wiring.index, wiring.w)
    if spec.sensors is not before.sensors or spec.measuring != before.measuring:
        wiring.unread = unread(spec, order)
    return True


def _after(wiring: Wiring, before: Spec, spec: Spec) -> list[Instance]:
    """Return the blocks of a bench, most often those of another but for a fault."""
    if any(getattr(spec, name) is not getattr(before, name) for name in PARTS):
        return instances(spec)
    order = [*wiring.instances]
    for name in {*before.faults, *spec.faults}:
        row = wiring.rows[f"faults.{name}"]
        order[row] = order[row]._replace(params=spec.faults.get(name) or usual_params(order[row].block))
    return order


PARTS = (
    "frame",
    "device",
    "environment",
    "plant",
    "reference",
    "model",
    "drive",
    "guard",
    "measuring",
    "sensors",
    "active",
    "controllers",
    "identifiers",
    "diagnosers",
)
"""Parts of a bench without its faults."""


def _differs(one: object, other: object) -> bool:
    return one is not other and one != other
