"""Records as the kernels see them that Python calls: views with attributes whose layout is part of their type.

A number of a record is at ``base[offset]``; a vector is a pointer, a nested record a view at an offset.
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
    lower_builtin,
    lower_getattr_generic,
    models,
    register_model,
    unbox,
)

from core.record import RECORD, RECORDS, SCALAR, Field, Layout, Record

DOUBLES = types.CPointer(types.float64)


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
    # nobody writes it, so it need not be read again after every number that is written
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


@cache
def _type(record: Any) -> RecordType:
    return RecordType(record.layout)


# numba asks a value itself before it looks up what is registered for its class, which takes twice as long
Record._numba_type_ = property(lambda record: _type(record.__class__))  # type: ignore[attr-defined]


@unbox(RecordType)
def _take(kind: Any, record: Any, c: Any) -> Any:
    """Let Python call kernels with its own records: what they write is written there."""
    number = c.pyapi.object_getattr_string(record, "address")
    base = c.builder.inttoptr(c.pyapi.long_as_ulonglong(number), c.context.get_value_type(DOUBLES))
    c.pyapi.decref(number)
    return NativeValue(_view(c.context, c.builder, kind, base=base))
