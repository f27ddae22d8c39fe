"""Named numbers in a flat array of float64: the ``p`` and the ``s`` of a step.

The class declares the numbers; an instance is a view of an array. Compiled steps see the same names at the same places
(``core.views``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from inspect import get_annotations
from typing import Annotated, Any, ClassVar, Generic, Self, TypeVar, get_args, get_origin

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
"""Several numbers under one name, ``s.x1[i]``."""

Choice = Annotated[float, "choice"]
"""A number that controls how a step runs, such as a count, an interval or a form.

Boards side by side share it, so that a branch on it is a branch for all of them and a loop has one length.
"""

BLANK_BITS = 0x7FF8_B1A2_4B1A_24B1
BLANK = np.uint64(BLANK_BITS)
"""Bits of a number that is not packed yet: not a number, and different from the NaN of arithmetic."""

SCALAR, VECTOR, RECORD, RECORDS = "number", "vector", "record", "records"
"""Kinds of fields."""


@dataclass(frozen=True)
class Field:
    """Place of a field.

    Parameters
    ----------
    name, kind : str
    offset : int
        From the start of the record; for a tail, its turn among the tails.
    count : int
        Numbers of a vector, records of several; 0 for a tail, whose length is the length of the array.
    inner : Layout, optional
        Of the record, or of each of several.
    tail : bool
        Whether it comes after the fixed fields.
    is_choice : bool
        Whether boards side by side share it.
    """

    name: str
    kind: str
    offset: int
    count: int = 0
    inner: RecordLayout | None = None
    tail: bool = False
    is_choice: bool = False


@dataclass(frozen=True)
class RecordLayout:
    """The fields of a record, and the numbers of the fixed ones.

    Several tails are vectors of one common length; it is in the last of the fixed numbers.
    """

    fields: tuple[Field, ...]
    size: int

    @cached_property
    def tails(self) -> int:
        """Number of fields after the fixed fields."""
        return sum(field.tail for field in self.fields)

    @cached_property
    def scalars(self) -> dict[int, str]:
        """The names of single numbers by place, names of nested records with a dot."""
        found = {}
        for field in self.fields:
            if field.kind == SCALAR:
                found[field.offset] = field.name
            elif field.kind == RECORD and field.inner is not None:
                found |= {field.offset + at: f"{field.name}.{name}" for at, name in field.inner.scalars.items()}
        return found

    @cached_property
    def scalar_places(self) -> NDArray[np.int64]:
        """The places of single numbers."""
        return np.array([*self.scalars], dtype=np.int64)

    @cached_property
    def behind(self) -> int:
        """Numbers after the fixed numbers for each unit of the length of the tails."""
        return sum(field.inner.size if field.inner else 1 for field in self.fields if field.tail)

    def numbers(self, length: int) -> int:
        """Return the numbers of a record whose tails have a length."""
        return self.size + length * self.behind


@dataclass(frozen=True)
class _Many:
    """How many a field holds; 0 for a tail."""

    count: int


@dataclass(frozen=True)
class _Stream:
    """Which noise stream a number is the key of."""

    name: str


def stream(name: str) -> Any:
    """Declare the key of a noise stream, packed by the seed of the bench; ``{axis}`` is the axis of the block."""
    return _Stream(name)


def vector(count: int) -> Any:
    """Declare a vector of ``count`` numbers."""
    return _Many(count)


def several(count: int) -> Any:
    """Declare ``count`` records of one kind."""
    return _Many(count)


def tail() -> Any:
    """Declare a vector or records of a length that is known when the record is made; all other fields come before."""
    return _Many(0)


class Record:
    """Named numbers; a subclass annotates them: ``float``, ``Vector``, another record or ``Records`` of one kind.

    A view of a flat array. Numbers are read and written by name, vectors and nested records are views again; a nested
    record that is assigned is copied.
    """

    layout: ClassVar[RecordLayout] = RecordLayout((), 0)

    def __init__(self, array: Any) -> None:
        self.array: Any = array

    def __init_subclass__(cls) -> None:
        """Lay the fields out: fields of the bases first, then its own."""
        declared = {name: many for base in cls.__bases__ for name, many in getattr(base, "_declared", {}).items()}
        for name, hint in get_annotations(cls, eval_str=True).items():
            declared[name] = (hint, cls.__dict__.get(name))
        cls._declared, cls._blank = declared, {}
        cls.layout = _laid_out(cls.__qualname__, declared)
        for field in cls.layout.fields:
            kind = record_of(declared[field.name][0])
            setattr(cls, field.name, _Scalar(field.offset) if field.kind == SCALAR else _Part(cls.layout, field, kind))
        streams = {field.offset: declared[field.name][1] for field in cls.layout.fields}
        cls.streams = {place: one.name for place, one in streams.items() if isinstance(one, _Stream)}

    streams: ClassVar[dict[int, str]] = {}
    """The noise streams whose keys are among the numbers, by place."""
    _declared: ClassVar[dict[str, tuple[Any, Any]]] = {}
    _blank: ClassVar[dict[int, Any]] = {}
    """The blank record of each length, to be copied."""

    @classmethod
    def zeros(cls, length: int = 0) -> Self:
        """Return a record of zeros; ``length`` is the length of its tails."""
        record = cls(np.zeros(cls.layout.numbers(length)))
        if cls.layout.tails > 1:
            record.array[cls.layout.size - 1] = length
        return record

    @classmethod
    def blank(cls, length: int = 0) -> Self:
        """Return a record whose fixed numbers are still to be packed."""
        if length not in cls._blank:
            record = cls.zeros(length)
            record.array.view(np.uint64)[cls.layout.scalar_places] = BLANK
            cls._blank[length] = record.array
        return cls(cls._blank[length].copy())

    @cached_property
    def address(self) -> int:
        """Address of its numbers in memory."""
        return int(self.array.ctypes.data)

    def blanks(self) -> list[str]:
        """Return the names of the numbers that are not packed."""
        bits = self.array.view(np.uint64)[self.layout.scalar_places].tolist()
        if BLANK_BITS not in bits:
            return []
        return [name for name, own in zip(self.layout.scalars.values(), bits, strict=True) if own == BLANK_BITS]


R = TypeVar("R", bound=Record)


class Records(Generic[R]):
    """Several records of one kind, ``s.filters[i]``."""

    def __init__(self, array: Any, kind: type[R]) -> None:
        self._array, self._kind = array, kind

    def __len__(self) -> int:
        return len(self._array) // self._kind.layout.size

    def __iter__(self) -> Iterator[R]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, i: int) -> R:
        size = self._kind.layout.size
        return self._kind(self._array[i * size : (i + 1) * size])


def record_of(hint: Any) -> type[Record] | None:
    """Return the record class in an annotation, also of several records."""
    inner = get_args(hint)[0] if get_origin(hint) is Records else hint
    return inner if isinstance(inner, type) and issubclass(inner, Record) else None


def _laid_out(owner: str, declared: dict[str, tuple[Any, Any]]) -> RecordLayout:
    """Lay fields out in their order, tails behind all others."""
    fields, tails, at = [], 0, 0
    for name, (hint, many) in declared.items():
        record = record_of(hint)
        inner = record.layout if record else None
        count = many.count if isinstance(many, _Many) else -1
        if count < 0:
            if hint in (float, Choice):
                fields.append(Field(name, SCALAR, at, is_choice=hint is not float))
                at += 1
            elif inner is not None and get_origin(hint) is None and not inner.tails:
                fields.append(Field(name, RECORD, at, 1, inner))
                at += inner.size
            else:
                raise TypeError(f"{owner}.{name}: declare float, a record, vector(n), several(n) or tail()")
            continue
        kind = RECORDS if inner else VECTOR
        if count == 0:
            fields.append(Field(name, kind, tails, 0, inner, tail=True))
            tails += 1
        else:
            fields.append(Field(name, kind, at, count, inner))
            at += count * (inner.size if inner else 1)
    if tails > 1 and any(field.tail and field.kind == RECORDS for field in fields):
        raise TypeError(f"{owner}: several tails must be vectors")
    return RecordLayout(tuple(fields), at + (tails > 1))


class _Scalar:
    """Reads and writes one number."""

    def __init__(self, place: int) -> None:
        self._place = place

    def __get__(self, record: Record, owner: type[Record]) -> Any:
        return record.array[self._place]

    def __set__(self, record: Record, value: Any) -> None:
        record.array[self._place] = value


class _Part:
    """Finds the numbers of a vector or a record, and writes over all of them."""

    def __init__(self, layout: RecordLayout, field: Field, kind: type[Record] | None) -> None:
        self._layout, self._field, self._kind = layout, field, kind
        end = field.offset + field.count * (field.inner.size if field.inner else 1)
        self._fixed = None if field.tail else slice(field.offset, end)

    def _slice(self, record: Record) -> slice:
        if self._fixed is not None:
            return self._fixed
        layout, field = self._layout, self._field
        length = (len(record.array) - layout.size) // layout.tails
        return slice(layout.size + field.offset * length, layout.size + (field.offset + 1) * length)

    def __get__(self, record: Record, owner: type[Record]) -> Any:
        part = record.array[self._slice(record)]
        if self._kind is None:
            return part
        return self._kind(part) if self._field.kind == RECORD else Records(part, self._kind)

    def __set__(self, record: Record, value: Any) -> None:
        record.array[self._slice(record)] = value.array if isinstance(value, Record) else value
