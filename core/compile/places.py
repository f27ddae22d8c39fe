"""Records, vectors and ports of boards side by side: where their numbers are.

The same number of two neighbouring boards has neighbouring places: of ``width`` boards, field ``offset`` of the board
in lane ``k`` is at ``base[offset * width + k]``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from llvmlite import ir

from core.compile.numbers import FLOAT, I64, INT, Arithmetic, CompiledNumber, Unsupported
from core.ports import TICK, TIME_MS
from core.record import RECORD, SCALAR, Field, RecordLayout


@dataclass(frozen=True)
class Place:
    """Numbers from a place on; ``shift`` moves each lane by its own count of numbers."""

    base: Any
    shift: CompiledNumber | None = None


@dataclass(frozen=True)
class VectorView(Place):
    """A vector."""


@dataclass(frozen=True)
class RecordView(Place):
    """A record."""

    layout: RecordLayout | None = None


@dataclass(frozen=True)
class RecordsView(Place):
    """Several records."""

    layout: RecordLayout | None = None


@dataclass(frozen=True)
class PortsView:
    """Ports: all signals, the places of the signals of the block, the kind of each port, the places known before."""

    signals: Any
    places: Any
    ports: dict[str, tuple[int, bool | RecordLayout]]
    known: Mapping[int, int] = field(default_factory=dict)


class Memory:
    """Writes instructions that read and write numbers; with ``lanes``, of all boards at once."""

    def __init__(self, arithmetic: Arithmetic, *, lanes: bool) -> None:
        self._arithmetic, self._build, self._lanes = arithmetic, arithmetic.builder, lanes
        self._width = arithmetic.width

    def moved(self, place: Place, numbers: Any) -> tuple[Any, CompiledNumber | None]:
        """Return the base and the shift of a place so many numbers further."""
        if isinstance(numbers, CompiledNumber) and numbers.is_lanes:
            shift = numbers if place.shift is None else self._arithmetic.plus(place.shift, numbers)
            return place.base, shift
        count = self._arithmetic.as_kind(numbers, INT).value
        offset = self._build.mul(count, ir.Constant(I64, self._width))
        return self._build.gep(place.base, [offset], inbounds=True), place.shift

    def read(self, place: Place, mask: CompiledNumber | None, *, shared: bool = False) -> CompiledNumber:
        """Return the number at a place; a shared one is the same in all lanes."""
        if shared or not self._lanes:
            return CompiledNumber(self._build.load(place.base), FLOAT)
        kind = self._arithmetic.type_of(FLOAT, is_lanes=True)
        if place.shift is None:
            at = self._build.bitcast(place.base, kind.as_pointer())
            return CompiledNumber(self._build.load(at, align=8), FLOAT)
        value = ir.Constant(kind, ir.Undefined)
        for lane, at in enumerate(self._scattered(place, mask)):
            value = self._build.insert_element(value, self._build.load(at), ir.Constant(I64, lane))
        return CompiledNumber(value, FLOAT)

    def write(self, place: Place, value: Any, mask: CompiledNumber | None) -> None:
        """Write a number to a place, in the lanes of a mask."""
        number = self._arithmetic.as_kind(value, FLOAT)
        if not self._lanes:
            self._build.store(number.value, place.base)
            return
        number = self._arithmetic.spread(number)
        if mask is not None:
            number = self._arithmetic.select(mask, number, self.read(place, mask))
        if place.shift is None:
            at = self._build.bitcast(place.base, number.value.type.as_pointer())
            self._build.store(number.value, at, align=8)
            return
        for lane, at in enumerate(self._scattered(place, mask)):
            self._build.store(self._build.extract_element(number.value, ir.Constant(I64, lane)), at)

    def _scattered(self, place: Place, mask: CompiledNumber | None) -> list[Any]:
        """Return the address of every lane; a lane that does not take part stays at the base."""
        shift = place.shift
        assert shift is not None
        if mask is not None:
            shift = self._arithmetic.select(mask, shift, 0)
        found = []
        for lane in range(self._width):
            count = self._build.extract_element(shift.value, ir.Constant(I64, lane))
            offset = self._build.add(self._build.mul(count, ir.Constant(I64, self._width)), ir.Constant(I64, lane))
            found.append(self._build.gep(place.base, [offset], inbounds=True))
        return found

    def field(self, record: RecordView, name: str) -> tuple[Field, Place]:
        """Return a field of a record and its place."""
        layout = record.layout
        assert layout is not None
        field = next((field for field in layout.fields if field.name == name), None)
        if field is None:
            raise Unsupported(f"no field {name}")
        offset: Any = field.offset
        if field.tail:
            offset = layout.size
            if field.offset:
                last = Place(*self.moved(record, layout.size - 1))
                length = self._arithmetic.as_kind(self.read(last, None, shared=True), INT)
                offset = self._arithmetic.plus(layout.size, self._arithmetic.times(length, field.offset))
        return field, Place(*self.moved(record, offset))

    def attribute(self, record: RecordView, name: str, mask: CompiledNumber | None) -> Any:
        """Return a number of a record, or a view of a part of it."""
        field, place = self.field(record, name)
        if field.inner is not None:
            kind = RecordView if field.kind == RECORD else RecordsView
            return kind(place.base, place.shift, field.inner)
        if field.kind == SCALAR:
            return self.read(place, mask, shared=field.is_choice)
        return VectorView(place.base, place.shift)

    def port(self, ports: PortsView, name: str) -> tuple[Place, Any]:
        """Return the place of the signal behind a port, and the kind of the port."""
        if name in ("tick", "time_ms"):
            offset = (TICK if name == "tick" else TIME_MS) * self._width
            return Place(self._build.gep(ports.signals, [ir.Constant(I64, offset)])), "shared"
        if name not in ports.ports:
            raise Unsupported(f"no port {name}")
        number, seen = ports.ports[name]
        if number in ports.known:
            at = ir.Constant(I64, ports.known[number])
        else:
            at = self._build.load(self._build.gep(ports.places, [ir.Constant(I64, number)]))
        offset = self._build.mul(at, ir.Constant(I64, self._width))
        return Place(self._build.gep(ports.signals, [offset])), seen

    def item(self, view: Any, index: Any) -> Any:
        """Return the place of a number of a vector, or one of several records."""
        if isinstance(view, RecordsView):
            assert view.layout is not None
            place = self.moved(view, self._arithmetic.times(index, view.layout.size))
            return RecordView(*place, view.layout)
        return Place(*self.moved(view, index))
