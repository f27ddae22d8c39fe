"""Records and ports as compiled steps see them: views with attributes whose layout is part of their type.

Only the way to an address differs. A number of a record is at ``base[offset]``, the signal behind a port at the place
that the port names; a vector is a pointer, a nested record a view at an offset. So the names cost nothing.
"""

from __future__ import annotations

import operator
from functools import cache
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.imputils import lower_setattr_generic
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_global, signature
from numba.extending import (
    NativeValue,
    infer_getattr,
    intrinsic,
    lower_builtin,
    lower_getattr_generic,
    models,
    register_model,
    unbox,
)

from core.ports import TICK, TIME_MS
from core.record import RECORD, RECORDS, SCALAR, Field, Layout, Record

DOUBLES = types.CPointer(types.float64)
INTEGERS = types.CPointer(types.int64)


class RecordType(types.Type):
    """A record of a layout."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.fields = {field.name: field for field in layout.fields}
        super().__init__(name=f"record({_text(layout)})")


class RecordsType(types.Type):
    """Several records of a layout, one after another."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        super().__init__(name=f"records({_text(layout)})")


class PortsType(types.Type):
    """Ports of a block."""

    def __init__(self, ports: tuple[tuple[str, bool | Layout], ...]) -> None:
        self.ports = ports
        self.places = {name: (place, seen) for place, (name, seen) in enumerate(ports)}
        super().__init__(name=f"ports({','.join(name + _several(seen) for name, seen in ports)})")


def _several(seen: bool | Layout) -> str:
    """Return the mark after the name of a port: none, a vector, or its records."""
    return f"[{_text(seen)}]" if isinstance(seen, Layout) else "[]" * seen


def _text(layout: Layout) -> str:
    """Return a layout in a word, so that equal layouts are one type."""

    def one(field: Field) -> str:
        inner = f"({_text(field.inner)})" if field.inner else ""
        return f"{field.name}:{field.kind}{inner}{'*' if field.tail else ''}{field.offset}"

    return f"{','.join(map(one, layout.fields))};{layout.size}"


@register_model(RecordType)
@register_model(RecordsType)
class _RecordModel(models.StructModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, [("base", DOUBLES)])


@register_model(PortsType)
class _PortsModel(models.StructModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, [("signals", DOUBLES), ("places", INTEGERS)])


@infer_getattr
class _RecordAttributes(AttributeTemplate):
    key = RecordType

    def generic_resolve(self, record: Any, name: str) -> Any:  # type: ignore[override]
        field = record.fields.get(name)
        if field is None:
            return None
        if field.inner is None:
            return types.float64 if field.kind == SCALAR else DOUBLES
        return RecordType(field.inner) if field.kind == RECORD else RecordsType(field.inner)


@infer_getattr
class _PortAttributes(AttributeTemplate):
    key = PortsType

    def generic_resolve(self, ports: Any, name: str) -> Any:  # type: ignore[override]
        if name in ("tick", "time_ms"):
            return types.float64
        if name not in ports.places:
            return None
        seen = ports.places[name][1]
        if isinstance(seen, Layout):
            return RecordsType(seen)
        return DOUBLES if seen else types.float64


@infer_global(operator.getitem)
class _RecordAt(AbstractTemplate):
    def generic(self, args: Any, keywords: Any) -> Any:
        if isinstance(args[0], RecordsType):
            return signature(RecordType(args[0].layout), args[0], types.intp)
        return None


def _integer(value: int) -> Any:
    return ir.Constant(ir.IntType(64), value)


def _view(context: Any, builder: Any, kind: Any, **pointers: Any) -> Any:
    """Return a view of some kind over pointers."""
    view = cgutils.create_struct_proxy(kind)(context, builder)
    for name, pointer in pointers.items():
        setattr(view, name, pointer)
    return view._getvalue()


