"""Numbers of a board that a step only reads to decide how it runs: places of ports, choices, lengths of lists."""

from __future__ import annotations

from collections.abc import Sequence

from core.block import FloatArray, IntArray
from core.board.wiring import Wiring
from core.record import RECORD, RecordLayout
from scenarios.speed.anchor.expressions import literal
from scenarios.speed.anchor.writer import Known


def known(wirings: Sequence[Wiring], row: int) -> Known:
    """Return the numbers of a row that are the same in all wirings and may be constants."""
    block = wirings[0].instances[row].block
    found: dict[tuple[str, int], float] = {}
    for name, places, of in (
        ("p", _deciding(block.Packed.layout), _packed),
        ("s", _deciding(block.State.layout, choices=False), _state),
        ("io", range(len(block.Ports.declared)), _ports),
    ):
        values = [of(wiring, row) for wiring in wirings]
        for place in places:
            own = {literal(value[place].item(), "i64" if name == "io" else "double") for value in values}
            if len(own) == 1:
                found[name, place] = values[0][place].item()
    return found


def _packed(wiring: Wiring, row: int) -> FloatArray:
    return wiring.packed(row)


def _state(wiring: Wiring, row: int) -> FloatArray:
    return wiring.state_of(wiring.instances[row].key)


def _ports(wiring: Wiring, row: int) -> IntArray:
    return wiring.ports(row)


def _deciding(layout: RecordLayout, choices: bool = True, start: int = 0) -> list[int]:
    """Return the places of choices and of the length of tails, also in nested records."""
    places = [start + field.offset for field in layout.fields if field.is_choice and choices]
    places += [start + layout.size - 1] if layout.tails > 1 else []
    for field in layout.fields:
        if field.kind == RECORD and field.inner is not None:
            places += _deciding(field.inner, choices, start + field.offset)
    return places
