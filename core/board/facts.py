"""The facts of a bench that the numbers of a block are made of: for the same facts they are the same numbers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields
from typing import Any

from core.block import BlockParams, Context, FloatArray, Oscillator
from core.board.instances import Instance
from core.board.spec import Spec

FACTS = [fact.name for fact in fields(Context)]
"""The facts that blocks may know of a bench."""


class _Fact:
    """A fact of a bench, which is put among the attributes of the object that it is first read from."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, noting: Any, _: type) -> Any:
        if noting is None:  # asked of the class, as units of a document are looked at
            return self
        value = vars(noting)[self._name] = getattr(vars(noting)[""], self._name)
        return value


def _key(noting: Any, stream: str) -> float:
    """Return the key of a noise stream, which notes no fact: its place in the numbers is known."""
    context: Context = vars(noting)[""]
    return context.key(stream)


_Noting = type("_Noting", (Context,), {fact: _Fact(fact) for fact in FACTS} | {"key": _key})
"""The facts of a bench, whose attributes are the facts read; a unit of a document accepts only a `Context`."""


def numbers(instance: Instance, spec: Spec) -> tuple[FloatArray, FloatArray, set[str]]:
    """Return the parameters and the first state of a block, and which facts of the bench they are made of.

    The seed is not among these where it only makes the keys of the noise streams that the block declares.
    """
    noting: Any = object.__new__(_Noting)
    read = vars(noting)
    read[""] = spec.context(instance.every, instance.axis)
    made = instance.packed(noting), instance.block.initial(instance.params, noting)
    return *made, read.keys() - {""}


def streams(instance: Instance, start: int) -> list[tuple[int, str]]:
    """Return the noise streams of a block whose numbers begin at a place, each with the place of its key."""
    own = instance.block.Packed.streams.items()
    return [(start + place, stream.replace("{axis}", instance.axis)) for place, stream in own]


def unlike(one: Context, other: Context, facts: Iterable[str] = FACTS) -> set[str]:
    """Return which facts of some differ between two benches."""
    pairs = ((fact, getattr(one, fact), getattr(other, fact)) for fact in facts)
    return {fact for fact, own, another in pairs if own is not another and not is_alike(own, another)}


def is_alike(one: Any, other: Any) -> bool:
    """Say whether two values are the same, to the sign of a zero."""
    if one is other:
        return True
    if type(one) is float and one != 0.0:
        return bool(one == other)
    if isinstance(one, BlockParams | Oscillator):
        return type(one) is type(other) and is_alike(vars(one), vars(other))
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(is_alike(value, other[name]) for name, value in one.items())
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(is_alike, one, other))
    return bool(one == other) and repr(one) == repr(other)


def has_same_blocks(spec: Spec, other: Spec) -> bool:
    """Say whether two benches have the very same sections, and so the same blocks in the same order."""
    if (spec.dt_ms, spec.driving, spec.measuring) != (other.dt_ms, other.driving, other.measuring):
        return False
    return spec.has_sections_of(other)