def _place(builder: Any, base: Any, layout: Layout, field: Field) -> Any:
    """Return the address of a field."""
    if not field.tail:
        return builder.gep(base, [_integer(field.offset)])
    behind = builder.gep(base, [_integer(layout.size)])
    if field.offset == 0:
        return behind
    length = builder.load(builder.gep(base, [_integer(layout.size - 1)]))
    # it is never written, so it need not be read again after every number that is written
    length.set_metadata("invariant.load", builder.module.add_metadata([]))
    return builder.gep(behind, [builder.mul(builder.fptosi(length, ir.IntType(64)), _integer(field.offset))])


@lower_getattr_generic(RecordType)
def _read_field(context: Any, builder: Any, kind: Any, value: Any, name: str) -> Any:
    base = cgutils.create_struct_proxy(kind)(context, builder, value=value).base
    field = kind.fields[name]
    at = _place(builder, base, kind.layout, field)
    if field.inner is not None:
        inner = RecordsType(field.inner) if field.kind == RECORDS else RecordType(field.inner)
        return _view(context, builder, inner, base=at)
    return builder.load(at) if field.kind == SCALAR else at


@lower_setattr_generic(RecordType)
def _write_field(context: Any, builder: Any, signature: Any, args: Any, name: str) -> None:
    kind = signature.args[0]
    base = cgutils.create_struct_proxy(kind)(context, builder, value=args[0]).base
    builder.store(args[1], _place(builder, base, kind.layout, kind.fields[name]))


@lower_builtin(operator.getitem, RecordsType, types.intp)
def _read_record(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    kind = signature.args[0]
    base = cgutils.create_struct_proxy(kind)(context, builder, value=args[0]).base
    at = builder.gep(base, [builder.mul(args[1], _integer(kind.layout.size))])
    return _view(context, builder, signature.return_type, base=at)


def _signal(context: Any, builder: Any, kind: Any, value: Any, name: str) -> Any:
    """Return the address of the signal behind a port."""
    ports = cgutils.create_struct_proxy(kind)(context, builder, value=value)
    if name in ("tick", "time_ms"):
        return builder.gep(ports.signals, [_integer(TICK if name == "tick" else TIME_MS)])
    place = builder.load(builder.gep(ports.places, [_integer(kind.places[name][0])]))
    return builder.gep(ports.signals, [place])


@lower_getattr_generic(PortsType)
def _read_port(context: Any, builder: Any, kind: Any, value: Any, name: str) -> Any:
    at = _signal(context, builder, kind, value, name)
    seen = kind.places.get(name, (0, False))[1]
    if isinstance(seen, Layout):
        return _view(context, builder, RecordsType(seen), base=at)
    return at if seen else builder.load(at)


@lower_setattr_generic(PortsType)
def _write_port(context: Any, builder: Any, signature: Any, args: Any, name: str) -> None:
    builder.store(args[1], _signal(context, builder, signature.args[0], args[0], name))


@cache
def _type(record: Any) -> RecordType:
    return RecordType(record.layout)


# numba asks a value itself before its registry, which takes twice as long
Record._numba_type_ = property(lambda record: _type(record.__class__))  # type: ignore[attr-defined]


@unbox(RecordType)
def _take(kind: Any, record: Any, c: Any) -> Any:
    """Let Python call kernels with its own records: a kernel writes into them directly."""
    number = c.pyapi.object_getattr_string(record, "address")
    base = c.builder.inttoptr(c.pyapi.long_as_ulonglong(number), c.context.get_value_type(DOUBLES))
    c.pyapi.decref(number)
    return NativeValue(_view(c.context, c.builder, kind, base=base))


def record_at(layout: Layout) -> Any:
    """Return the constructor of a view of a record from a pointer, for compiled code."""
    kind = RecordType(layout)

    def view(typing: Any, base: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return _view(context, builder, kind, base=args[0])

        return kind(DOUBLES), generate

    return intrinsic(view)


def ports_at(ports: tuple[tuple[str, bool | Layout], ...]) -> Any:
    """Return the constructor of a view of ports from the signals and their places, for compiled code.

    Of every port its name, and whether it is a vector or its record class.
    """
    kind = PortsType(ports)

    def view(typing: Any, signals: Any, places: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return _view(context, builder, kind, signals=args[0], places=args[1])

        return kind(DOUBLES, INTEGERS), generate

    return intrinsic(view)
